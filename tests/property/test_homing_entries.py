"""Machines whose HOME_* entries, switches, encoders and starting places are drawn at random are homed, or say why not.

Whatever is drawn: no joint breaks a limit, what is homed stands at its HOME with the reference where the machine has
it, what failed names joint, state and reason and keeps the joints of later numbers where they are, and nothing is left
half done: no index armed, no state but idle.
"""

from __future__ import annotations

import random
from dataclasses import dataclass

import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import bring_to, configure

JOINTS, RUNS, PATIENCE = 3, 25, 4000  # patience: looks of LOOK periods each
LOOK = 50
DT, JERK, ROUNDING = 0.001, 2e4, 1e-5
IGNORE_LIMITS, USE_INDEX, SHARED, UNLOCK_FIRST, ABSOLUTE, NO_REHOME, NO_FINAL_MOVE, NO_RESET = (
    1 << bit for bit in range(8)
)


@dataclass
class Drawn:
    """A joint as it was drawn; lengths in lu, speeds in lu/s."""

    number: int
    search: float
    latch: float
    flags: int
    sequence: int
    offset: float
    home: float
    final: float
    edge: float
    pitch: float
    index_at: float
    start: float
    has_switch: bool

    @property
    def is_limit(self) -> bool:
        """Whether the home switch is the limit switch as well."""
        return bool(self.search and self.flags & IGNORE_LIMITS)

    @property
    def immediate(self) -> bool:
        return self.search == 0.0 and not self.flags & (USE_INDEX | ABSOLUTE)


def draw(rng: random.Random, number: int) -> Drawn:
    """Any entries that fit each other, and sometimes a machine whose switch is missing."""
    kind = rng.choice(["switch", "switch", "switch and index", "index", "immediate", "absolute"])
    direction = rng.choice([-1, 1])
    flags = USE_INDEX if "index" in kind else ABSOLUTE | NO_REHOME if kind == "absolute" else 0
    for flag in (IGNORE_LIMITS, NO_FINAL_MOVE, UNLOCK_FIRST if number == 2 else 0):
        flags |= flag if rng.random() < 0.3 else 0
    flags |= NO_RESET if kind == "index" and rng.random() < 0.4 else 0
    flags |= SHARED if "switch" in kind and rng.random() < 0.3 else 0
    searches = "switch" in kind
    if searches and flags & IGNORE_LIMITS:  # the final move leaves the limit switch
        flags &= ~NO_FINAL_MOVE
    offset = rng.uniform(-20, 20)
    way = -direction * rng.uniform(8, 30) if searches else rng.uniform(-30, 30)
    return Drawn(
        number=number,
        search=direction * rng.uniform(5, 120) if searches else 0.0,
        latch=rng.choice([-1, 1]) * rng.uniform(0.5, 5) if searches or kind == "index" else 0.0,
        flags=flags,
        sequence=rng.choice([0, 0, 1, 1, -1, 2]),
        offset=offset,
        home=offset + way,
        final=rng.choice([-1.0, 0.0, 10.0, 80.0]),
        edge=direction * rng.uniform(60, 80),
        pitch=rng.uniform(1.0, 6.0) if "index" in kind else 0.0,
        index_at=rng.uniform(-3, 3),
        start=rng.uniform(-55, 55),
        has_switch=rng.random() < 0.9,
    )


def machine(joints: list[Drawn], smooth: bool) -> Motion:
    m = configure(Motion("xyz", unlock_joints_mask=4))
    if smooth:
        m.send(C.SET_JERK, jerk=JERK)
        m.send(C.SET_PLANNER_TYPE, mode=1)
    bring_to(m, "free")
    for joint in joints:
        m.place(joint.number, joint.start, joint.pitch, joint.index_at)
        if joint.search and joint.has_switch:
            limit = "+pos" if joint.search > 0.0 else "+neg"
            end = joint.edge + (60.0 if joint.search > 0.0 else -60.0)
            wired = "home" + limit * joint.is_limit
            m.add_switch(joint.number, wired, min(joint.edge, end), max(joint.edge, end))
        m.send(
            C.SET_JOINT_HOMING_PARAMS,
            joint=joint.number,
            search_vel=joint.search,
            latch_vel=joint.latch,
            flags=joint.flags,
            home_sequence=joint.sequence,
            offset=joint.offset,
            home=joint.home,
            home_final_vel=joint.final,
        )
    return m


def step(m: Motion) -> None:
    """A while, with a lock that follows."""
    m.step(LOOK)
    m["joint.2.is-unlocked"] = m["joint.2.unlock"]


