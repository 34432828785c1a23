"""No joint is ever commanded beyond its velocity or acceleration limit, whatever is commanded and whenever."""

from __future__ import annotations

import random

import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import VEL, bring_to, configure

ROUNDING = 1e-6
JERK_ROUNDING = 1e-4


def _line(m: Motion, rng: random.Random) -> None:
    m.send(
        C.SET_LINE,
        id=rng.randrange(1, 1000),
        pos=[rng.uniform(-60, 60) for _ in range(3)] + [0.0] * 6,
        vel=rng.uniform(0.5, 150),
        ini_maxvel=VEL,
        acc=1000.0,
        termCond=rng.choice([1, 2, 3]),
        tolerance=rng.choice([0.0, 0.01, 1.0]),
        motion_type=rng.choice([1, 2]),
    )


def _lines(m: Motion, rng: random.Random) -> None:
    for _ in range(rng.randrange(1, 12)):
        _line(m, rng)


def _arc(m: Motion, rng: random.Random) -> None:
    x, y = m["axis.x.pos-cmd"], m["axis.y.pos-cmd"]
    m.send(
        C.SET_CIRCLE,
        id=rng.randrange(1, 1000),
        pos=(x, y, rng.uniform(-20, 20), 0, 0, 0, 0, 0, 0),
        center=(x + rng.uniform(-20, 20), y + rng.uniform(1, 20), 0),
        normal=(0, 0, 1),
        turn=rng.choice([-2, -1, 0, 1]),
        vel=rng.uniform(1, 150),
        ini_maxvel=VEL,
        acc=1000.0,
        termCond=2,
        motion_type=3,
    )


def _probe(m: Motion, rng: random.Random) -> None:
    pos = [rng.uniform(-60, 60) for _ in range(3)] + [0.0] * 6
    m.send(C.PROBE, id=1, pos=pos, vel=rng.uniform(1, 80), ini_maxvel=VEL, acc=1000.0, probe_type=rng.randrange(4))


def _eoffset(m: Motion, rng: random.Random) -> None:
    m["axis.z.eoffset-counts"] = rng.randrange(-500, 500)
    m["axis.z.eoffset-clear"] = rng.random() < 0.1


def _spindle(m: Motion, rng: random.Random) -> None:
    m.send(rng.choice([C.SPINDLE_ON, C.SPINDLE_OFF]), vel=rng.uniform(-500, 500), wait_for_spindle_at_speed=1)
    m["spindle.0.at-speed"] = rng.random() < 0.5


def _jog(m: Motion, rng: random.Random) -> None:
    index = rng.randrange(3)
    m.send(
        rng.choice([C.JOG_CONT, C.JOG_INCR, C.JOG_ABS]),
        joint=index,
        axis=index,
        mode=m.status.motion_state == 1,
        vel=rng.choice([-1, 1]) * rng.uniform(0.1, 200),
        offset=rng.uniform(-70, 70),
    )


def _wheel(m: Motion, rng: random.Random) -> None:
    index = rng.randrange(3)
    place = f"axis.{'xyz'[index]}" if m.status.motion_state == 2 else f"joint.{index}"
    m[f"{place}.jog-enable"] = 1
    m[f"{place}.jog-scale"] = rng.uniform(0.01, 2)
    m[f"{place}.jog-vel-mode"] = rng.random() < 0.5
    m[f"{place}.jog-accel-fraction"] = rng.uniform(0.1, 1.2)
    m[f"{place}.jog-counts"] += rng.randrange(-20, 20)


def _mode(m: Motion, rng: random.Random) -> None:
    m.send(rng.choice([C.FREE, C.TELEOP, C.COORD]))


def _switch(m: Motion, rng: random.Random) -> None:
    m.send(rng.choice([C.ENABLE, C.ENABLE, C.ENABLE, C.DISABLE]))


def _override(m: Motion, rng: random.Random) -> None:
    m.send(rng.choice([C.FEED_SCALE, C.RAPID_SCALE]), scale=rng.choice([0.0, 0.1, 0.5, 1.0, 1.0]))


def _program(m: Motion, rng: random.Random) -> None:
    m.send(rng.choice([C.PAUSE, C.RESUME, C.STEP, C.ABORT, C.RESUME]))


def _home(m: Motion, rng: random.Random) -> None:
    m.send(C.JOINT_HOME, joint=rng.randrange(-1, 3))


def _pin(m: Motion, rng: random.Random) -> None:
    name = rng.choice(["feed-hold", "feed-inhibit", "jog-stop", "jog-inhibit", "enable", "probe-input"])
    m[f"motion.{name}"] = rng.random() < (0.9 if name == "enable" else 0.3)


def _adaptive(m: Motion, rng: random.Random) -> None:
    m.send(C.AF_ENABLE, mode=rng.randrange(2))
    m["motion.adaptive-feed"] = rng.choice([-1.0, -0.2, 0.0, 0.5, 1.0, 1.0])


