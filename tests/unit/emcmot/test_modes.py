"""Free, teleop and coordinated mode, on and off, faults and supervision."""

from __future__ import annotations

import math

import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import bring_to, configure, line, mill

DISABLED, FREE, TELEOP, COORD = range(4)
NAMES = {FREE: C.FREE, TELEOP: C.TELEOP, COORD: C.COORD}


def state(m: Motion) -> int:
    return int(m.status.motion_state)


@pytest.mark.parametrize("first", NAMES)
@pytest.mark.parametrize("second", NAMES)
def test_every_change_of_mode_is_possible_at_rest_and_moves_nothing(first: int, second: int) -> None:
    m = mill("coord")
    line(m, 1.23, -4.56, 7.89)
    m.run_until_rest()
    for mode in (first, second):
        m.send(NAMES[mode])
        m.step(3)
        assert state(m) == mode
        assert [m[f"joint.{j}.motor-pos-cmd"] for j in range(3)] == pytest.approx([1.23, -4.56, 7.89], abs=1e-12)
    assert m.worst_acc <= 1.0 + 1e-6


def test_a_mode_is_refused_while_a_program_moves_and_the_program_goes_on() -> None:
    m = mill("coord")
    line(m, 20)
    m.step(50)
    assert m.send(C.FREE) != 0
    assert m.errors() == ["can't go into joint mode while the machine is moving"]
    m.run_until_rest()
    assert m["joint.0.pos-cmd"] == pytest.approx(20.0)
    assert state(m) == COORD


def test_a_mode_asked_for_during_an_abort_comes_at_rest() -> None:
    m = mill("coord")
    line(m, 80, vel=100.0)
    m.step(400)
    m.send(C.ABORT)
    assert m.send(C.FREE) == 0
    m.step(1)
    assert state(m) == COORD
    m.run_until_rest()
    m.step(2)
    assert state(m) == FREE
    assert m.worst_acc <= 1.0 + 1e-6


def test_other_than_identity_kinematics_must_be_homed_for_cartesian_modes() -> None:
    from emcmot.kins import trivkins

    m = bring_to(configure(Motion(kinematics=trivkins.create("xyz", "both"))), "free")
    for mode, name in ((C.TELEOP, "teleop"), (C.COORD, "coordinated")):
        assert m.send(mode) != 0
        assert m.errors() == [f"all joints must be homed before going into {name} mode"]
    assert not m.status.carte_pos_fb_ok


def test_a_gantry_that_stands_askew_is_squared_slowly_before_a_cartesian_mode() -> None:
    m = configure(Motion("xyy"), axes=2)
    m.loopback = False
    m["joint.2.motor-pos-fb"] = 0.4
    m.step(200)
    m.loopback = True
    bring_to(m, "free")
    for joint in range(3):
        m.send(C.SET_JOINT_HOMING_PARAMS, joint=joint, offset=0.4 if joint == 2 else 0.0, home=0.4 if joint == 2 else 0)
    m.send(C.JOINT_HOME, joint=-1)
    m.run_until_rest()
    m.worst_vel = 0.0
    m.send(C.COORD)
    m.step(2)
    assert state(m) == FREE
    m.step(200)
    assert state(m) == COORD
    assert m["joint.2.pos-cmd"] == m["joint.1.pos-cmd"] == 0.0
    assert m.worst_vel <= 0.1 + 1e-6


@pytest.mark.parametrize("start", ["free", "homed", "teleop", "coord"])
def test_switching_off_drops_the_drives_at_once_and_ramps_the_commands(start: str) -> None:
    m = mill(start)
    if start == "coord":
        line(m, 90, 90, vel=100.0)
    else:
        m.send(C.JOG_CONT, mode=start != "teleop", vel=100.0)
    m.step(300)
    assert m["joint.0.vel-cmd"] > 60
    m.send(C.DISABLE)
    m.step()
    assert not m["joint.0.amp-enable-out"]
    assert state(m) == DISABLED
    assert m["joint.0.vel-cmd"] > 50
    m.run_until_rest()
    m.step()
    assert m["joint.0.vel-cmd"] == 0.0
    assert m.worst_acc <= 1.0 + 1e-6


def test_commands_follow_the_hand_while_off_and_start_from_there() -> None:
    m = mill("homed")
    m.send(C.DISABLE)
    m.step(5)
    m.loopback = False
    m["joint.1.motor-pos-fb"] = 2.0
    m.step(1000)
    assert m["joint.1.motor-pos-cmd"] == 2.0
    m["joint.1.motor-pos-fb"] = 2.7
    m.send(C.ENABLE)
    m.step()
    assert m["joint.1.motor-pos-cmd"] == 2.7, "drives are switched on without a following error"
    assert m["joint.1.f-error"] == pytest.approx(0.0, abs=1.0)