def run_to_the_end(m: Motion) -> None:
    for _ in range(PATIENCE):
        step(m)
        if m["motion.in-position"]:
            return
    raise AssertionError([m[f"joint.{n}.home-state"] for n in range(JOINTS)])


def keeps_its_limits(m: Motion) -> bool:
    return max(m.worst_vel, m.worst_acc, m.worst_jerk) <= 1.0 + ROUNDING


def stands_right(m: Motion, joint: Drawn) -> bool:
    """Whether a homed joint stands at its HOME, and HOME_OFFSET is at its reference."""
    n = joint.number
    place = f"joint.{n}.pos-cmd"
    if not joint.flags & NO_FINAL_MOVE and m[place] != joint.home:
        return False
    reference = m.true_position(n) - (m[place] - joint.offset)
    if joint.flags & ABSOLUTE:
        return bool(m[place] == pytest.approx(m[f"joint.{n}.motor-pos-cmd"] + joint.offset, abs=1e-9))
    if joint.immediate:
        return bool(reference == pytest.approx(joint.start, abs=1e-9))
    if joint.flags & USE_INDEX:
        turns = (reference - joint.index_at) / joint.pitch
        missed = abs(turns - round(turns)) * joint.pitch
        return missed <= (2 * abs(joint.latch) * DT if joint.flags & NO_RESET else 1e-9)
    return abs(reference - joint.edge) <= 2 * abs(joint.latch) * DT + 1e-9


def nothing_is_left(m: Motion) -> bool:
    idle = all(m[f"joint.{n}.home-state"] == 0 and not m[f"joint.{n}.homing"] for n in range(JOINTS))
    return idle and not any(m[f"joint.{n}.index-enable"] for n in range(JOINTS))


def check_the_end(m: Motion, joints: list[Drawn], errors: list[str]) -> None:
    homed = {joint.number: m[f"joint.{joint.number}.homed"] for joint in joints}
    assert nothing_is_left(m)
    assert keeps_its_limits(m)
    assert all(stands_right(m, joint) for joint in joints if homed[joint.number])
    failed = [joint for joint in joints if joint.search and not joint.has_switch]
    steps = sorted({abs(joint.sequence) for joint in joints})
    stops = [n for n, step in enumerate(steps) if any(abs(joint.sequence) == step for joint in failed)]
    reached = steps[: stops[0] + 1 if stops else len(steps)]
    gap = next((s for s in range(1, 3) if s not in steps), 3)
    for joint in joints:
        alone = abs(joint.sequence) in reached and abs(joint.sequence) < gap
        if homed[joint.number]:
            assert alone
            assert joint not in failed
        elif not failed:
            assert not alone
    # whose homing is ended on the switch that is its limit as well stands on a limit
    left = {f"joint {joint.number} on limit switch error" for joint in joints if joint.is_limit and failed}
    complaints = [text for text in errors if "not homed with the others" not in text and text not in left]
    named = [joint for joint in failed if abs(joint.sequence) == reached[-1] and abs(joint.sequence) < gap]
    assert bool(complaints) == bool(named), errors
    assert all(text.startswith("Homing of joint ") and " failed in state " in text for text in complaints)


@pytest.mark.parametrize("seed", range(30))
def test_home_all_homes_what_can_be_homed_and_says_what_can_not(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(RUNS):
        joints = [draw(rng, number) for number in range(JOINTS)]
        m = machine(joints, smooth=rng.random() < 0.5)
        m.send(C.JOINT_HOME, joint=-1)
        run_to_the_end(m)
        check_the_end(m, joints, m.errors())


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("blow", [C.ABORT, C.DISABLE, C.JOINT_UNHOME])
def test_homing_that_is_ended_anywhere_leaves_nothing_behind(seed: int, blow: C) -> None:
    rng = random.Random(f"{seed} {blow}")
    for _ in range(RUNS):
        joints = [draw(rng, number) for number in range(JOINTS)]
        m = machine(joints, smooth=rng.random() < 0.5)
        m.send(C.JOINT_HOME, joint=rng.choice([-1, 0, 1, 2]))
        for _ in range(rng.randrange(1, 150)):
            step(m)
        m.step(rng.randrange(LOOK))
        before = {n: m[f"joint.{n}.homed"] for n in range(JOINTS)}
        was_homing = {n: m[f"joint.{n}.homing"] for n in range(JOINTS)}
        m.send(blow, joint=-1)
        run_to_the_end(m)
        assert nothing_is_left(m)
        assert keeps_its_limits(m)
        if blow != C.JOINT_UNHOME:
            assert all(m[f"joint.{n}.homed"] == (before[n] and not was_homing[n]) for n in range(JOINTS))