def _stop_jog(m: Motion, rng: random.Random) -> None:
    index = rng.randrange(3)
    m.send(C.JOG_ABORT, joint=index, axis=index, mode=rng.randrange(2))


ACTIONS = [
    *(_line, _lines, _arc, _probe, _jog, _jog, _wheel, _mode, _mode, _switch),
    *(_override, _program, _home, _pin, _stop_jog, _eoffset, _spindle, _adaptive),
]


def _random_machine(coordinates: str, rng: random.Random) -> Motion:
    """Homed, with a switch and an index to home by on joint 0, and external offsets on z."""
    m = bring_to(configure(Motion(coordinates)), "homed")
    m.place(0, 0.0, 4.0, 0.5)
    m.add_switch(0, "home", rng.uniform(20, 50), 60.0)
    m.send(
        C.SET_JOINT_HOMING_PARAMS,
        joint=0,
        home=rng.uniform(-20, 20),
        search_vel=rng.uniform(10, 80),
        latch_vel=rng.choice([-5.0, 5.0]),
        flags=rng.choice([0, 2]),
    )
    m.send(C.SET_AXIS_VEL_LIMIT, axis=2, vel=VEL / 2, ext_offset_vel=VEL / 2)
    m.send(C.SET_AXIS_ACC_LIMIT, axis=2, acc=500.0, ext_offset_acc=500.0)
    m["axis.z.eoffset-enable"] = 1
    m["axis.z.eoffset-scale"] = 0.02
    return m


@pytest.mark.parametrize("seed", range(60))
@pytest.mark.parametrize("coordinates", ["xyz", "xyyz"])
@pytest.mark.parametrize("jerk", [0.0, 2e4])
def test_random_commands_at_random_times_keep_every_limit(seed: int, coordinates: str, jerk: float) -> None:
    rng = random.Random(seed)
    m = _random_machine(coordinates, rng)
    m.send(C.SET_JERK, jerk=jerk)
    m.send(C.SET_PLANNER_TYPE, mode=jerk > 0.0)
    for _ in range(120):
        action = rng.choice(ACTIONS)
        action(m, rng)
        if rng.random() < 0.3:
            m.send(C.ENABLE)
        m.step(rng.choice([1, 2, 5, 30, 200]))
        m.errors()
        assert m.worst_vel <= 1.0 + ROUNDING, (seed, action)
        assert m.worst_acc <= 1.0 + ROUNDING, (seed, action)
        assert m.worst_jerk <= 1.0 + JERK_ROUNDING, (seed, action)


def _stop(m: Motion, rng: random.Random) -> bool:
    """Stop the machine in one of many ways; whether its spindles stop too."""
    way = rng.choice(["abort", "disable", "motion.enable", "joint.1.amp-fault-in", "spindle.0.amp-fault-in"])
    if way == "abort":
        m.send(C.ABORT)
        return False
    if way == "disable":
        m.send(C.DISABLE)
        return True
    m[way] = int(way != "motion.enable")
    m.step(2)
    m[way] = int(way == "motion.enable")
    return True


def _release(m: Motion, rng: random.Random) -> None:
    """Turn pins that motion may have waited for, in any order."""
    names = ["feed-hold", "feed-inhibit", "jog-stop", "jog-inhibit", "probe-input", "adaptive-feed", "at-speed"]
    name = rng.choice(names)
    place = "spindle.0" if name == "at-speed" else "motion"
    m[f"{place}.{name}"] = rng.choice([-1.0, 0.0, 1.0]) if name == "adaptive-feed" else rng.randrange(2)


@pytest.mark.parametrize("seed", range(60))
def test_what_an_abort_or_a_fault_has_stopped_stands_until_a_new_command(seed: int) -> None:
    rng = random.Random(f"stop {seed}")
    m = _random_machine("xyz", rng)
    for _ in range(30):
        rng.choice(ACTIONS)(m, rng)
        if rng.random() < 0.5:
            m.send(C.ENABLE)
        m.step(rng.choice([1, 5, 50, 300]))
    m["axis.z.eoffset-enable"] = 0
    for place in (*(f"joint.{n}" for n in range(3)), *(f"axis.{a}" for a in "xyz")):
        m[f"{place}.jog-enable"] = 0
    m.step(2000)
    spindles_stop = _stop(m, rng)
    m.run_until_rest()
    where = [m[f"joint.{n}.motor-pos-cmd"] for n in range(3)]
    speed = m["spindle.0.speed-out"]
    assert speed == 0.0 or not spindles_stop
    for _ in range(40):
        _release(m, rng)
        m.step(rng.choice([1, 20, 100]))
        assert [m[f"joint.{n}.motor-pos-cmd"] for n in range(3)] == where
        assert m["spindle.0.speed-out"] == speed
