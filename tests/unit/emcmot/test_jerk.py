"""Jerk limits and the planner type of LinuxCNC 2.10, as commands and in the commands that the joints get."""

from __future__ import annotations

import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import line, mill


def cut(m: Motion) -> float:
    """Round two corners; the largest jerk of a joint on the way."""
    worst = 0.0
    for n, point in enumerate([(30, 0), (30, 30), (0, 30)]):
        line(m, *point, id=n + 1, vel=50.0, tolerance=0.1)
    while not m["motion.in-position"] or worst == 0.0:
        m.step()
        worst = max(worst, *(abs(m[f"joint.{n}.jerk-cmd"]) for n in range(2)))
    return worst


def test_the_limits_are_kept_and_shown() -> None:
    m = mill("coord")
    m.send(C.SET_JERK, jerk=4e4)
    m.send(C.SET_JOINT_JERK_LIMIT, joint=1, jerk=3e4)
    m.send(C.SET_AXIS_JERK_LIMIT, axis=2, jerk=2e4)
    m.send(C.SET_PLANNER_TYPE, mode=1)
    m.step()
    s = m.status
    assert (s.jerk, s.joint_status[1].jerk_limit, s.axis_status[2].jerk_limit, s.planner_type) == (4e4, 3e4, 2e4, 1)


@pytest.mark.parametrize(
    ("command", "fields", "limit"),
    [
        (C.SET_JERK, {}, 2e4),
        (C.SET_AXIS_JERK_LIMIT, {"axis": 0}, 2e4),
        (C.SET_JOINT_JERK_LIMIT, {"joint": 0}, 2e4),
    ],
)
def test_planner_type_1_limits_the_jerk_of_the_joints(command: C, fields: dict[str, int], limit: float) -> None:
    m = mill("coord")
    m.send(C.SET_AXIS_JERK_LIMIT, axis=1, jerk=limit)
    m.send(command, jerk=limit, **fields)
    assert cut(m) > 10 * limit, "type 0 does not care"
    m.send(C.SET_PLANNER_TYPE, mode=1)
    m.step(2)
    line(m, 0, 0, id=9)
    m.run_until_rest()
    assert cut(m) <= limit * (1 + 1e-3)
    assert m.worst_acc <= 1.0 + 1e-6


@pytest.mark.parametrize("planner", [-1, 2, 7])
def test_another_planner_type_is_refused(planner: int) -> None:
    m = mill("coord")
    assert m.send(C.SET_PLANNER_TYPE, mode=planner) != 0
    assert m.errors() == [f"Motion command {int(C.SET_PLANNER_TYPE)} refused: {planner} is not 0 or 1"]
    assert m.status.planner_type == 0


def test_a_negative_jerk_is_refused() -> None:
    m = mill("coord")
    assert m.send(C.SET_JOINT_JERK_LIMIT, joint=0, jerk=-1.0) != 0
    assert "is not a number that is not negative" in m.errors()[0]


def test_an_output_changes_where_its_short_move_begins() -> None:
    m = mill("coord")
    m.send(C.SET_JERK, jerk=4e4)
    m.send(C.SET_PLANNER_TYPE, mode=1)
    m.step(2)
    for n in range(1, 601):
        if n == 300:
            m.send(C.SET_DOUT, now=0, out=0, start=1)
        line(m, 0.05 * n, 10 - 0.0005 * (300 - n) ** 2 / 9, id=n, vel=50.0, tolerance=0.02)
    while not m["motion.digital-out-00"]:
        m.step()
    assert m["axis.x.pos-cmd"] == pytest.approx(0.05 * 299, abs=0.07)
