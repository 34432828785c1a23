"""linuxcncrsh without a machine: cutting lines, the protocol, and replies; LinuxCNC's words throughout."""

import types

import pytest

import linuxcnc
from gui.linuxcncrsh import LONGEST_LINE, LineBuffer
from gui.rsh_get import GETTERS
from gui.rsh_session import Session
from gui.rsh_set import FREE, SETTERS
from tests.support.fake_task import RCS_DONE, RCS_ERROR, FakeTask


def answer(command, status):
    """A task that knows states and modes, and refuses one MDI block."""
    match type(command).__name__:
        case "EMC_TASK_SET_STATE":
            status.task.state = command.state
        case "EMC_TASK_SET_MODE":
            status.task.mode = command.mode
        case "EMC_TASK_PLAN_EXECUTE" if command.command == "g0xq":
            return RCS_ERROR
    return RCS_DONE


@pytest.fixture
def task():
    with FakeTask(answer) as task:
        task.status.task.state = linuxcnc.STATE_ESTOP
        task.status.task.mode = linuxcnc.MODE_MANUAL
        task.status.motion.traj.linearUnits = 1.0
        task.status.motion.traj.angularUnits = 1.0
        task.status.motion.traj.spindles = 1
        task.status.task.programUnits = 2
        task.publish()
        yield task


@pytest.fixture
def server():
    return types.SimpleNamespace(
        name="EMCNETSVR", connect_password="EMC", enable_password="EMCTOO", in_control=None, shut_down=lambda: None
    )


@pytest.fixture
def session(task, server):
    session = Session(server)
    session.answer("hello EMC test 1.0")
    for line in ("set echo off", "set verbose on", "set enable EMCTOO"):
        session.answer(line)
    return session


@pytest.mark.parametrize("pieces", [[b"get a\r\nget b\n"], [b"ge", b"t a\r", b"\nge", b"t b\n\r"]])
def test_lines_come_out_whole_however_the_bytes_arrive(pieces):
    buffer = LineBuffer()
    assert [line for piece in pieces for line in buffer.feed(piece)] == ["get a", "get b"]


def test_half_a_line_waits_for_its_end():
    buffer = LineBuffer()
    assert buffer.feed(b"get esto") == []
    assert buffer.feed(b"p\r\n") == ["get estop"]


def test_a_line_of_a_megabyte_is_refused_once_and_the_next_one_understood():
    buffer = LineBuffer()
    lines = [line for _ in range(16) for line in buffer.feed(b"x" * 65536)]
    lines += buffer.feed(b"tail\r\nget estop\r\n")
    assert lines == [None, "get estop"]


def test_a_line_of_the_longest_length_is_accepted():
    assert LineBuffer().feed(b"a" * LONGEST_LINE + b"\n") == ["a" * LONGEST_LINE]


def test_hello_needs_the_password_and_three_words(task, server):
    session = Session(server)
    assert session.answer("hello XX a 1.0") == "HELLO NAK\r\n"
    assert session.answer("hello EMC a") == "HELLO NAK\r\n"
    assert session.answer("HELLO EMC a 1.0") == "HELLO ACK EMCNETSVR 1.1\r\n"


def test_nothing_can_be_set_before_hello(task, server):
    assert Session(server).answer("set estop off") == "SET NAK\r\n"


def test_a_command_is_echoed_until_the_echo_is_off(task, server):
    session = Session(server)
    session.answer("hello EMC a 1.0")
    assert session.answer("get estop") == "get estop\r\nESTOP ON\r\n"
    session.answer("set echo off")
    assert session.answer("get estop") == "ESTOP ON\r\n"


def test_the_machine_obeys_only_the_connection_in_control(session, server):
    other = Session(server)
    other.answer("hello EMC other 1.0")
    assert other.answer("set machine on").endswith("SET MACHINE NAK\r\n")
    other.answer("set enable EMCTOO")
    assert session.answer("get enable") == "ENABLE OFF\r\n"
    assert session.answer("set machine on") == "SET MACHINE NAK\r\n"


