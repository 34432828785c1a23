"""Moves led by a spindle that has inertia: threads, feed per revolution, rigid taps."""

from __future__ import annotations

import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import bring_to, configure, line, mill

DT = 0.001


class Spindle:
    """A spindle that follows its command with an acceleration, and an encoder whose index resets its count."""

    def __init__(self, m: Motion, rps_per_s: float = 40.0) -> None:
        self.m, self.acc = m, rps_per_s
        self.turns, self.speed, self.zero = 0.37, 0.0, 0.0

    def step(self) -> None:
        gap = self.m["spindle.0.speed-out-rps"] - self.speed
        self.speed += max(-self.acc * DT, min(self.acc * DT, gap))
        before = self.turns
        self.turns += self.speed * DT
        if self.m["spindle.0.index-enable"] and int(before // 1) != int(self.turns // 1):
            self.zero = float(max(before // 1, self.turns // 1))
            self.m["spindle.0.index-enable"] = 0
        self.m["spindle.0.revs"] = self.turns - self.zero
        self.m["spindle.0.speed-in"] = self.speed
        self.m["spindle.0.at-speed"] = abs(gap) < 0.01 * abs(self.m["spindle.0.speed-out-rps"]) + 1e-9
        self.m.step()

    def until_rest(self, periods: int = 60_000) -> None:
        for _ in range(periods):
            self.step()
            if self.m["motion.in-position"]:
                return
        raise AssertionError("motion did not come to rest")


def spinning(rpm: float) -> tuple[Motion, Spindle]:
    m = mill("coord")
    spindle = Spindle(m)
    m.send(C.SPINDLE_ON, vel=rpm, wait_for_spindle_at_speed=1)
    for _ in range(20):
        spindle.step()
    return m, spindle


def test_a_thread_begins_at_the_index_and_follows_the_spindle() -> None:
    m, spindle = spinning(600.0)
    m.send(C.SET_SPINDLESYNC, spindlesync=1.5)
    line(m, 0, 0, -30, vel=90.0)
    lags = []
    for _ in range(6000):
        spindle.step()
        z, revs = m["joint.2.pos-cmd"], m["spindle.0.revs"]
        if -28 < z < -3:
            lags.append((z / 1.5 + revs) * 360.0)
        if m["motion.in-position"]:
            break
    assert m["motion.in-position"]
    assert m["joint.2.pos-cmd"] == pytest.approx(-30.0)
    assert max(lags) - min(lags) < 0.5  # degrees
    assert 0.0 < lags[0] < 30.0  # what the start from rest has cost, the same in every pass
    assert m.worst_acc <= 1.0 + 1e-6


def test_threads_in_several_passes_meet_the_same_groove() -> None:
    phases = []
    for _ in range(3):
        m, spindle = spinning(600.0)
        spindle.turns += 0.3 * len(phases)
        m.send(C.SET_SPINDLESYNC, spindlesync=1.5)
        line(m, 0, 0, -30, vel=90.0)
        for _ in range(20_000):
            spindle.step()
            if m["joint.2.pos-cmd"] < -20:
                break
        phases.append((-m["joint.2.pos-cmd"] / 1.5 - spindle.turns) % 1.0)
    assert max(phases) - min(phases) == pytest.approx(0.0, abs=0.005)


def test_feed_per_revolution_follows_the_spindles_speed() -> None:
    m, spindle = spinning(600.0)
    m.send(C.SET_SPINDLESYNC, spindlesync=2.0, flags=1)
    line(m, 90, vel=90.0)
    for _ in range(1500):
        spindle.step()
    assert m["joint.0.vel-cmd"] == pytest.approx(20.0, rel=0.02)


def test_a_rigid_tap_goes_in_and_out_with_the_spindle_and_leaves_it_turning() -> None:
    m, spindle = spinning(600.0)
    m.send(C.SET_SPINDLESYNC, spindlesync=1.0)
    assert m.send(C.RIGID_TAP, id=5, pos=(0, 0, -12, 0, 0, 0, 0, 0, 0), vel=90.0, ini_maxvel=100.0, acc=1000.0) == 0
    lowest, at_bottom, lags = 0.0, False, []
    for _ in range(30_000):
        spindle.step()
        z = m["joint.2.pos-cmd"]
        lowest = min(lowest, z)
        at_bottom = at_bottom or m["spindle.0.reverse"]
        if -9 < z < -3 and m.status.depth:
            lags.append((z + m["spindle.0.revs"]) * 360.0)
        if m["motion.in-position"]:
            break
    assert m["motion.in-position"]
    assert at_bottom, "the spindle was turned back"
    assert -13.5 < lowest <= -12.0
    assert m["joint.2.pos-cmd"] == pytest.approx(0.0, abs=1e-6)
    assert max(lags) - min(lags) < 2 * 3.6 + 0.5  # degrees: one period of delay counts both ways
    assert m["spindle.0.forward"]
    assert m["spindle.0.speed-out"] == 600.0
    assert m.worst_acc <= 1.0 + 1e-6


def test_a_tap_without_a_synchronised_feed_is_refused() -> None:
    m = mill("coord")
    assert m.send(C.RIGID_TAP, id=5, pos=(0, 0, -12, 0, 0, 0, 0, 0, 0), vel=9.0, ini_maxvel=100.0) != 0
    assert m.errors() == ["Rigid tap on line 5: the feed is not synchronised with a spindle"]


def test_an_abort_while_waiting_for_the_index_takes_the_request_back() -> None:
    m = mill("coord")
    m.send(C.SPINDLE_ON, vel=600.0)
    m.send(C.SET_SPINDLESYNC, spindlesync=1.0)
    line(m, 0, 0, -10)
    m.step(50)
    assert m["spindle.0.index-enable"]
    m.send(C.ABORT)
    m.step(5)
    assert not m["spindle.0.index-enable"]
    assert m["motion.in-position"]


def test_the_program_line_of_the_running_move_is_shown() -> None:
    m = bring_to(configure(Motion("xyz")), "coord")
    line(m, 5, id=900, line=12)
    line(m, 9, id=901, line=14, termCond=1)
    seen = []
    while not m["motion.in-position"] or not seen:
        m.step()
        if m["motion.program-line"] not in seen:
            seen.append(m["motion.program-line"])
    assert seen == [12, 14, 0]
