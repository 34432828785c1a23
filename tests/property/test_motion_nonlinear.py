"""On kinematics that are not linear, too, every joint keeps its limits: jogs lag, programs stop with a message."""

from __future__ import annotations

import random

import pytest

from emcmot.kins import genhexkins, matrixkins, rotatekins, scarakins
from emcmot.kins.kinematics import KinematicsModule
from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import line

ROUNDING = 1e-6
START = {
    "scarakins": [20.0, 70.0, 100.0, 10.0, 0.0, 0.0],
    "matrixkins": [0.0] * 9,
    "rotatekins": [50.0, 20.0, 0.0, 0.0, 0.0, 30.0, 0.0, 0.0, 0.0],
}


def at_home(kins: KinematicsModule) -> Motion:
    """A homed machine somewhere in the middle of its space."""
    start = START.get(kins.name) or kins.inverse([1.0, -1.0, 30.0, 2.0, 3.0, -4.0, 0.0, 0.0, 0.0])
    m = Motion(kinematics=kins)
    for joint, place in enumerate(start):
        m.send(C.SET_JOINT_POSITION_LIMITS, joint=joint, minLimit=-500.0, maxLimit=500.0)
        m.send(C.SET_JOINT_VEL_LIMIT, joint=joint, vel=40.0)
        m.send(C.SET_JOINT_ACC_LIMIT, joint=joint, acc=400.0)
        m.send(C.SET_JOINT_HOMING_PARAMS, joint=joint, offset=place, home=place, home_sequence=0)
        m.send(C.JOINT_ACTIVATE, joint=joint)
    for axis in range(9):
        m.send(C.SET_AXIS_VEL_LIMIT, axis=axis, vel=100.0)
        m.send(C.SET_AXIS_ACC_LIMIT, axis=axis, acc=1000.0)
    m.send(C.ENABLE)
    m.step(2)
    m.send(C.JOINT_HOME, joint=-1)
    m.run_until_rest()
    assert m.errors() == []
    return m


def within_limits(m: Motion) -> bool:
    return m.worst_vel <= 1.0 + ROUNDING and m.worst_acc <= 1.0 + ROUNDING


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("module", [scarakins, genhexkins, rotatekins])
def test_cartesian_jogs_keep_every_joints_limits(module: object, seed: int) -> None:
    rng = random.Random(seed)
    m = at_home(module.create())  # type: ignore[attr-defined]
    for _ in range(60):
        m.send(C.TELEOP)
        code = rng.choice([C.JOG_CONT, C.JOG_INCR, C.ABORT, C.FREE])
        m.send(code, axis=rng.randrange(6), vel=rng.choice([-1, 1]) * rng.uniform(1, 120), offset=rng.uniform(0, 30))
        m.step(rng.choice([1, 10, 100, 400]))
        m.errors()
        assert within_limits(m)
    m.send(C.ABORT)
    m.run_until_rest(100_000)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("module", [scarakins, genhexkins, rotatekins])
def test_a_program_that_asks_too_much_of_a_joint_stops_within_the_limits(module: object, seed: int) -> None:
    rng = random.Random(seed)
    m = at_home(module.create())  # type: ignore[attr-defined]
    m.send(C.COORD)
    m.step(3)
    start = [m[f"axis.{a}.pos-cmd"] for a in "xyzabc"]
    speed = rng.choice([2.0, 100.0])
    for n in range(6):
        pos = [p + rng.uniform(-8, 8) for p in start] + [0.0] * 3
        m.send(C.SET_LINE, id=n + 1, pos=pos, vel=speed, ini_maxvel=100.0, acc=1000.0, termCond=1, motion_type=2)
    m.run_until_rest(200_000)
    texts = m.errors()
    assert within_limits(m)
    assert all("can't follow the path" in text or "reach" in text for text in texts)
    assert m["motion.in-position"]


def test_joints_that_another_geometry_moves_away_catch_up_before_the_next_move() -> None:
    kins = matrixkins.create()
    m = at_home(kins)
    m.send(C.COORD)
    m.step(2)
    line(m, 10, 20, 30)
    m.run_until_rest()
    kins.set_parameter("C_zz", 1.05)
    m.step(2)
    line(m, 11, 12, 13, id=2, vel=30.0)
    m.step(3)
    assert m["joint.0.pos-cmd"] == pytest.approx(10.0), "the move waits"
    m.run_until_rest()
    assert [m[f"joint.{n}.pos-cmd"] for n in range(3)] == pytest.approx([11.0, 12.0, 13.0 * 1.05])
    assert m.errors() == []
    assert within_limits(m)
