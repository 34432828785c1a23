"""Random programs for the planner, with everything that an operator, a spindle or another task can do meanwhile.

A program is a chain of passages: single moves of all sorts, needles, dense curves with rounded coordinates as CAM
writes them, pockets of lines and arcs, moves that follow a spindle. Feeds are per minute, inverse time or per
revolution. While it runs, overrides, holds, pauses, steps, aborts and turns come at any instant. The independent
verifier judges the run.
"""

import math

import numpy as np

from emcmot.tp.planner import FEED, TERM_BLEND, TERM_STOP, TERM_TANGENT, TRAVERSE, Planner
from emcmot.tp.verifier import Arc, Line, verify

DT = 0.001
ROUNDING = 1 + 2e-6
COMPARED = 300  # positions of a run that are compared with its path
AXES_USED = 5
STANDING = 70  # periods without motion that are rest
STANDING_PERIODS = 70_000  # in which whatever was asked for must have come to rest
COMMANDS_AT_LAST = (
    ("feed_scale", 1.0),
    ("rapid_scale", 1.0),
    ("adaptive_scale", 1.0),
    ("vel_limit", 0.0),
    ("feed_hold", False),
    ("feed_inhibit", False),
    ("at_speed", 1),
    ("resume",),
)


class Spindle:
    """Speeds up and slows down as it likes, within its own acceleration."""

    def __init__(self, planner, random):
        self.planner, self.random = planner, random
        self.revs, self.rps, self.wanted = 0.0, 5.0, 5.0

    def period(self):
        """Turn for one servo period, tell the planner, and step it."""
        if self.random.random() < 0.005:
            self.wanted = self.random.choice([0.5, 3.0, 10.0, 25.0])
        self.rps += float(np.clip(self.wanted - self.rps, -0.05, 0.05))
        self.revs += self.rps * DT
        if self.planner.status()["wants_index"] >= 0 and self.revs % 1.0 < self.rps * DT:
            self.revs = math.fmod(self.revs, 1.0)
            self.planner.index_seen()
        self.planner.spindle(0, self.revs, self.rps)
        return self.planner.step()


