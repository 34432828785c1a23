"""Jogs: continuous, incremental, absolute and by wheel, of joints and axes, within the limits."""

from __future__ import annotations

import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import LIMIT, bring_to, configure, mill


def jog(m: Motion, code: C, index: int = 0, **fields: float) -> int:
    """Jog the joint in joint mode, the axis in teleop mode."""
    return int(m.send(code, joint=index, axis=index, mode=m.status.motion_state == 1, **fields))


def position(m: Motion, index: int = 0) -> float:
    return float(m[f"joint.{index}.pos-cmd"])


MODES = ("homed", "teleop")


@pytest.mark.parametrize("state", MODES)
@pytest.mark.parametrize("sign", [1, -1])
def test_a_continuous_jog_ends_at_the_soft_limit(state: str, sign: int) -> None:
    m = mill(state)
    jog(m, C.JOG_CONT, vel=80.0 * sign)
    m.step(10)
    assert m["motion.jog-is-active"]
    assert not m["motion.in-position"]
    m.run_until_rest()
    assert position(m) == LIMIT * sign
    assert not m["motion.jog-is-active"]
    assert (m.worst_vel <= 0.8 + 1e-6, m.worst_acc <= 1.0 + 1e-6) == (True, True)
    assert m.errors() == []


@pytest.mark.parametrize("state", MODES)
def test_a_jog_that_makes_a_limit_worse_is_refused_and_the_way_back_is_open(state: str) -> None:
    m = mill(state)
    jog(m, C.JOG_CONT, vel=80.0)
    m.run_until_rest()
    assert jog(m, C.JOG_CONT, vel=80.0) != 0
    (error,) = m.errors()
    assert "further past max soft limit. It is at" in error
    assert jog(m, C.JOG_INCR, vel=10.0, offset=-3.0) == 0
    m.run_until_rest()
    assert position(m) == LIMIT - 3.0


@pytest.mark.parametrize("state", MODES)
def test_increments_add_up_while_the_joint_moves(state: str) -> None:
    m = mill(state)
    for _ in range(4):
        jog(m, C.JOG_INCR, vel=20.0, offset=2.5)
        m.step(20)
    m.run_until_rest()
    assert position(m) == 10.0
    jog(m, C.JOG_INCR, vel=-20.0, offset=4.0)
    m.run_until_rest()
    assert position(m) == 6.0


@pytest.mark.parametrize("state", MODES)
def test_an_increment_beyond_the_limit_stops_there(state: str) -> None:
    m = mill(state)
    jog(m, C.JOG_INCR, vel=50.0, offset=500.0)
    m.run_until_rest()
    assert position(m) == LIMIT


@pytest.mark.parametrize("state", MODES)
def test_the_target_of_an_absolute_jog_may_change_on_the_way(state: str) -> None:
    m = mill(state)
    for target in (50.0, -20.0, 7.0):
        jog(m, C.JOG_ABS, vel=90.0, offset=target)
        m.step(300)
    m.run_until_rest()
    assert position(m) == 7.0
    assert m.worst_acc <= 1.0 + 1e-6


@pytest.mark.parametrize("state", MODES)
def test_a_continuous_jog_that_goes_on_takes_another_speed(state: str) -> None:
    m = mill(state)
    for vel in (20.0, 60.0, 10.0, -30.0):
        jog(m, C.JOG_CONT, vel=vel)
        before = position(m)
        m.step(500)
        begun = position(m)
        m.step(1)
        assert position(m) - begun == pytest.approx(vel * 0.001)
        assert (position(m) > before) == (vel > 0.0)
    assert m.errors() == []
    assert m.worst_acc <= 1.0 + 1e-6


@pytest.mark.parametrize("state", MODES)
@pytest.mark.parametrize("how", ["command", "abort", "pin", "immediate pin"])
def test_a_jog_stops_under_its_acceleration(state: str, how: str) -> None:
    m = mill(state)
    jog(m, C.JOG_CONT, vel=100.0)
    m.step(300)
    before = position(m)
    if how == "command":
        jog(m, C.JOG_ABORT)
    elif how == "abort":
        m.send(C.ABORT)
    else:
        m["motion.jog-stop" if how == "pin" else "motion.jog-stop-immediate"] = 1
    m.run_until_rest()
    assert position(m) - before == pytest.approx(100.0**2 / 2000.0, rel=0.03)
    assert m.worst_acc <= 1.0 + 1e-6


