"""A program for the planner, kept beside its ideal path so that the independent verifier can judge the result."""

import numpy as np

from emcmot.tp.planner import Planner
from emcmot.tp.verifier import Arc, Line, verify

DT = 0.001
VMAX = np.array([100.0, 90, 80, 60, 60, 60, 50, 50, 50])
AMAX = np.array([500.0, 700, 400, 300, 300, 300, 250, 250, 250])
ROUNDING = 1 + 1e-6


def come_to_rest(planner):
    """Pause, and run until the machine stands; the positions."""
    planner.pause()
    parts = [planner.step()]
    while planner.status()["current_vel"] > 0.0:
        parts.append(planner.step())
    return np.concatenate(parts)


class Program:
    """Moves as given to a planner and as ideal curves."""

    def __init__(self, start=(0, 0, 0), dt=DT, **defaults):
        self.planner = Planner(dt, 2000)
        self.dt = dt
        for axis in range(9):
            self.planner.set_limits(axis, VMAX[axis], AMAX[axis])
        self.at = np.zeros(9)
        self.at[: len(start)] = start
        self.planner.set_pos(self.at)
        self.path = []
        self.defaults = defaults

    def line(self, *end, **options):
        end = np.concatenate([end, self.at[len(end) :]])
        options = self.defaults | options
        vel = options.pop("vel", 60.0)
        assert self.planner.add_line(end, vel, id=len(self.path) + 1, **options)
        self.path.append(Line(self.at, end))
        self.at = end
        return self

    def arc(self, end, center, normal=(0, 0, 1), turn=0, **options):
        end = np.concatenate([end, self.at[len(end) :]])
        options = self.defaults | options
        vel = options.pop("vel", 60.0)
        assert self.planner.add_arc(end, center, normal, turn, vel, id=len(self.path) + 1, **options)
        self.path.append(Arc(self.at, end, np.array(center, float), np.array(normal, float), turn))
        self.at = end
        return self

    def run(self):
        return self.planner.run_to_end()

    def check(self, positions, tolerance, stride=1):
        """Limits, tolerance and end point; the report for what else a test wants to know."""
        report = verify(positions, self.path, VMAX, AMAX, self.dt, tolerance, stride)
        assert report.worst_velocity <= ROUNDING
        assert report.worst_acceleration <= ROUNDING
        assert report.deviation <= tolerance + 1e-7
        assert report.corner <= tolerance + AMAX.max() * self.dt**2
        assert report.end == 0.0
        return report
