"""Commands of the client module: which message each of them writes, and how waiting works."""

import pytest

import linuxcnc
from tests.support.fake_task import RCS_DONE, RCS_ERROR, FakeTask

CALLS = [
    ("abort", (), "EMC_TASK_ABORT", {}),
    ("state", (linuxcnc.STATE_ON,), "EMC_TASK_SET_STATE", {"state": 4}),
    ("mode", (linuxcnc.MODE_MDI,), "EMC_TASK_SET_MODE", {"mode": 3}),
    ("debug", (16,), "EMC_SET_DEBUG", {"debug": 16}),
    ("program_open", ("part.ngc",), "EMC_TASK_PLAN_OPEN", {"file": "part.ngc"}),
    ("auto", (linuxcnc.AUTO_RUN, 7), "EMC_TASK_PLAN_RUN", {"line": 7}),
    ("auto", (linuxcnc.AUTO_STEP,), "EMC_TASK_PLAN_STEP", {}),
    ("auto", (linuxcnc.AUTO_PAUSE,), "EMC_TASK_PLAN_PAUSE", {}),
    ("auto", (linuxcnc.AUTO_RESUME,), "EMC_TASK_PLAN_RESUME", {}),
    ("auto", (linuxcnc.AUTO_REVERSE,), "EMC_TASK_PLAN_REVERSE", {}),
    ("auto", (linuxcnc.AUTO_FORWARD,), "EMC_TASK_PLAN_FORWARD", {}),
    ("mdi", ("G0 X1",), "EMC_TASK_PLAN_EXECUTE", {"command": "G0 X1"}),
    ("reset_interpreter", (), "EMC_TASK_PLAN_INIT", {}),
    ("task_plan_synch", (), "EMC_TASK_PLAN_SYNCH", {}),
    ("set_optional_stop", (1,), "EMC_TASK_PLAN_SET_OPTIONAL_STOP", {"state": True}),
    ("set_block_delete", (0,), "EMC_TASK_PLAN_SET_BLOCK_DELETE", {"state": False}),
    ("home", (-1,), "EMC_JOINT_HOME", {"joint": -1}),
    ("unhome", (2,), "EMC_JOINT_UNHOME", {"joint": 2}),
    ("jog", (linuxcnc.JOG_STOP, True, 1), "EMC_JOG_STOP", {"joint_or_axis": 1, "jjogmode": 1}),
    (
        "jog",
        (linuxcnc.JOG_CONTINUOUS, False, 2, -5.0),
        "EMC_JOG_CONT",
        {"joint_or_axis": 2, "jjogmode": 0, "vel": -5.0},
    ),
    (
        "jog",
        (linuxcnc.JOG_INCREMENT, True, 0, 10.0, 0.5),
        "EMC_JOG_INCR",
        {"joint_or_axis": 0, "jjogmode": 1, "vel": 10.0, "incr": 0.5},
    ),
    ("override_limits", (), "EMC_JOINT_OVERRIDE_LIMITS", {}),
    ("override_limits", (-1,), "EMC_JOINT_OVERRIDE_LIMITS", {"joint": -1}),
    ("clear_probe_tripped", (), "EMC_TRAJ_CLEAR_PROBE_TRIPPED_FLAG", {}),
    ("set_min_limit", (1, -20.0), "EMC_JOINT_SET_MIN_POSITION_LIMIT", {"joint": 1, "limit": -20.0}),
    ("set_max_limit", (1, 20.0), "EMC_JOINT_SET_MAX_POSITION_LIMIT", {"joint": 1, "limit": 20.0}),
    ("teleop_enable", (1,), "EMC_TRAJ_SET_TELEOP_ENABLE", {"enable": 1}),
    ("traj_mode", (linuxcnc.TRAJ_MODE_COORD,), "EMC_TRAJ_SET_MODE", {"mode": 2}),
    ("feedrate", (0.5,), "EMC_TRAJ_SET_SCALE", {"scale": 0.5}),
    ("rapidrate", (0.25,), "EMC_TRAJ_SET_RAPID_SCALE", {"scale": 0.25}),
    ("spindleoverride", (1.2, 1), "EMC_TRAJ_SET_SPINDLE_SCALE", {"scale": 1.2, "spindle": 1}),
    ("maxvel", (30.0,), "EMC_TRAJ_SET_MAX_VELOCITY", {"velocity": 30.0}),
    ("set_feed_override", (1,), "EMC_TRAJ_SET_FO_ENABLE", {"mode": 1}),
    ("set_spindle_override", (0, 1), "EMC_TRAJ_SET_SO_ENABLE", {"mode": 0, "spindle": 1}),
    ("set_feed_hold", (1,), "EMC_TRAJ_SET_FH_ENABLE", {"mode": 1}),
    ("set_adaptive_feed", (1,), "EMC_MOTION_ADAPTIVE", {"status": 1}),
    (
        "spindle",
        (linuxcnc.SPINDLE_REVERSE, 500.0, 1, 1),
        "EMC_SPINDLE_ON",
        {"speed": -500.0, "spindle": 1, "wait_for_spindle_at_speed": 1},
    ),
    ("spindle", (linuxcnc.SPINDLE_OFF,), "EMC_SPINDLE_OFF", {"spindle": 0}),
    ("spindle", (linuxcnc.SPINDLE_INCREASE, 2), "EMC_SPINDLE_INCREASE", {"spindle": 2}),
    ("brake", (linuxcnc.BRAKE_ENGAGE,), "EMC_SPINDLE_BRAKE_ENGAGE", {"spindle": 0}),
    ("brake", (linuxcnc.BRAKE_RELEASE,), "EMC_SPINDLE_BRAKE_RELEASE", {"spindle": 0}),
    ("flood", (linuxcnc.FLOOD_ON,), "EMC_COOLANT_FLOOD_ON", {}),
    ("mist", (linuxcnc.MIST_OFF,), "EMC_COOLANT_MIST_OFF", {}),
    ("lube", (1,), "EMC_LUBE_ON", {}),
    ("lube", (0,), "EMC_LUBE_OFF", {}),
    ("load_tool_table", (), "EMC_TOOL_LOAD_TOOL_TABLE", {"file": ""}),
    ("set_digital_output", (3, 1), "EMC_MOTION_SET_DOUT", {"index": 3, "start": 1, "end": 1, "now": 1}),
    ("set_analog_output", (2, 1.5), "EMC_MOTION_SET_AOUT", {"index": 2, "start": 1.5, "end": 1.5, "now": 1}),
    ("error_msg", ("stop",), "EMC_OPERATOR_ERROR", {"error": "stop"}),
    ("text_msg", ("note",), "EMC_OPERATOR_TEXT", {"text": "note"}),
    ("display_msg", ("show",), "EMC_OPERATOR_DISPLAY", {"display": "show"}),
]