@pytest.mark.parametrize(
    ("pin", "value", "text"),
    [
        ("motion.enable", 0, "motion stopped by enable input"),
        ("joint.1.amp-fault-in", 1, "joint 1 amplifier fault"),
        ("joint.1.pos-lim-sw-in", 1, "joint 1 on limit switch error"),
        ("joint.1.neg-lim-sw-in", 1, "joint 1 on limit switch error"),
        ("spindle.0.amp-fault-in", 1, "spindle 0 amplifier fault"),
    ],
)
def test_a_fault_switches_off_within_one_period_and_says_why(pin: str, value: int, text: str) -> None:
    m = mill("coord")
    line(m, 90, vel=100.0)
    m.send(C.SPINDLE_ON, vel=500.0)
    m.step(300)
    m[pin] = value
    m.step()
    assert state(m) == DISABLED
    assert not m["joint.0.amp-enable-out"]
    assert not m["spindle.0.on"]
    assert m.errors() == [text]
    m.run_until_rest()
    assert m.worst_acc <= 1.0 + 1e-6
    if pin != "motion.enable":
        m[pin] = 0
        m.send(C.ENABLE)
        m.step(100)
        assert state(m) == COORD, "the mode that was asked for last"
        assert m["motion.in-position"], "nothing goes on by itself"
        assert not m["spindle.0.on"]
        assert m.status.depth == 0


@pytest.mark.parametrize("jump", [2.0, -2.0, math.nan, math.inf])
def test_a_jump_of_the_feedback_trips_following_error_within_one_period(jump: float) -> None:
    m = mill("coord")
    line(m, 50)
    m.step(100)
    m.loopback = False
    m["joint.2.motor-pos-fb"] = jump
    m.step()
    assert state(m) == DISABLED
    (error,) = m.errors()
    assert error.startswith("joint 2 following error")
    assert m["joint.2.f-errored"]


def test_the_following_error_limit_grows_with_speed_from_its_minimum() -> None:
    m = mill("homed")
    m.step()
    assert m["joint.0.f-error-lim"] == 0.5
    m.send(C.JOG_CONT, mode=1, vel=75.0)
    m.step(200)
    assert m["joint.0.f-error-lim"] == pytest.approx(0.75)


def test_enabling_is_refused_while_the_enable_pin_is_false() -> None:
    m = configure(Motion("xyz"))
    m["motion.enable"] = 0
    assert m.send(C.ENABLE) != 0
    assert m.errors() == ["can't enable motion, enable input is false"]


def test_enabling_is_refused_while_a_feedback_is_not_a_number() -> None:
    m = configure(Motion("xyz"))
    m.loopback = False
    m["joint.1.motor-pos-fb"] = math.nan
    m.send(C.ENABLE)
    m.step(2)
    assert state(m) == DISABLED
    assert "joint 1" in m.errors()[0]


def test_a_missing_heartbeat_stops_and_switches_off_and_a_new_command_is_heard() -> None:
    m = mill("coord")
    m.send(C.SET_HEARTBEAT_TIMEOUT, timeout=0.1)
    line(m, 90, vel=100.0)
    for _ in range(10):
        m.step(50)
        m.send(C.HEARTBEAT)
    assert state(m) == COORD
    m.step(99)
    assert not m.status.task_lost
    m.step(2)
    assert m.status.task_lost
    m.step(1000)
    assert state(m) == DISABLED
    assert m["motion.in-position"]
    assert m.errors() == ["Task has not answered for 0.100 s: motion stopped"]
    assert m.worst_acc <= 1.0 + 1e-6
    m.send(C.ENABLE)
    m.step(2)
    assert state(m) == COORD
    assert not m.status.task_lost


def test_an_amplifier_can_be_switched_alone() -> None:
    m = configure(Motion("xyz"))
    m.send(C.JOINT_ENABLE_AMPLIFIER, joint=1)
    m.step()
    assert [m[f"joint.{j}.amp-enable-out"] for j in range(3)] == [False, True, False]
    m.send(C.JOINT_DISABLE_AMPLIFIER, joint=1)
    m.step()
    assert not m["joint.1.amp-enable-out"]


def test_an_inactive_joint_is_left_alone_by_faults_and_enable() -> None:
    m = configure(Motion("xyz"))
    m.send(C.JOINT_DEACTIVATE, joint=2)
    m["joint.2.amp-fault-in"] = 1
    m.send(C.ENABLE)
    m.step(3)
    assert state(m) == FREE
    assert not m["joint.2.amp-enable-out"]


def test_the_number_of_joints_is_given_at_load_and_may_be_lowered_while_off() -> None:
    m = Motion("xy", num_joints=4)
    assert m.status.num_joints == 4
    assert m.send(C.SET_NUM_JOINTS, joint=1) != 0, "the kinematics need two"
    assert m.send(C.SET_NUM_JOINTS, joint=5) != 0, "motmod has four"
    assert len(m.errors()) == 2
    assert m.send(C.SET_NUM_JOINTS, joint=3) == 0
    m.step()
    assert m.status.num_joints == 3
    assert m.send(C.SET_JOINT_VEL_LIMIT, joint=3, vel=1.0) != 0
    assert m.errors() == ["SET_JOINT_VEL_LIMIT refused: there is no such joint"]
