"""linuxcncrsh without a machine: cutting lines, the protocol, and replies; LinuxCNC's words throughout."""

import asyncio

import pytest

import linuxcnc
from gui.linuxcncrsh import LONGEST_LINE, LineBuffer, Server, _parser
from gui.rsh_get import GETTERS
from gui.rsh_session import Session
from gui.rsh_set import SETTERS, Access
from nml.emc import EMC_OPERATOR_ERROR
from tests.support.fake_task import RCS_DONE, RCS_ERROR, FakeTask

RCS_EXEC = linuxcnc.RCS_EXEC


def answer(command, status):
    """A task that knows states and modes, and refuses one MDI block."""
    match type(command).__name__:
        case "EMC_TASK_SET_STATE":
            status.task.state = command.state
        case "EMC_TASK_SET_MODE":
            status.task.mode = command.mode
        case "EMC_TASK_PLAN_RUN" | "EMC_JOG_CONT":
            return RCS_EXEC
        case "EMC_TASK_PLAN_EXECUTE" if command.command == "g0xq":
            return RCS_ERROR
    return RCS_DONE


@pytest.fixture
def task():
    with FakeTask(answer) as task:
        task.status.task.state = linuxcnc.STATE_ON
        task.status.task.mode = linuxcnc.MODE_MANUAL
        task.status.motion.traj.linearUnits = 1.0
        task.status.motion.traj.angularUnits = 1.0
        task.status.motion.traj.spindles = 2
        task.status.motion.traj.joints = 3
        task.status.motion.traj.axis_mask = 7
        task.status.motion.traj.mode = linuxcnc.TRAJ_MODE_FREE
        task.status.motion.traj.cycleTime = 0.001
        task.status.task.programUnits = 2
        task.publish()
        yield task


@pytest.fixture
def server(tmp_path):
    async def make():
        return Server(_parser().parse_args(["--quiet", "--path", str(tmp_path)]))

    return asyncio.run(make())


@pytest.fixture
def session(task, server):
    session = connect(server)
    for line in ("hello EMC test 1.0", "set echo off", "set verbose on", "set enable EMCTOO"):
        session.answer(line)
    return session


def connect(server, number=5):
    session = Session(server, number)
    server.sessions.append(session)
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


def test_hello_needs_the_password_and_a_name(task, server):
    session = connect(server)
    assert session.answer("hello XX a 1.0") == "HELLO NAK\r\n"
    assert session.answer("hello EMC") == "error: Too few arguments for 'hello' command\r\n"
    assert session.answer("HELLO EMC a") == "HELLO ACK EMCNETSVR 1.1\r\n"
    assert session.answer("hello EMC a 1.2") == (
        "warning: Requested version '1.2' is newer than '1.1' from [EMC]VERSION\r\nHELLO ACK EMCNETSVR 1.1\r\n"
    )


def test_a_wrong_hello_takes_control_away(session):
    assert session.answer("hello XX a 1.0") == "HELLO NAK\r\n"
    assert session.answer("get enable") == "ENABLE OFF\r\n"
    assert session.answer("set enable EMCTOO").endswith("SET ENABLE NAK\r\n")


@pytest.mark.parametrize(
    ("line", "reply"),
    [
        ("set verbose on", "error: A HELLO must be successfully negotiated for SET VERBOSE\r\nSET VERBOSE NAK"),
        ("set estop off", "error: A HELLO must be successfully negotiated for SET ESTOP\r\nSET ESTOP NAK"),
        ("shutdown", "error: SHUTDOWN failed, not enabled\r\nSHUTDOWN NAK"),
    ],
)
def test_nothing_can_be_set_before_hello(task, server, line, reply):
    assert connect(server).answer(line) == f"{reply}\r\n"


def test_before_hello_one_may_ask_and_set_the_form_of_replies(task, server):
    session = connect(server)
    assert session.answer("set echo off") == ""
    assert session.answer("get mode") == "MODE MANUAL\r\n"


