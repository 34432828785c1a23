"""Moves that follow a spindle: threads meet in one groove, feed per revolution follows its speed."""

import math

import numpy as np
import pytest

from emcmot.tp.planner import Planner

DT = 0.001


class Lathe:
    """A planner with z moves and a spindle that turns with a given speed law."""

    def __init__(self, rps, jerk=0.0):
        self.planner = Planner(DT, 50)
        self.planner.limit_jerk(jerk > 0.0)
        for axis in range(3):
            self.planner.set_limits(axis, 100.0, 500.0, jerk)
        self.rps, self.revs, self.time = rps, 0.0, 0.0

    def period(self):
        """One servo period; z, and revolutions since the index pulse."""
        self.time += DT
        speed = self.rps(self.time)
        self.revs += speed * DT
        if self.planner.status()["wants_index"] >= 0 and abs(self.revs) % 1.0 < abs(speed) * DT:
            self.revs = math.fmod(self.revs, 1.0)
            self.planner.index_seen()
        self.planner.spindle(0, self.revs, speed)
        return self.planner.step(1)[0][2], self.revs

    def until_done(self, limit=20000):
        out = []
        while not self.planner.status()["done"] and len(out) < limit:
            out.append(self.period())
        return np.array(out)

    def thread(self, *ends, pitch=1.5):
        for end in ends:
            self.planner.add_line((0, 0, end), 100.0, spindle=0, sync_revs=pitch, tolerance=0.01)


@pytest.mark.parametrize(
    "rps",
    [lambda t: 10.0, lambda t: 10.0 + np.sin(8 * t), lambda t: 8.0 + 2 * min(1.0, t / 3)],
    ids=["even", "swaying", "rising"],
)
def test_a_thread_keeps_its_pitch_however_the_spindle_turns(rps):
    lathe = Lathe(rps)
    lathe.thread(-30.0)
    z, revs = lathe.until_done().T
    cutting = (z < -3.0) & (z > -28.0)
    error = -z[cutting] - 1.5 * revs[cutting]
    assert np.ptp(error) < 0.005


@pytest.mark.parametrize("jerk", [50000.0, 5000.0])
@pytest.mark.parametrize("rps", [lambda t: 10.0, lambda t: 8.0 + 2 * min(1.0, t / 3)], ids=["even", "rising"])
def test_a_thread_keeps_its_pitch_where_jerk_is_limited(rps, jerk):
    lathe = Lathe(rps, jerk)
    lathe.thread(-30.0)
    z, revs = lathe.until_done().T
    cutting = (z < -3.0) & (z > -28.0)
    assert np.ptp(-z[cutting] - 1.5 * revs[cutting]) < 0.03
    assert np.abs(np.diff(z, 3)).max() <= jerk * DT**3 * (1 + 1e-6)


def test_passes_that_begin_at_different_times_meet_in_one_groove():
    phases = []
    for delay in (0, 137, 411):
        lathe = Lathe(lambda t: 10.0)
        for _ in range(delay):
            lathe.period()
        lathe.thread(-20.0)
        z, revs = lathe.until_done().T
        k = int(np.argmax(z < -10.0))
        phases.append(-z[k] - 1.5 * revs[k])
    assert np.ptp(phases) < 0.02


def test_a_chain_of_synchronised_moves_does_not_wait_between_them():
    lathe = Lathe(lambda t: 10.0)
    lathe.thread(-10.0, -20.0, -30.0)
    z, _ = lathe.until_done().T
    speed = -np.diff(z) / DT
    inside = (z[:-1] < -3) & (z[:-1] > -28)
    assert speed[inside].min() > 14.5


def test_a_pause_waits_for_the_end_of_the_thread():
    lathe = Lathe(lambda t: 10.0)
    lathe.thread(-20.0)
    lathe.planner.add_line((0, 0, 0), 50.0)
    while lathe.period()[0] > -10.0:
        pass
    lathe.planner.pause()
    for _ in range(3000):
        z, _ = lathe.period()
    assert z == pytest.approx(-20.0, abs=0.05)
    lathe.planner.resume()
    assert lathe.until_done()[-1][0] == 0.0


def test_feed_per_revolution_follows_the_spindle_and_the_override():
    lathe = Lathe(lambda t: 5.0 if t < 1.0 else 10.0)
    lathe.planner.add_line((0, 0, -60.0), 100.0, spindle=0, sync_revs=1.0, sync_velocity=True)
    z, _ = np.array([lathe.period() for _ in range(2000)]).T
    speed = -np.diff(z) / DT
    assert speed[900] == pytest.approx(5.0)
    assert speed[1900] == pytest.approx(10.0)
    lathe.planner.feed_scale(0.5)
    z, _ = np.array([lathe.period() for _ in range(200)]).T
    assert -np.diff(z)[-1] / DT == pytest.approx(5.0)


def test_a_move_waits_until_its_spindles_are_at_speed():
    lathe = Lathe(lambda t: 10.0)
    lathe.planner.add_line((0, 0, -5), 20.0, tolerance=0.1)
    lathe.planner.add_line((0, 0, -10), 20.0, wait_spindles=1)
    for _ in range(1000):
        z, _ = lathe.period()
    assert z == -5.0
    lathe.planner.at_speed(1)
    assert lathe.until_done()[-1][0] == -10.0


class ReversingSpindle(Lathe):
    """Turns the way the planner wants, with a motor of limited acceleration."""

    def __init__(self, rps, rps_per_s):
        super().__init__(lambda t: self.speed)
        self.speed, self.wanted, self.rate = rps, rps, rps_per_s

    def period(self):
        status = self.planner.status()
        wanted = self.wanted * (-status["retract_scale"] if status["wants_reverse"] == 0 else 1.0)
        self.speed += np.clip(wanted - self.speed, -self.rate * DT, self.rate * DT)
        return super().period()


@pytest.mark.parametrize("retract_scale", [1.0, 2.0])
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_rigid_tap_follows_the_reversing_spindle_in_and_out(direction, retract_scale):
    lathe = ReversingSpindle(5.0 * direction, 50.0)
    lathe.planner.add_tap((0, 0, -10), 100.0, 1.25, retract_scale=retract_scale)
    lathe.planner.add_line((5, 0, 0), 50.0)
    positions = []
    while not lathe.planner.status()["done"]:
        z, revs = lathe.period()
        positions.append((z, revs * direction))
        assert len(positions) < 20000
    z, revs = np.array(positions).T
    assert -11.5 < z.min() < -10.0
    inside = z < -0.5
    assert np.ptp(-z[inside] - 1.25 * revs[inside]) < 0.05
    acceleration = np.diff(z, 2) / DT**2
    assert np.abs(acceleration).max() <= 500.001
    assert lathe.planner.status()["pos"][:3] == [5.0, 0.0, 0.0]


def test_an_abort_stops_a_tap():
    lathe = ReversingSpindle(5.0, 50.0)
    lathe.planner.add_tap((0, 0, -10), 100.0, 1.25)
    while lathe.period()[0] > -5.0:
        pass
    lathe.planner.abort()
    for _ in range(100):
        z, _ = lathe.period()
    assert lathe.planner.status()["done"]
    assert z == pytest.approx(-5.0, abs=0.1)
