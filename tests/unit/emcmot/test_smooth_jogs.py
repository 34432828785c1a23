"""Jogs and homing with limited jerk: nothing is ever commanded beyond a limit, and every move ends where it should."""

from __future__ import annotations

import random

import numpy as np
import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support import verify
from tests.support.mill import ACC, LIMIT, VEL, bring_to, configure

JERK = 8000.0
DT = 0.001
ROUNDING = 1e-5
MODES = ("homed", "teleop")


def smooth_mill(state: str, coordinates: str = "xyz") -> Motion:
    m = configure(Motion(coordinates))
    for joint in range(len(coordinates)):
        m.send(C.SET_JOINT_JERK_LIMIT, joint=joint, jerk=JERK)
    m.send(C.SET_PLANNER_TYPE, mode=1)
    return bring_to(m, state)


def jog(m: Motion, code: C, **fields: float) -> int:
    return int(m.send(code, joint=0, axis=0, mode=m.status.motion_state == 1, **fields))


def keeps_its_limits(m: Motion) -> bool:
    return max(m.worst_vel, m.worst_acc, m.worst_jerk) <= 1.0 + ROUNDING


def fastest(distance: float) -> float:
    """Seconds of the fastest move under the limits where velocity is reached and acceleration is not held."""
    ramp = 2.0 * np.sqrt(VEL / JERK) if VEL * JERK < ACC * ACC else VEL / ACC + ACC / JERK
    return float(ramp + distance / VEL)


@pytest.mark.parametrize("state", MODES)
def test_a_jog_is_an_s_curve_as_fast_as_the_limits_allow(state: str) -> None:
    m = smooth_mill(state)
    jog(m, C.JOG_ABS, vel=VEL, offset=80.0)
    rows = m.record(5000)
    assert rows[-1, 0] == 80.0
    jerk = np.diff(rows[:, 0], 3) / DT**3
    assert np.abs(jerk).max() == pytest.approx(JERK, rel=0.01)
    moving = np.count_nonzero(np.diff(rows[:, 0]))
    assert moving == pytest.approx(fastest(80.0) / DT, abs=3)
    assert not verify.limits_exceeded(rows, DT, [VEL] * 3, [ACC] * 3)
    assert keeps_its_limits(m)


@pytest.mark.parametrize("state", MODES)
def test_a_continuous_jog_slows_down_smoothly_before_the_limit(state: str) -> None:
    m = smooth_mill(state)
    jog(m, C.JOG_CONT, vel=VEL)
    rows = m.record(5000)
    assert rows[:, 0].max() == rows[-1, 0] == LIMIT
    assert keeps_its_limits(m)
    assert m.errors() == []


@pytest.mark.parametrize("state", MODES)
@pytest.mark.parametrize("seed", range(40))
def test_jogs_that_change_their_mind_keep_every_limit_and_end_at_their_target(state: str, seed: int) -> None:
    m = smooth_mill(state)
    rng = random.Random(seed)
    target = 0.0
    for _ in range(40):
        action = rng.randrange(4)
        if action == 0:
            target = rng.uniform(-LIMIT, LIMIT)
            jog(m, C.JOG_ABS, vel=rng.uniform(1, 150), offset=target)
        elif action == 1:
            jog(m, C.JOG_CONT, vel=rng.uniform(-150, 150))
        elif action == 2:
            m.send(C.FEED_SCALE, scale=rng.choice([0.0, 0.2, 0.7, 1.0, 1.2]))
        else:
            m.send(C.JOG_ABORT, joint=0, axis=0, mode=m.status.motion_state == 1)
        m.step(rng.choice([1, 3, 20, 100, 400]))
        assert abs(m["joint.0.pos-cmd"]) <= LIMIT
        assert keeps_its_limits(m)
    m.send(C.FEED_SCALE, scale=1.0)
    jog(m, C.JOG_ABS, vel=50.0, offset=12.5)
    m.run_until_rest(20_000)
    assert m["joint.0.pos-cmd"] == 12.5
    assert keeps_its_limits(m)