def test_a_command_is_echoed_until_the_echo_is_off(task, server):
    session = connect(server)
    session.answer("hello EMC a 1.0")
    assert session.answer("get estop") == "get estop\r\nESTOP OFF\r\n"
    session.answer("set echo off")
    assert session.answer("get estop") == "ESTOP OFF\r\n"


def test_the_machine_obeys_only_connections_that_are_enabled(session, server):
    other = connect(server, 6)
    other.answer("hello EMC other 1.0")
    other.answer("set echo off")
    assert other.answer("set mist on") == "error: Connection must be enabled for SET MIST\r\nSET MIST NAK\r\n"
    assert other.answer("get clients") == "CLIENTS 5 'test' LINKED ENABLED\r\nCLIENTS 6 'other' LINKED\r\n"
    assert other.answer("set disable 5") == "DISABLE 5 test\r\n"
    assert session.answer("get enable") == "ENABLE OFF\r\n"


def test_orders_are_for_a_machine_that_is_on(session, task):
    task.status.task.state = linuxcnc.STATE_ESTOP_RESET
    task.publish()
    assert session.answer("set mode mdi") == "error: Machine must be 'ON' for SET MODE\r\nSET MODE NAK\r\n"
    assert session.answer("set machine on") == "SET MACHINE ACK\r\n"


def test_an_order_waits_for_that_of_another_connection_except_those_that_stop(session, server, task):
    session.answer("set timeout 0.05")
    assert session.answer("set run") == "error: timed out\r\nSET RUN NAK\r\n"
    server.begin_order("RUN")
    assert session.answer("set mist on") == (
        "error: Cannot issue SET MIST command while SET RUN command is still active\r\n"
    )
    assert session.answer("set machine on").endswith("SET MACHINE NAK\r\n")
    assert session.answer("set abort") == "SET ABORT ACK\r\n"
    assert session.answer("set estop on") == "SET ESTOP ACK\r\n"


