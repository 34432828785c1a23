"""halui without a machine: its pins are LinuxCNC's, its buttons give orders, its lamps show the status."""

from pathlib import Path

import pytest

import hal
import linuxcnc
from gui.halui import HalUi
from hal.values import PIN_DIR_NAMES, TYPE_NAMES
from tests.support.fake_task import RCS_DONE, RCS_ERROR, FakeTask

# Name, type and direction of every pin that LinuxCNC 2.10's halui has for three axes, one spindle, two MDI commands
PINS = Path(__file__).with_name("halui_pins.txt")
INI = """
[KINS]
JOINTS = 3
[TRAJ]
COORDINATES = X Y Z
[JOINT_0]
HOME_SEQUENCE = 0
[DISPLAY]
MAX_FEED_OVERRIDE = 1.2
MIN_SPINDLE_OVERRIDE = 0.5
[HALUI]
MDI_COMMAND = G0 X1
MDI_COMMAND = G0 X2
"""


def answer(command, status):
    match type(command).__name__:
        case "EMC_TASK_SET_MODE":
            status.task.mode = command.mode
        case "EMC_TRAJ_SET_SCALE":
            status.motion.traj.scale = command.scale
        case "EMC_TRAJ_SET_SPINDLE_SCALE":
            status.motion.spindle[command.spindle].spindle_scale = command.scale
        case "EMC_TASK_PLAN_EXECUTE" if command.command == "G0 X2":
            return RCS_ERROR
    return RCS_DONE


@pytest.fixture
def task():
    with FakeTask(answer) as task:
        task.status.task.state = linuxcnc.STATE_ON
        task.status.task.mode = linuxcnc.MODE_MANUAL
        task.status.task.interpState = linuxcnc.INTERP_IDLE
        task.status.motion.traj.mode = linuxcnc.TRAJ_MODE_FREE
        task.status.motion.traj.joints = 3
        task.status.motion.traj.scale = 1.0
        task.publish()
        yield task


@pytest.fixture
def ui(task, tmp_path):
    ini = tmp_path / "mill.ini"
    ini.write_text(INI)
    ui = HalUi(linuxcnc.ini(str(ini)))
    ui.cycle()
    yield ui
    ui.component.exit()


def press(ui, pin):
    """Press and release a button."""
    for level in (True, False):
        ui.component[pin] = level
        ui.cycle()


def orders(task):
    return [type(command).__name__ for command in task.taken]


def test_the_pins_are_linuxcncs(ui):
    ours = {
        f"halui.{name} {TYPE_NAMES[pin.get_type()]} {PIN_DIR_NAMES[pin.get_dir()]}"
        for name, pin in ui.component._pins.items()
    }
    assert ours == set(PINS.read_text().splitlines())


@pytest.mark.parametrize(
    ("pin", "message", "fields"),
    [
        ("abort", "EMC_TASK_ABORT", {}),
        ("estop.activate", "EMC_TASK_SET_STATE", {"state": linuxcnc.STATE_ESTOP}),
        ("machine.on", "EMC_TASK_SET_STATE", {"state": linuxcnc.STATE_ON}),
        ("home-all", "EMC_JOINT_HOME", {"joint": -1}),
        ("joint.2.home", "EMC_JOINT_HOME", {"joint": 2}),
        ("joint.1.unhome", "EMC_JOINT_UNHOME", {"joint": 1}),
        ("flood.on", "EMC_COOLANT_FLOOD_ON", {}),
        ("lube.off", "EMC_LUBE_OFF", {}),
        ("mode.mdi", "EMC_TASK_SET_MODE", {"mode": linuxcnc.MODE_MDI}),
        ("mode.teleop", "EMC_TRAJ_SET_TELEOP_ENABLE", {"enable": 1}),
        ("program.pause", "EMC_TASK_PLAN_PAUSE", {}),
        ("program.block-delete.on", "EMC_TASK_PLAN_SET_BLOCK_DELETE", {"state": True}),
        ("spindle.0.forward", "EMC_SPINDLE_ON", {"speed": 1.0, "spindle": 0}),
        ("spindle.0.stop", "EMC_SPINDLE_OFF", {"spindle": 0}),
        ("spindle.0.brake-on", "EMC_SPINDLE_BRAKE_ENGAGE", {"spindle": 0}),
    ],
)
def test_a_button_gives_its_order_once(ui, task, pin, message, fields):
    press(ui, pin)
    assert orders(task) == [message]
    assert {name: getattr(task.taken[0], name) for name in fields} == fields


