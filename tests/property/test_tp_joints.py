"""On any kinematics, programs run through with every joint within its limits, and as fast as one of them allows."""

import random

import pytest

from emcmot.kins import corexykins, genhexkins, rotatekins, scarakins
from nml.emc.emcmot import MotCommand as C
from tests.property.test_motion_nonlinear import at_home

ROUNDING = 1e-6
MODULES = [scarakins, genhexkins, rotatekins, corexykins]


def run(module, seed, **options):
    """Six random moves; the machine afterwards, and what it said."""
    rng = random.Random(seed)
    m = at_home(module.create())
    m.send(C.COORD)
    m.step(3)
    m.send(C.SET_TERM_COND, termCond=2, tolerance=0.05)
    start = [m[f"axis.{a}.pos-cmd"] for a in "xyzabc"]
    for n in range(6):
        pos = [p + rng.uniform(-8, 8) * (k < 3 or options.get("turn", 0.0)) for k, p in enumerate(start)] + [0.0] * 3
        m.send(C.SET_LINE, id=n + 1, pos=pos, vel=100.0, ini_maxvel=100.0, acc=1000.0, termCond=2, motion_type=2)
    m.run_until_rest(200_000)
    return m


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("module", MODULES)
def test_a_program_runs_through_within_the_joints_limits(module, seed):
    m = run(module, seed)
    assert m.errors() == []
    assert m.worst_vel <= 1.0 + ROUNDING
    assert m.worst_acc <= 1.0 + ROUNDING


@pytest.mark.parametrize("seed", [186, 285, 290])
def test_short_blends_keep_the_limits_of_belts(seed):
    m = run(corexykins, seed)
    assert m.errors() == []
    assert m.worst_acc <= 1.0 + ROUNDING


@pytest.mark.parametrize("module", MODULES)
def test_some_joint_is_used_fully(module):
    worst = max(max(m.worst_vel, m.worst_acc) for m in (run(module, seed) for seed in range(3)))
    assert worst > 0.93


@pytest.mark.parametrize("seed", range(3))
def test_a_hexapod_turns_its_platform_within_the_joints_limits(seed):
    m = run(genhexkins, seed, turn=0.3)
    assert m.errors() == []
    assert m.worst_vel <= 1.0 + ROUNDING
    assert m.worst_acc <= 1.0 + ROUNDING