@pytest.mark.parametrize(
    ("line", "reply"),
    [
        ("get", "error: Too few arguments for 'get' command"),
        ("set", "error: Too few arguments for 'set' command"),
        ("get bogus", "error: Subcommand not found: GET bogus\r\nGET NAK"),
        ("set bogus 1", "error: Subcommand not found: SET bogus\r\nSET NAK"),
        ("get home", "GET HOME NAK"),
        ("set tool 1", "SET TOOL NAK"),
        ("bogus", "error: Command 'bogus' not found"),
        ("set estop maybe", "error: Invalid argument 'maybe', must be {on,off}\r\nSET ESTOP NAK"),
        ("set estop no", "SET ESTOP ACK"),
        ("set mode x", "error: Invalid argument 'x', must be {manual,auto,mdi}\r\nSET MODE NAK"),
        ("set feed_override abc", "error: Invalid argument 'abc', must be floating point\r\nSET FEED_OVERRIDE NAK"),
        ("set jog 99 10", "error: Invalid joint '99', valid range [0,2]\r\nSET JOG NAK"),
        ("set jog", "error: Too few arguments to SET JOG, have 0, need 2 or more\r\nSET JOG NAK"),
        ("set jog x 1", "SET JOG NAK"),
        ("set jog q 1", "error: Invalid axis 'q', must be one of XYZABCUVW\r\nSET JOG NAK"),
        ("set jog 0 1", "SET JOG ACK"),
        ("set home 3", "error: Invalid joint '3', valid range [-1,2]\r\nSET HOME NAK"),
        ("set joint_unhome -2", "SET JOINT_UNHOME ACK"),
        ("set wait_mode foo", "error: Invalid argument 'foo', must be {received,done}\r\nSET WAIT_MODE NAK"),
        ("set spindle forward 99", "error: Invalid spindle '99', valid range [-1,1]\r\nSET SPINDLE NAK"),
        ("set pause",
         "error: Sending 'SET PAUSE' while not in 'WAIT_MODE RECEIVED' will stall forever\r\nSET PAUSE NAK"),
        ("set open /no/such.ngc", "error: File '/no/such.ngc' not found\r\nSET OPEN NAK"),
        ("set wait_heartbeat 10000", "error: Invalid periods '10000', waiting time of 10.000 seconds would exceed "
         "timeout of 1.000 seconds\r\nSET WAIT_HEARTBEAT NAK"),
        ("set joint_wait_homed 0",
         "error: Joint '0' is not homed and not in the process of homing.\r\nSET JOINT_WAIT_HOMED NAK"),
        ("get plat", "PLAT Linux"),
        ("get mode", "MODE MANUAL"),
        ("GET   Mode  ", "MODE MANUAL"),
        ("get joint_homed", "JOINT_HOMED NO NO NO"),
        ("get joint_homed 0", "JOINT_HOMED 0 NO"),
        ("get joint_homed 3", "error: Invalid joint '3', valid range [-1,2]\r\nGET JOINT_HOMED NAK"),
        ("get joint_limit", "JOINT_LIMIT OK OK OK"),
        ("get abs_cmd_pos", "ABS_CMD_POS" + " 0.000000" * 9),
        ("get rel_act_pos 0", "REL_ACT_POS X 0.000000"),
        ("get pos_offset a", "warning: Axis 'a', not configured\r\nPOS_OFFSET A 0.000000"),
        ("get program", "PROGRAM NONE"),
        ("get open", "OPEN NONE"),
        ("get program_linear_units", "PROGRAM_UNITS MM"),
        ("get user_linear_units", "USER_LINEAR_UNITS MM"),
        ("get wait_mode", "WAIT_MODE DONE"),
        ("get set_wait", "SET_WAIT DONE"),
        ("get timestamp", "TIMESTAMP OFF OFF"),
        ("get comm_mode", "COMM_MODE ASCII"),
        ("get debug", "DEBUG 0x00000000"),
        ("get error", "ERROR OK"),
        ("get spindle -1", "SPINDLE 0 OFF\r\nSPINDLE 1 OFF"),
        ("get brake", "BRAKE 0 OFF"),
        ("get config", "CONFIG"),
        ("quit", "QUIT ACK"),
        ("shutdown", "SHUTDOWN ACK"),
    ],
)
def test_replies_are_linuxcncs(session, line, reply):
    assert session.answer(line) == f"{reply}\r\n"


def test_replies_can_be_stamped_with_the_time(session):
    session.answer("set timestamp on")
    stamp, _, text = session.answer("get plat").partition(": ")
    assert (float(stamp) > 1e9, text) == (True, "PLAT Linux\r\n")
    session.answer("set timestamp on on")
    assert session.answer("get plat")[4] == "-"


def test_an_order_that_fails_is_refused(session):
    assert session.answer("set mdi g0xq") == "SET MDI NAK\r\n"
    assert session.answer("set mdi g0x1") == "SET MDI ACK\r\n"
    session.answer("set wait_mode received")
    assert session.answer("set mdi g0xq") == "SET MDI NAK\r\n"


def test_a_block_reaches_the_machine_as_it_was_written(session, task):
    session.answer("set mdi  G1  X1 (MSG, two  blanks) ")
    assert task.taken[-1].command == "G1  X1 (MSG, two  blanks)"


def test_a_program_is_looked_for_in_the_folders_of_the_path(session, task, tmp_path):
    (tmp_path / "a part.ngc").write_text("M2\n")
    assert session.answer("set open a part.ngc") == "SET OPEN ACK\r\n"
    assert task.taken[-1].file == str(tmp_path / "a part.ngc")
    assert session.answer("get open") == f"OPEN {tmp_path / 'a part.ngc'}\r\n"


def test_a_probe_clear_reaches_the_machine(session, task):
    assert session.answer("set probe_clear") == "SET PROBE_CLEAR ACK\r\n"
    assert type(task.taken[-1]).__name__ == "EMC_TRAJ_CLEAR_PROBE_TRIPPED_FLAG"