def test_a_button_that_is_held_gives_one_order(ui, task):
    ui.component["abort"] = True
    for _ in range(5):
        ui.cycle()
    assert orders(task) == ["EMC_TASK_ABORT"]


def test_run_without_a_program_orders_nothing(ui, task):
    press(ui, "program.run")
    assert orders(task) == []


def test_run_switches_to_auto_first(ui, task):
    task.status.task.file = "/part.ngc"
    task.publish()
    press(ui, "program.run")
    assert orders(task) == ["EMC_TASK_SET_MODE", "EMC_TASK_PLAN_RUN"]


def test_a_held_jog_button_jogs_until_it_is_released(ui, task):
    ui.component["joint.jog-speed"] = 600.0
    ui.component["joint.1.minus"] = True
    for _ in range(3):
        ui.cycle()
    ui.component["joint.1.minus"] = False
    ui.cycle()
    jog, stop = task.taken
    assert (type(jog).__name__, jog.joint_or_axis, jog.vel, jog.jjogmode) == ("EMC_JOG_CONT", 1, -10.0, 1)
    assert (type(stop).__name__, stop.joint_or_axis) == ("EMC_JOG_STOP", 1)


def test_a_selected_jog_goes_over_to_the_joint_that_is_selected_meanwhile(ui, task):
    ui.component["joint.jog-speed"] = 60.0
    press(ui, "joint.2.select")
    ui.component["joint.selected.plus"] = True
    ui.cycle()
    press(ui, "joint.0.select")
    ui.component["joint.selected.plus"] = False
    ui.cycle()
    assert [(type(c).__name__, c.joint_or_axis) for c in task.taken] == [
        ("EMC_JOG_CONT", 2),
        ("EMC_JOG_STOP", 2),
        ("EMC_JOG_CONT", 0),
        ("EMC_JOG_STOP", 0),
    ]


def test_a_held_button_follows_the_jog_speed_and_does_not_jog_again_by_itself(ui, task):
    ui.component["joint.jog-speed"] = 60.0
    ui.component["joint.0.plus"] = True
    ui.cycle()
    ui.component["joint.jog-speed"] = 120.0
    for _ in range(3):
        ui.cycle()
    assert [command.vel for command in task.taken] == [1.0, 2.0]


def test_a_lever_inside_its_deadband_does_nothing(ui, task):
    ui.component["joint.jog-speed"] = 600.0
    ui.component["joint.0.analog"] = 0.15
    ui.cycle()
    assert task.taken == []
    ui.component["joint.0.analog"] = -0.5
    ui.cycle()
    assert task.taken[0].vel == -5.0


def test_an_increment_is_a_distance_with_a_direction(ui, task):
    ui.component["joint.jog-speed"] = 600.0
    ui.component["joint.0.increment"] = 0.1
    press(ui, "joint.0.increment-minus")
    (jog,) = task.taken
    assert (jog.vel, jog.incr) == (-10.0, 0.1)


def test_an_axis_jogs_in_teleop_mode_only_and_a_joint_in_joint_mode_only(ui, task):
    ui.component["axis.jog-speed"] = ui.component["joint.jog-speed"] = 600.0
    press(ui, "axis.x.plus")
    assert orders(task) == []
    task.status.motion.traj.mode = linuxcnc.TRAJ_MODE_TELEOP
    task.publish()
    ui.cycle()
    press(ui, "joint.0.plus")
    press(ui, "axis.b.plus")  # not an axis of this machine
    assert orders(task) == []
    press(ui, "axis.x.plus")
    assert orders(task) == ["EMC_JOG_CONT", "EMC_JOG_STOP"]


def test_an_axis_that_the_machine_lacks_cannot_be_selected(ui, task):
    press(ui, "axis.z.select")
    press(ui, "axis.a.select")
    ui.cycle()
    assert ui.component["axis.selected"] == 2
    assert ui.component["axis.z.is-selected"]