@pytest.mark.parametrize("state", MODES)
@pytest.mark.parametrize("velocity_mode", [False, True])
def test_a_wheel_moves_smoothly_and_ends_within_the_limits(state: str, velocity_mode: bool) -> None:
    m = smooth_mill(state)
    place = "joint.0" if state == "homed" else "axis.x"
    m[f"{place}.jog-enable"] = 1
    m[f"{place}.jog-scale"] = 0.05
    m[f"{place}.jog-vel-mode"] = velocity_mode
    rng = random.Random(1)
    for _ in range(200):
        m[f"{place}.jog-counts"] += rng.randrange(-20, 60)
        m.step(rng.randrange(1, 20))
    m.run_until_rest(20_000)
    assert abs(m["joint.0.pos-cmd"]) <= LIMIT
    assert keeps_its_limits(m)


def test_joints_home_smoothly_wherever_they_start() -> None:
    rng = random.Random(5)
    for _ in range(100):
        m = smooth_mill("free")
        edge, latch = rng.uniform(60, 80), rng.uniform(0.5, 5)
        m.place(0, rng.uniform(-55, 55), 3.0, rng.uniform(0, 3))
        m.add_switch(0, "home", edge, edge + 60.0)
        index = rng.random() < 0.5
        m.send(
            C.SET_JOINT_HOMING_PARAMS,
            joint=0,
            offset=rng.uniform(-20, 20),
            home=-15.0,
            search_vel=rng.uniform(5, 90),
            latch_vel=rng.choice([-latch, latch]),
            home_final_vel=-1.0,
            flags=2 * index,
        )
        m.send(C.JOINT_HOME, joint=0)
        m.run_until_rest(200_000)
        assert m.errors() == []
        assert m["joint.0.pos-cmd"] == -15.0
        assert keeps_its_limits(m)


def test_an_abort_of_a_smooth_jog_is_smooth() -> None:
    m = smooth_mill("homed")
    for steps in range(20, 400, 7):
        jog(m, C.JOG_ABS, vel=VEL, offset=-80.0 if m["joint.0.pos-cmd"] > 0.0 else 80.0)
        m.step(steps)
        m.send(C.ABORT)
        m.run_until_rest(5000)
        assert keeps_its_limits(m)


def test_an_external_offset_shares_the_jerk_of_its_axis() -> None:
    m = smooth_mill("teleop")
    m.send(C.SET_AXIS_VEL_LIMIT, axis=2, vel=VEL / 2, ext_offset_vel=VEL / 2)
    m.send(C.SET_AXIS_ACC_LIMIT, axis=2, acc=ACC / 2, ext_offset_acc=ACC / 2)
    m["axis.z.eoffset-enable"] = 1
    m["axis.z.eoffset-scale"] = 0.1
    rng = random.Random(2)
    for _ in range(60):
        m["axis.z.eoffset-counts"] = rng.randrange(-200, 200)
        m.send(C.JOG_ABS, axis=2, mode=0, vel=rng.uniform(1, 100), offset=rng.uniform(-60, 60))
        m.step(rng.choice([1, 50, 500]))
        assert keeps_its_limits(m)


def test_a_machine_whose_planner_is_trapezoidal_jogs_with_full_acceleration_at_once() -> None:
    m = smooth_mill("homed")
    m.send(C.SET_PLANNER_TYPE, mode=0)
    jog(m, C.JOG_CONT, vel=VEL)
    m.step(2)
    assert m["joint.0.acc-cmd"] == pytest.approx(ACC)


@pytest.mark.parametrize("coordinates", ["xyz", "xyyz"])
def test_the_jerk_of_the_machine_holds_for_joints_without_one(coordinates: str) -> None:
    m = configure(Motion(coordinates))
    m.send(C.SET_JERK, jerk=JERK)
    m.send(C.SET_PLANNER_TYPE, mode=1)
    bring_to(m, "homed")
    m.send(C.JOG_CONT, joint=0, mode=1, vel=VEL)
    m.step(100)
    m.send(C.JOG_ABORT, joint=0, mode=1)
    m.run_until_rest(5000)
    assert m.worst_jerk == pytest.approx(1.0, rel=0.01)
