"""Nasty programs, with everything that an operator can do thrown in: no limit breaks, the path holds, the end is hit.

Helices and spirals between lines, arcs of all sizes, needles, tiny moves beside long ones, linear and rotary axes
mixed, another tolerance or path mode in the middle; run forwards and backwards, with and without jerk limits.
"""

import os

import numpy as np
import pytest

from emcmot.tp.planner import TERM_BLEND, TERM_STOP, TERM_TANGENT, Planner
from emcmot.tp.verifier import Arc, Line, verify

DT = 0.001
ROUNDING = 1 + 2e-6
SEEDS = int(os.environ.get("PYEMC_EXAMPLES", "6"))  # programs of each kind; hundreds find more
COMPARED = 300  # positions of a run that are compared with its path
MOVES = 14
COMMANDS = 25
AT_LAST = (("reverse", False), ("feed_scale", 1.0), ("resume",), ("feed_hold", False), ("vel_limit", 0.0))


class Nasty:
    """A random program in a planner with random limits."""

    def __init__(self, seed, jerk):
        self.random = np.random.default_rng(seed)
        self.planner = Planner(DT, 500)
        self.vmax, self.amax, self.jmax = np.full(9, 1e9), np.full(9, 1e9), np.full(9, 1e12)
        for axis in range(5):
            self.vmax[axis] = self.random.uniform(20, 150)
            self.amax[axis] = self.random.uniform(100, 2000)
            self.jmax[axis] = 10 ** self.random.uniform(3.3, 5.5) if jerk else 1e12
            self.planner.set_limits(axis, self.vmax[axis], self.amax[axis], self.jmax[axis])
        self.planner.limit_jerk(jerk)
        self.path, self.tolerance, self.at, self.parts = [], 0.0, np.zeros(9), []

    def coordinate(self):
        kinds = (self.random.uniform(-8, 8), float(self.random.integers(-4, 4)), 0.001 * self.random.integers(-3, 4))
        return kinds[self.random.integers(0, 3)]

    def move(self):
        """A line, or an arc, helix or spiral, with its own feed and path mode."""
        end = self.at.copy()
        kind = self.random.integers(0, 6)
        if kind == 0:
            end[:3] += 0.001 * self.random.integers(-2, 3, 3)
        elif kind == 1:
            end[1] += self.random.choice([-5.0, 5.0])
        else:
            end[:3] = [self.coordinate() for _ in range(3)]
        end[3:5] = self.random.choice([0.0, 0.0, 0.0, 5.0, -20.0], 2)
        tolerance = self.random.choice([0.002, 0.02, 0.2])
        feed = self.random.uniform(5, 120)
        options = {"tolerance": tolerance, "vel_max": 2 * feed, "id": len(self.path) + 1}
        options["term"] = int(self.random.choice([TERM_BLEND, TERM_BLEND, TERM_BLEND, TERM_STOP, TERM_TANGENT]))
        chord = float(np.hypot(*(end[:2] - self.at[:2])))
        if kind > 2 and chord > 1e-3:
            spiral = self.random.choice([0.0, 0.0, 0.1, -0.2]) * chord
            across = np.array([self.at[1] - end[1], end[0] - self.at[0]]) / chord
            middle = (self.at[:2] + end[:2]) / 2 + across * self.random.uniform(-1, 1) * chord
            center = np.array([*(middle + spiral * (end[:2] - self.at[:2]) / chord), self.at[2]])
            turn = int(self.random.integers(-2, 2))
            assert self.planner.add_arc(end, center, (0, 0, 1), turn, feed, **options)
            self.path.append(Arc(self.at, end, center, np.array([0.0, 0, 1]), turn))
        elif not np.array_equal(end, self.at):
            assert self.planner.add_line(end, feed, **options)
            self.path.append(Line(self.at, end))
        self.tolerance = max(self.tolerance, tolerance)
        self.at = end

    def command(self):
        choices = [
            ("feed_scale", self.random.choice([0.0, 0.1, 0.5, 1.0, 2.0])), ("pause",), ("resume",), ("step_once",),
            ("reverse", bool(self.random.integers(0, 2))), ("vel_limit", self.random.choice([3.0, 15.0, 200.0])),
            ("feed_hold", bool(self.random.integers(0, 2))), *AT_LAST[1:4],
        ]  # fmt: skip
        name, *arguments = choices[self.random.integers(0, len(choices))]
        getattr(self.planner, name)(*arguments)

    def run(self, commands):
        """Add the moves, some while the machine runs; then commands; then to the end."""
        for _ in range(MOVES):
            self.move()
            if self.random.random() < 0.3:
                self.parts.append(self.planner.step(int(self.random.integers(1, 150))))
        for _ in range(commands):
            self.parts.append(self.planner.step(int(self.random.integers(1, 150))))
            self.command()
        self.planner.pause()
        self.parts.append(self.planner.step(5000))
        for name, *arguments in AT_LAST:
            getattr(self.planner, name)(*arguments)
        self.parts.append(self.planner.run_to_end(300.0))
        return np.concatenate(self.parts)

    def check(self, positions):
        assert self.planner.status()["done"]
        stride = max(1, len(positions) // COMPARED)
        report = verify(positions, self.path, self.vmax, self.amax, DT, self.tolerance, stride, self.jmax)
        assert report.worst_velocity <= ROUNDING
        assert report.worst_acceleration <= ROUNDING
        assert report.worst_jerk <= ROUNDING
        assert report.deviation <= self.tolerance + 1e-6
        assert report.end <= 1e-9


@pytest.mark.parametrize("jerk", [False, True], ids=["acceleration", "jerk"])
@pytest.mark.parametrize("seed", range(SEEDS))
def test_a_nasty_program_runs_to_its_end_within_every_limit(seed, jerk):
    program = Nasty(seed, jerk)
    program.check(program.run(0))


@pytest.mark.parametrize("jerk", [False, True], ids=["acceleration", "jerk"])
@pytest.mark.parametrize("seed", range(100, 100 + SEEDS))
def test_whatever_the_operator_does_meanwhile_breaks_no_limit(seed, jerk):
    program = Nasty(seed, jerk)
    program.check(program.run(COMMANDS))