@pytest.mark.parametrize(
    ("line", "reply"),
    [
        ("get", "GET NAK"),
        ("set", "SET NAK"),
        ("get bogus", "GET BOGUS NAK"),
        ("set bogus 1", "SET BOGUS NAK"),
        ("set estop maybe", "SET ESTOP NAK"),
        ("set estop off", "SET ESTOP ACK"),
        ("set feed_override abc", "SET FEED_OVERRIDE NAK"),
        ("set jog 99 10", "SET JOG NAK"),
        ("set jog", "SET JOG NAK"),
        ("set set_wait foo", "SET SET_WAIT NAK"),
        ("get plat", "PLAT Linux"),
        ("get mode", "MODE MANUAL"),
        ("GET   Mode  ", "MODE MANUAL"),
        ("get joint_homed", "JOINT_HOMED NO NO NO NO NO NO"),
        ("get joint_homed 0", "JOINT_HOMED 0 NO"),
        ("get joint_homed 12", "GET JOINT_HOMED NAK"),
        ("get joint_limit", "JOINT_LIMIT OK OK OK OK OK OK"),
        ("get abs_cmd_pos", "ABS_CMD_POS 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000"),
        ("get rel_act_pos 0", "REL_ACT_POS 0 0.000000"),
        ("get program", "PROGRAM NONE"),
        ("get program_units", "PROGRAM_UNITS MM"),
        ("get user_linear_units", "USER_LINEAR_UNITS MM"),
        ("get set_wait", "SET_WAIT RECEIVED"),
        ("get comm_mode", "COMM_MODE ASCII"),
        ("get error", "ERROR OK"),
        ("get spindle", "SPINDLE OFF"),
        ("get config", "CONFIG"),
    ],
)
def test_replies_are_linuxcncs(session, line, reply):
    assert session.answer(line) == f"{reply}\r\n"


def test_a_word_that_is_no_command_gets_no_reply(session):
    assert session.answer("bogus") == ""
    assert session.answer("\x00\xff\x01") == ""


def test_with_set_wait_done_a_failing_command_is_refused(session):
    assert session.answer("set mdi g0xq") == "SET MDI ACK\r\n"
    session.answer("set set_wait done")
    assert session.answer("set mdi g0xq") == "SET MDI NAK\r\n"
    assert session.answer("set mdi g0x1") == "SET MDI ACK\r\n"


def test_positions_come_in_the_units_that_were_asked_for(session, task):
    task.status.motion.traj.position = (25.4, 0.0, 0.0, 90.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.publish()
    session.answer("set linear_unit_conversion inch")
    session.answer("set angular_unit_conversion grad")
    words = session.answer("get abs_cmd_pos").split()
    assert [float(word) for word in words[1:]] == pytest.approx([1.0, 0.0, 0.0, 100.0, 0.0, 0.0])


def test_a_relative_position_is_without_offsets_and_rotation(session, task):
    task.status.motion.traj.position = (10.0, 21.0, 30.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.status.task.g5x_offset = (10.0, 20.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.status.task.toolOffset = (0.0, 0.0, 12.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.status.task.rotation_xy = 90.0
    task.publish()
    words = session.answer("get rel_cmd_pos").split()
    assert [float(word) for word in words[1:4]] == pytest.approx([1.0, 0.0, 12.5])


def test_stale_values_are_shown_to_those_who_want_them(session, task):
    session.answer("set update none")
    task.status.task.mode = linuxcnc.MODE_MDI
    task.publish()
    assert session.answer("get mode") == "MODE MANUAL\r\n"
    session.answer("set update auto")
    assert session.answer("get mode") == "MODE MDI\r\n"


def test_each_message_is_told_once(session):
    session.note("error", "joint 0 following error")
    assert session.answer("get error") == "ERROR joint 0 following error\r\n"
    assert session.answer("get error") == "ERROR OK\r\n"


def test_help_lists_every_command(session):
    helped = session.answer("help get").upper()
    assert all(name in helped for name in GETTERS)
    helped = session.answer("help set").upper()
    assert all(name in helped for name in SETTERS)
    assert session.answer("help bogus") == "BOGUS is not a valid command.\r\n\r\n"


def test_every_get_command_answers(session):
    for name in GETTERS:
        assert session.answer(f"get {name}").startswith(("INI", name) if name != "INI" else "GET INI NAK")


def test_garbage_never_raises(session):
    for name in [*SETTERS, "BOGUS"]:
        if name in FREE:
            continue
        for words in ("\xff\x00 \x01", "-1e999", "nan nan nan", "x y z", "999999999999999999999"):
            assert session.answer(f"set {name} {words}").startswith("SET")
            session.answer("set enable EMCTOO")