class Nasty:
    """A random program in a planner with random limits, kept beside its ideal path."""

    def __init__(self, seed, jerk):
        self.random = np.random.default_rng(seed)
        self.planner = Planner(DT, 500)
        self.vmax, self.amax, self.jmax = np.full(9, 1e9), np.full(9, 1e9), np.full(9, 1e12)
        for axis in range(AXES_USED):
            self.vmax[axis] = self.random.uniform(20, 150)
            self.amax[axis] = self.random.uniform(100, 2000)
            self.jmax[axis] = 10 ** self.random.uniform(3.3, 5.5) if jerk else 1e12
            self.planner.set_limits(axis, self.vmax[axis], self.amax[axis], self.jmax[axis])
        self.planner.limit_jerk(jerk)
        self.spindle, self.path, self.tolerance, self.at, self.parts = None, [], 0.0, np.zeros(9), []

    # --- moves

    def choose(self, *values):
        return values[self.random.integers(0, len(values))]

    def coordinate(self):
        kinds = (self.random.uniform(-8, 8), float(self.random.integers(-4, 4)), 0.001 * self.random.integers(-3, 4))
        return kinds[self.random.integers(0, 3)]

    def options(self):
        """Feed, path mode, and what acts on a move."""
        self.feed = self.random.uniform(5, 120)
        return {
            "tolerance": self.choose(0.002, 0.02, 0.2),
            "vel_max": 2 * self.feed,
            "acc": self.choose(0.0, 0.0, 0.0, self.random.uniform(50, 500)),
            "term": self.choose(TERM_BLEND, TERM_BLEND, TERM_BLEND, TERM_STOP, TERM_TANGENT),
            "motion_type": self.choose(FEED, FEED, FEED, TRAVERSE),
            "enables": self.choose(2 | 4 | 8, 2 | 4 | 8, 2, 8, 0),
        }

    def line(self, end, feed, **options):
        """A straight move, when there is room for it."""
        if np.linalg.norm(end - self.at) > 1e-9 and self.planner.add_line(end, feed, id=len(self.path) + 1, **options):
            self.path.append(Line(self.at, end))
            self.tolerance = max(self.tolerance, options["tolerance"])
            self.at = end

    def arc(self, end, center, turn, feed, **options):
        options.pop("motion_type")
        if self.planner.add_arc(end, center, (0, 0, 1), turn, feed, id=len(self.path) + 1, **options):
            self.path.append(Arc(self.at, end, np.array(center), np.array([0.0, 0, 1]), turn))
            self.tolerance = max(self.tolerance, options["tolerance"])
            self.at = end

    def move(self):
        """A line, or an arc, helix or spiral, tiny or long, of linear and rotary axes."""
        options, end, kind = self.options(), self.at.copy(), self.random.integers(0, 6)
        if kind == 0:
            end[:3] += 0.001 * self.random.integers(-2, 3, 3)
        elif kind == 1:
            end[1] += self.random.choice([-5.0, 5.0])
        else:
            end[:3] = [self.coordinate() for _ in range(3)]
        end[3:5] = self.random.choice([0.0, 0.0, 0.0, 5.0, -20.0], 2)
        chord = float(np.hypot(*(end[:2] - self.at[:2])))
        if kind > 2 and chord > 1e-3:
            spiral = self.random.choice([0.0, 0.0, 0.1, -0.2]) * chord
            across = np.array([self.at[1] - end[1], end[0] - self.at[0]]) / chord
            middle = (self.at[:2] + end[:2]) / 2 + across * self.random.uniform(-1, 1) * chord
            center = np.array([*(middle + spiral * (end[:2] - self.at[:2]) / chord), self.at[2]])
            self.arc(end, center, int(self.random.integers(-2, 2)), self.feed, **options)
        else:
            self.line(end, self.feed, **options)

    def curve(self):
        """Short moves along a curve, rounded; per minute, or in inverse time: then each has its own feed."""
        options, inverse, digits = self.options(), self.random.random() < 0.4, self.choose(3, 4, 9)
        options["term"], start = TERM_BLEND, self.at.copy()
        step, size, turns = self.choose(0.005, 0.02, 0.1, 0.5), self.random.uniform(0.2, 5), self.random.uniform(1, 9)
        tilt = self.choose(0.0, 0.0, self.random.uniform(-20, 20))
        dripping = self.random.random() < 0.3
        for k in range(1, self.choose(20, 60, 60, 300)):
            if dripping and self.random.random() < 0.1:
                self.step(int(self.random.integers(1, 20)))
            t = k * step / size
            end = start.copy()
            end[:3] += size * np.array([np.sin(t), 1 - np.cos(t), 0.2 * np.sin(turns * t)])
            end[3] += tilt * t
            feed = self.feed * (self.random.uniform(0.5, 2.0) if inverse else 1.0)
            self.line(np.round(end, digits), feed, **options | {"vel_max": 2 * feed})

    def needles(self):
        """There and back along nearly the same line."""
        options, across = self.options(), self.choose(0.0, 0.001, 0.3)
        for k in range(int(self.random.integers(2, 9))):
            end = self.at.copy()
            end[0] += across
            end[1] += self.random.uniform(0.01, 6.0) * (-1) ** k
            self.line(end, self.feed, **options)

    def pocket(self):
        """A rectangle with rounded corners."""
        options, r = self.options() | {"term": TERM_BLEND}, self.random.uniform(0.05, 2.0)
        side, sense = self.random.uniform(0.1, 6.0), self.choose(1, -1)
        along = np.array([1.0, 0.0])
        for _ in range(4):
            across = sense * np.array([-along[1], along[0]])
            end, center = self.at.copy(), self.at.copy()
            end[:2] += side * along
            self.line(end, self.feed, **options)
            end, center = self.at.copy(), self.at.copy()
            center[:2] += r * across
            end[:2] += r * (across + along)
            self.arc(end, center[:3], 0 if sense > 0 else -1, self.feed, **options)
            along = across

    def turned(self):
        """Moves led by the spindle: feed per revolution, or a thread."""
        self.spindle = self.spindle or Spindle(self.planner, self.random)
        options, velocity = self.options() | {"motion_type": FEED}, self.random.random() < 0.6
        pitch = self.random.uniform(0.05, 2.0)
        for k in range(int(self.random.integers(1, 5))):
            end = self.at + np.array([0.1 * self.coordinate(), 0.0, self.random.uniform(-4, 4), 0, 0, 0, 0, 0, 0])
            wait = int(k == 0 and self.random.random() < 0.3)
            led = {"spindle": 0, "sync_revs": pitch, "sync_velocity": velocity, "wait_spindles": wait}
            self.line(end, self.feed, **options, **led)

    # --- running

    def step(self, periods):
        """Run servo periods; their positions."""
        if self.spindle is None:
            self.parts.append(self.planner.step(periods))
        else:
            self.parts.append(np.concatenate([self.spindle.period() for _ in range(periods)]))
        return self.parts[-1]

    def run_until_done(self, periods):
        for _ in range(0, periods, STANDING):
            if self.planner.status()["done"]:
                return
            self.step(STANDING)

    def come_to_rest(self):
        """Pause, and wait until the machine stands: a thread first goes on to its end."""
        self.planner.pause()
        self.planner.at_speed(1)
        for _ in range(0, STANDING_PERIODS, STANDING):
            if not np.ptp(self.step(STANDING), axis=0).any() and self.planner.status()["wants_index"] < 0:
                return
        raise AssertionError("does not come to rest")

    def abort(self):
        """Drop what is queued, somewhere on the path; the program goes on from there."""
        self.planner.abort()
        self.run_until_done(STANDING_PERIODS)
        assert self.planner.status()["done"]
        self.at = np.array(self.planner.status()["pos"])

    def command(self):
        commands = [
            ("feed_scale", self.random.choice([0.0, 0.1, 0.5, 1.0, 2.0])), ("rapid_scale", self.random.uniform(0, 1)),
            ("adaptive_scale", self.random.uniform(0, 1)), ("vel_limit", self.random.choice([3.0, 15.0, 200.0])),
            ("feed_hold", bool(self.random.integers(0, 2))), ("feed_inhibit", bool(self.random.integers(0, 2))),
            ("pause",), ("resume",), ("step_once",), ("reverse", bool(self.random.integers(0, 2))), *COMMANDS_AT_LAST,
        ]  # fmt: skip
        if self.random.random() < 0.04:
            self.abort()
            return
        name, *arguments = self.choose(*commands)
        getattr(self.planner, name)(*arguments)

    def run(self, passages, commands):
        """Add passages, some while the machine runs; commands meanwhile and afterwards; then to the end."""
        kinds = (self.move, self.move, self.move, self.move, self.curve, self.needles, self.pocket)
        kinds += (self.turned,) * (self.random.random() < 0.3)
        for _ in range(passages):
            self.choose(*kinds)()
            if self.random.random() < 0.3:
                self.step(int(self.random.integers(1, 150)))
                if commands and self.random.random() < 0.5:
                    self.command()
        for _ in range(commands):
            self.step(int(self.random.integers(1, 150)))
            self.command()
        self.come_to_rest()
        assert self.planner.reverse(False)
        for name, *arguments in COMMANDS_AT_LAST:
            getattr(self.planner, name)(*arguments)
        self.run_until_done(6 * STANDING_PERIODS)
        return np.concatenate(self.parts)

    def check(self, positions):
        assert self.planner.status()["done"]
        stride = max(1, len(positions) // COMPARED)
        report = verify(positions, self.path, self.vmax, self.amax, DT, self.tolerance, stride, self.jmax)
        assert report.worst_velocity <= ROUNDING
        assert report.worst_acceleration <= ROUNDING
        assert report.worst_jerk <= ROUNDING
        assert report.deviation <= self.tolerance + 1e-6
        assert np.linalg.norm(positions[-1] - self.at) <= 1e-9