@pytest.mark.parametrize(("word", "joint"), [("on", 0), ("off", -1)])
def test_limits_are_overridden_and_put_in_force_again(session, task, word, joint):
    session.answer(f"set override_limits {word}")
    assert task.taken[-1].joint == joint


def test_homing_is_waited_for(session, task):
    task.status.motion.joint[1].homed = 1
    task.status.motion.heartbeat = 7
    task.publish()
    session._status.wait = lambda timeout: beat(task)
    assert session.answer("set joint_wait_homed 1") == "SET JOINT_WAIT_HOMED ACK\r\n"


def beat(task):
    task.status.motion.heartbeat += 1
    task.publish()


def test_an_offset_comes_in_the_units_that_were_asked_for(session, task):
    task.status.task.g5x_offset = (25.4, 0.0, 0.0, 90.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.publish()
    session.answer("set linear_unit_conversion inch")
    words = session.answer("get pos_offset").split()
    assert [float(word) for word in words[1:5]] == pytest.approx([1.0, 0.0, 0.0, 90.0])


def test_a_relative_position_is_without_offsets(session, task):
    task.status.motion.traj.position = (10.0, 21.0, 30.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.status.task.g5x_offset = (10.0, 20.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.status.task.g92_offset = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.publish()
    words = session.answer("get rel_cmd_pos").split()
    assert [float(word) for word in words[1:4]] == pytest.approx([-1.0, 1.0, 25.0])


def test_stale_values_are_shown_to_those_who_want_them(session, task):
    session.answer("set update none")
    task.status.motion.traj.probeval = 1
    task.publish()
    assert session.answer("get probe_value") == "PROBE_VALUE 0\r\n"
    session.answer("set update_status")
    assert session.answer("get probe_value") == "PROBE_VALUE 1\r\n"


def test_each_message_is_told_once_to_every_client(session, server, task):
    other = connect(server, 6)
    task.errors.write(EMC_OPERATOR_ERROR(error="joint 0 following error"))
    for one in (session, other):
        assert one.answer("get operator_text") == "OPERATOR_TEXT OK\r\n"
        assert one.answer("get error") == "ERROR joint 0 following error\r\n"
        assert one.answer("get error") == "ERROR OK\r\n"


def test_help_lists_every_command(session):
    assert all(f"    {name}" in session.answer("help get") for name in GETTERS)
    assert all(f"    {name}" in session.answer("help set") for name in SETTERS)
    assert session.answer("help bogus") == "error: BOGUS is not a valid command.\r\n\r\n"


def test_every_get_command_answers(session):
    for name, question in GETTERS.items():
        reply = session.answer(f"get {name}").splitlines()[-1]
        assert reply.split()[0] == ("GET" if name == "INI" else question.said or name)


def test_no_set_command_with_an_order_is_taken_from_a_connection_that_is_not_enabled(task, server):
    stranger, guest = connect(server), connect(server, 6)
    guest.answer("hello EMC guest 1.0")
    for name, one in SETTERS.items():
        if one.access > Access.HELLO:
            assert stranger.answer(f"set {name} 1").splitlines()[-1].endswith("NAK")
            assert guest.answer(f"set {name} 1").splitlines()[-1].endswith("NAK")
    assert task.taken == []


def test_garbage_never_raises(session):
    ours = [name for name, one in SETTERS.items() if one.access > Access.HELLO]
    session.answer("set timeout 0.01")
    for name in [*ours, "BOGUS"]:
        for words in ("\xff\x00 \x01", "-1e999", "nan nan nan", "x y z", "999999999999999999999"):
            assert "SET" in session.answer(f"set {name} {words}")


@pytest.mark.parametrize("option", ["--enablepw=off", "--connectpw=two words", "--name=a\tb"])
def test_a_word_that_no_line_could_carry_is_refused_at_the_start(option, capsys):
    with pytest.raises(SystemExit):
        _parser().parse_args([option])
    assert "error" in capsys.readouterr().err