def test_the_feed_override_slows_jogs_down_but_not_homing() -> None:
    m = mill("homed")
    m.send(C.FEED_SCALE, scale=0.25)
    jog(m, C.JOG_CONT, vel=100.0)
    m.step(500)
    assert m["joint.0.vel-cmd"] == pytest.approx(25.0)
    m.send(C.FEED_SCALE, scale=0.0)
    m.step(500)
    assert m["joint.0.vel-cmd"] == 0.0


def test_an_unhomed_joint_may_be_jogged_over_its_whole_travel() -> None:
    m = mill("free", limit=20.0)
    jog(m, C.JOG_CONT, vel=100.0)
    m.run_until_rest()
    assert position(m) == pytest.approx(40.0)


def test_axes_of_a_gantry_jog_both_joints() -> None:
    m = bring_to(configure(Motion("xyyz"), axes=3), "teleop")
    jog(m, C.JOG_INCR, 1, vel=20.0, offset=5.0)
    m.run_until_rest()
    assert [position(m, j) for j in range(4)] == [0.0, 5.0, 5.0, 0.0]


def test_a_teleop_vector_moves_all_axes_at_once() -> None:
    m = mill("teleop")
    m.send(C.SET_TELEOP_VECTOR, pos=(10.0, -20.0, 0, 0, 0, 0, 0, 0, 0))
    m.step(200)
    assert m["axis.x.teleop-vel-cmd"] == pytest.approx(10.0)
    assert m["axis.y.teleop-vel-cmd"] == pytest.approx(-20.0)
    m.send(C.SET_TELEOP_VECTOR)
    m.run_until_rest()


def test_a_missing_axis_is_not_jogged() -> None:
    m = mill("teleop")
    assert jog(m, C.JOG_CONT, 4, vel=5.0) != 0
    assert m.errors() == ["Can't jog axis B: this machine has none"]


@pytest.mark.parametrize(("state", "place"), [("homed", "joint.0"), ("teleop", "axis.x")])
def test_a_wheel_moves_a_scale_for_each_count(state: str, place: str) -> None:
    m = mill(state)
    m[f"{place}.jog-scale"] = 0.1
    m[f"{place}.jog-counts"] = 50  # turned while not enabled: ignored
    m.step(5)
    m[f"{place}.jog-enable"] = 1
    m[f"{place}.jog-counts"] = 80
    m.step(2)
    assert m[f"{place}.wheel-jog-active"]
    m.run_until_rest()
    assert position(m) == pytest.approx(3.0)
    m.step(2)
    assert not m[f"{place}.wheel-jog-active"]


def test_a_wheel_in_velocity_mode_stops_soon_after_the_hand() -> None:
    m = mill("homed")
    m["joint.0.jog-enable"] = 1
    m["joint.0.jog-scale"] = 1.0
    m["joint.0.jog-vel-mode"] = 1
    for _ in range(100):
        m["joint.0.jog-counts"] += 1
        m.step(2)
    there = position(m)
    m.run_until_rest()
    assert position(m) - there <= 2 * 100.0**2 / 2000.0 + 0.2
    assert m.worst_acc <= 1.0 + 1e-6


def test_a_wheel_accelerates_with_its_fraction() -> None:
    m = mill("homed")
    m["joint.0.jog-enable"] = 1
    m["joint.0.jog-scale"] = 1.0
    m["joint.0.jog-accel-fraction"] = 0.25
    m["joint.0.jog-counts"] = 20
    m.worst_acc = 0.0
    m.run_until_rest()
    assert m.worst_acc == pytest.approx(0.25)


def test_overridden_limits_last_until_the_next_jog_has_ended() -> None:
    m = mill("homed")
    m["joint.0.pos-lim-sw-in"] = 1
    m.step(100)
    assert m.errors() == ["joint 0 on limit switch error"]
    m.send(C.OVERRIDE_LIMITS, joint=0)
    m.send(C.ENABLE)
    m.step(100)
    assert m.errors() == []
    assert m.status.motion_state == 1
    assert m.status.overrideLimitMask == 2
    jog(m, C.JOG_INCR, vel=10.0, offset=-1.0)
    m.step(5)
    assert m.status.overrideLimitMask == 2
    m["joint.0.pos-lim-sw-in"] = 0
    m.run_until_rest()
    assert m.status.overrideLimitMask == 0
    m["joint.0.pos-lim-sw-in"] = 1
    m.step()
    assert m.errors() == ["joint 0 on limit switch error"]


