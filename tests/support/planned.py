"""Programs for the planner, kept beside their ideal paths so that the independent verifier can judge the result."""

import numpy as np

from emcmot.tp.planner import Planner
from emcmot.tp.verifier import Arc, Line, verify

DT = 0.001
VMAX = np.array([100.0, 90, 80, 60, 60, 60, 50, 50, 50])
AMAX = np.array([500.0, 700, 400, 300, 300, 300, 250, 250, 250])
ROUNDING = 1 + 1e-6
COMPARED = 400  # positions of a job that are compared with its path


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
        self.planner = Planner(dt)
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


class Job:
    """Moves given to a planner with limits, and the path that they stand for."""

    def __init__(self, limits, tolerance, feed, jerk=False):
        self.planner, self.limits, self.tolerance, self.feed = Planner(DT, 500), limits, tolerance, feed
        self.jerk = jerk
        for axis, values in enumerate(limits):
            self.planner.set_limits(axis, *values)
        self.planner.limit_jerk(jerk)
        self.path, self.at = [], np.zeros(9)

    def add(self, end, turn):
        """A line; where `turn` is given, half a turn of an arc about the middle of the chord."""
        end9 = np.zeros(9)
        end9[: len(end)] = end
        options = {"tolerance": self.tolerance, "vel_max": self.feed * 2, "id": len(self.path) + 1}
        if turn is None or np.hypot(*(end9[:2] - self.at[:2])) < 1e-3:
            assert self.planner.add_line(end9, self.feed, **options)
            if not np.array_equal(self.at, end9):
                self.path.append(Line(self.at, end9))
        else:
            center = np.array([*(self.at[:2] + end9[:2]) / 2, self.at[2]])
            assert self.planner.add_arc(end9, center, (0, 0, 1), turn, self.feed, **options)
            self.path.append(Arc(self.at, end9, center, np.array([0.0, 0, 1]), turn))
        self.at = end9

    def check(self, positions):
        """At rest, within every limit and the tolerance."""
        assert self.planner.status()["done"]
        if not self.path:
            return
        rows = [*self.limits, *[(1.0,) * len(self.limits[0])] * (9 - len(self.limits))]
        vmax, amax, *jmax = (np.array(column) for column in zip(*rows, strict=True))
        stride = max(1, len(positions) // COMPARED)
        report = verify(positions, self.path, vmax, amax, DT, self.tolerance, stride, jmax[0] if self.jerk else None)
        assert report.worst_velocity <= ROUNDING
        assert report.worst_acceleration <= ROUNDING
        assert report.worst_jerk <= ROUNDING
        assert report.deviation <= self.tolerance + 1e-6

    def check_to_the_end(self, positions):
        self.check(positions)
        assert np.array_equal(self.planner.status()["pos"], self.at)