def test_counts_turn_the_feed_override(ui, task):
    ui.component["feed-override.scale"] = 0.05
    ui.component["feed-override.counts"] = 2
    ui.cycle()
    ui.cycle()
    assert task.status.motion.traj.scale == pytest.approx(1.1)
    ui.cycle()
    assert ui.component["feed-override.value"] == pytest.approx(1.1)
    ui.component["feed-override.count-enable"] = False
    ui.component["feed-override.counts"] = 9
    ui.cycle()
    ui.component["feed-override.count-enable"] = True
    ui.cycle()
    assert task.status.motion.traj.scale == pytest.approx(1.1)
    press(ui, "feed-override.reset")
    assert task.status.motion.traj.scale == 1.0


@pytest.mark.parametrize(("pin", "limit"), [("increase", 1.2), ("decrease", 0.0)])
def test_an_override_stays_within_its_limits(ui, task, pin, limit):
    for _ in range(15):
        press(ui, f"feed-override.{pin}")
    assert task.status.motion.traj.scale == pytest.approx(limit)


def test_a_spindle_override_has_limits_of_its_own(ui, task):
    ui.component["spindle.0.override.direct-value"] = True
    for counts, expected in ((1, 0.5), (20, 1.0)):
        ui.component["spindle.0.override.counts"] = counts
        ui.cycle()
        assert task.taken[-1].scale == pytest.approx(expected)


def test_a_speed_button_steps_when_pressed_and_keeps_the_speed_when_released(ui, task):
    press(ui, "spindle.0.increase")
    assert orders(task) == ["EMC_SPINDLE_INCREASE", "EMC_SPINDLE_CONSTANT"]


def test_a_direct_value_sets_the_override(ui, task):
    ui.component["feed-override.scale"] = 0.01
    ui.component["feed-override.direct-value"] = True
    ui.component["feed-override.counts"] = 75
    ui.cycle()
    assert task.status.motion.traj.scale == pytest.approx(0.75)


def test_an_mdi_button_returns_to_the_mode_from_before(ui, task):
    press(ui, "mdi-command-00")
    ui.cycle()
    assert orders(task) == ["EMC_TASK_SET_MODE", "EMC_TASK_PLAN_EXECUTE", "EMC_TASK_SET_MODE"]
    assert task.taken[1].command == "G0 X1"
    assert task.status.task.mode == linuxcnc.MODE_MANUAL
    assert not ui.component["halui-mdi-is-running"]


def test_a_refused_mdi_button_keeps_its_lamp_and_mode_until_something_is_done(ui, task):
    press(ui, "mdi-command-01")
    ui.cycle()
    assert task.status.task.mode == linuxcnc.MODE_MDI
    assert ui.component["halui-mdi-is-running"]
    press(ui, "machine.on")
    ui.cycle()
    assert task.status.task.mode == linuxcnc.MODE_MANUAL
    assert not ui.component["halui-mdi-is-running"]


def test_lamps_show_the_status(ui, task):
    task.status.motion.joint[1].homed = 1
    task.status.motion.traj.position = (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.status.motion.traj.actualPosition = (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.status.task.g5x_offset = (0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    task.publish()
    ui.cycle()
    assert ui.component["machine.is-on"] is True
    assert (ui.component["joint.0.is-homed"], ui.component["joint.1.is-homed"]) == (False, True)
    assert ui.component["axis.x.pos-commanded"] == 1.0
    assert ui.component["axis.x.pos-relative"] == 0.5
    assert hal.component_is_ready("halui")


def test_a_machine_without_homing_sequence_and_mdi_commands_has_no_pins_for_them(task, tmp_path):
    ini = tmp_path / "two.ini"
    ini.write_text("[KINS]\nJOINTS = 2\n[TRAJ]\nCOORDINATES = Y Z\nSPINDLES = 2\n")
    ui = HalUi(linuxcnc.ini(str(ini)))
    try:
        pins = set(ui.component._pins)
        assert not pins & {"home-all", "halui-mdi-is-running", "mdi-command-00", "joint.2.home", "axis.x.is-selected"}
        assert {"axis.x.plus", "spindle.1.start", "joint.1.home"} <= pins
        ui.cycle()
        assert ui.component["axis.y.is-selected"]
        assert ui.component["axis.selected"] == 0
    finally:
        ui.component.exit()