def overridden(*switches: str) -> Motion:
    """Switched on with these limit switches of joint 0 closed."""
    m = mill("homed")
    for switch in switches:
        m[f"joint.0.{switch}-lim-sw-in"] = 1
    m.step(100)
    m.send(C.OVERRIDE_LIMITS, joint=0)
    m.send(C.ENABLE)
    m.step(100)
    m.errors()
    assert m.status.motion_state == 1
    return m


def test_an_override_opens_the_way_off_a_switch_and_not_the_way_on() -> None:
    m = overridden("neg")
    assert jog(m, C.JOG_CONT, vel=-10.0) != 0
    assert m.errors() == ["Can't jog joint 0 further past min hard limit."]
    m["joint.0.jog-enable"] = 1
    m["joint.0.jog-scale"] = 0.1
    m["joint.0.jog-counts"] = -5
    m.step(200)
    assert position(m) == 0.0
    m["joint.0.jog-counts"] = 5
    m.step(200)
    assert position(m) == pytest.approx(1.0)


@pytest.mark.parametrize("vel", [10.0, -10.0])
def test_both_ways_are_open_under_an_override_where_two_switches_share_a_wire(vel: float) -> None:
    m = overridden("neg", "pos")
    assert jog(m, C.JOG_CONT, vel=vel) == 0
    m.step(100)
    assert position(m) * vel > 0.0


def test_an_override_can_be_taken_back() -> None:
    m = mill("homed")
    m["joint.0.pos-lim-sw-in"] = 1
    m.step(2)
    m.send(C.OVERRIDE_LIMITS, joint=0)
    m.send(C.ENABLE)
    m.step(100)
    m.errors()
    m.send(C.OVERRIDE_LIMITS, joint=-1)
    m.step()
    assert m.errors() == ["joint 0 on limit switch error"]


def indexer(state: str) -> Motion:
    """A mill whose a axis is a locking indexer on joint 3."""
    m = configure(Motion("xyza", unlock_joints_mask=8), axes=4)
    m.send(C.SET_AXIS_LOCKING_JOINT, axis=3, joint=3)
    return bring_to(m, state)


def test_a_locking_indexer_is_not_jogged() -> None:
    m = indexer("homed")
    assert m.send(C.JOG_CONT, joint=3, mode=1, vel=5.0) != 0
    assert m.errors() == ["Can't jog locking joint_num=3"]
    m.send(C.TELEOP)
    m.step(2)
    assert m.send(C.JOG_INCR, axis=3, mode=0, vel=5.0, offset=1.0) != 0
    assert m.errors() == ["Cannot jog a locking indexer AXIS_A,joint_num=3"]
    assert m.send(C.JOG_INCR, axis=0, mode=0, vel=5.0, offset=1.0) == 0


@pytest.mark.parametrize(
    ("state", "place", "complaint"),
    [
        ("homed", "joint.3", "Can't wheel jog locking joint_num=3"),
        ("teleop", "axis.a", "Cannot jog a locking indexer AXIS_A,joint_num=3"),
    ],
)
def test_the_wheel_of_a_locking_indexer_moves_nothing_and_says_so_once(state: str, place: str, complaint: str) -> None:
    m = indexer(state)
    m[f"{place}.jog-enable"] = 1
    m[f"{place}.jog-scale"] = 1.0
    for _ in range(20):
        m[f"{place}.jog-counts"] += 1
        m.step(5)
    assert m.errors() == [complaint]
    assert m["joint.3.pos-cmd"] == 0.0


def test_an_axis_of_joints_that_home_together_is_jogged_only_when_they_are_homed() -> None:
    m = configure(Motion("xyyz"))
    for joint in (1, 2):
        m.send(C.SET_JOINT_HOMING_PARAMS, joint=joint, home_sequence=-1)
    bring_to(m, "free")
    m.send(C.TELEOP)
    m.step(2)
    assert m.send(C.JOG_CONT, axis=1, mode=0, vel=5.0) != 0
    [error] = m.errors()
    assert error.startswith("Homing is REQUIRED to jog requested coordinate because joint (1)")
    assert m.send(C.JOG_CONT, axis=0, mode=0, vel=5.0) == 0


def test_a_joint_jog_in_teleop_mode_is_refused_by_name_of_the_mode() -> None:
    m = mill("teleop")
    assert m.send(C.JOG_CONT, joint=0, mode=1, vel=5.0) != 0
    assert m.errors() == ["Mode is TELEOP, cannot jog joint"]