@pytest.fixture
def task():
    with FakeTask() as task:
        yield task


@pytest.mark.parametrize(("method", "arguments", "message", "fields"), CALLS)
def test_a_method_writes_its_message(task, method, arguments, message, fields):
    getattr(linuxcnc.command(), method)(*arguments)
    (taken,) = task.taken
    assert type(taken).__name__ == message
    assert {name: getattr(taken, name) for name in fields} == fields


def test_every_public_method_has_a_case_here():
    methods = {name for name in dir(linuxcnc.command) if not name.startswith("_")}
    assert methods - {"wait_complete", "result", "serial"} == {call[0] for call in CALLS} | {"tool_offset"}


def test_a_tool_offset_carries_z_before_x(task):
    linuxcnc.command().tool_offset(3, 12.5, 1.5, 6.0, 10.0, 20.0, 2)
    (taken,) = task.taken
    assert (taken.toolno, taken.offset.tran.z, taken.offset.tran.x) == (3, 12.5, 1.5)
    assert (taken.diameter, taken.frontangle, taken.backangle, taken.orientation) == (6.0, 10.0, 20.0, 2)


def test_wait_complete_tells_a_failure_from_success():
    def answer(command, status):
        return RCS_ERROR if command.TYPE_ID == 509 else RCS_DONE

    with FakeTask(answer):
        command = linuxcnc.command()
        command.abort()
        assert command.wait_complete() == linuxcnc.RCS_DONE
        command.mdi("G0 XQ")
        assert command.wait_complete() == linuxcnc.RCS_ERROR


def test_wait_complete_returns_minus_one_when_the_command_goes_on():
    with FakeTask(lambda command, status: linuxcnc.RCS_EXEC):
        command = linuxcnc.command()
        command.mdi("G4 P100")
        assert command.wait_complete(0.05) == -1


def test_a_later_command_of_another_client_ends_the_wait(task):
    first, second = linuxcnc.command(), linuxcnc.command()
    first.mdi("G0 X1")
    second.abort()
    assert first.wait_complete() == linuxcnc.RCS_DONE


@pytest.mark.parametrize(
    ("method", "arguments"),
    [("auto", (99,)), ("jog", (9, 1, 0)), ("brake", (5,)), ("flood", (5,)), ("mdi", ("G1 " * 100,))],
)
def test_a_wrong_argument_is_refused_before_anything_is_sent(task, method, arguments):
    with pytest.raises(linuxcnc.error):
        getattr(linuxcnc.command(), method)(*arguments)
    assert task.taken == []
