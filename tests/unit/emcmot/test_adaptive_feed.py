"""motion.adaptive-feed: it scales the feed of moves that M52 put under it; below 0 the path is run backwards."""

from __future__ import annotations

import math
import random

import pytest

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C
from tests.support.mill import line, mill


def adaptive(*, on: bool = True) -> Motion:
    """A mill on its way through an angle: x to 40, then y to 40."""
    m = mill("coord")
    m.send(C.AF_ENABLE, mode=int(on))
    line(m, 40, id=1, tolerance=0.01)
    line(m, 40, 40, id=2, tolerance=0.01)
    m.step(500)
    return m


def place(m: Motion) -> tuple[float, float]:
    return m["joint.0.pos-cmd"], m["joint.1.pos-cmd"]


def test_the_feed_follows_the_pin_and_the_pins_sign_is_the_direction() -> None:
    m = adaptive()
    m["motion.adaptive-feed"] = 0.5
    m.step(300)
    assert m["motion.current-vel"] == pytest.approx(15.0)
    m["motion.adaptive-feed"] = -0.5
    m.step(300)
    assert m["motion.tp-reverse"]
    assert m["joint.0.vel-cmd"] == pytest.approx(-15.0)
    m["motion.adaptive-feed"] = 1.0
    m.step(300)
    assert not m["motion.tp-reverse"]
    assert m["joint.0.vel-cmd"] == pytest.approx(30.0)
    m.run_until_rest()
    assert place(m) == pytest.approx((40.0, 40.0))
    assert m.errors() == []
    assert m.worst_acc <= 1.0 + 1e-6


def test_a_negative_feed_goes_back_round_a_corner_and_rests_at_the_start() -> None:
    m = adaptive()
    m.step(1500)
    assert place(m)[1] > 5.0
    m["motion.adaptive-feed"] = -1.0
    m.step(6000)
    assert place(m) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert not m["motion.in-position"], "the program is still there"
    m["motion.adaptive-feed"] = 1.0
    m.run_until_rest()
    assert place(m) == pytest.approx((40.0, 40.0))


@pytest.mark.parametrize("value", [0.0, math.nan, math.inf])
def test_no_feed_or_none_that_is_a_number_holds_the_machine(value: float) -> None:
    m = adaptive()
    m["motion.adaptive-feed"] = value
    m.step(200)
    held = place(m)
    m.step(200)
    assert place(m) == held
    assert m.worst_acc <= 1.0 + 1e-6


def test_moves_that_are_not_under_adaptive_feed_do_not_care() -> None:
    m = adaptive(on=False)
    m["motion.adaptive-feed"] = -1.0
    m.step(100)
    assert m["joint.0.vel-cmd"] == pytest.approx(30.0)
    assert not m["motion.tp-reverse"]


def test_an_abort_on_the_way_back_ends_it() -> None:
    m = adaptive()
    m["motion.adaptive-feed"] = -1.0
    m.step(200)
    m.send(C.ABORT)
    m.run_until_rest()
    assert not m["motion.tp-reverse"]
    line(m, 0, 30, id=3)
    m["motion.adaptive-feed"] = 1.0
    m.run_until_rest()
    assert place(m) == pytest.approx((0.0, 30.0))


def test_reverse_run_and_a_negative_feed_together_go_forward() -> None:
    m = adaptive()
    m.send(C.PAUSE)
    m.step(100)
    assert m.send(C.REVERSE) == 0
    m.send(C.RESUME)
    m.step(100)
    assert m["joint.0.vel-cmd"] == pytest.approx(-30.0)
    m["motion.adaptive-feed"] = -1.0
    m.step(200)
    assert m["joint.0.vel-cmd"] == pytest.approx(30.0)


@pytest.mark.parametrize("seed", range(20))
def test_random_feeds_of_both_signs_keep_the_path_and_the_limits(seed: int) -> None:
    rng = random.Random(seed)
    m = mill("coord")
    m.send(C.AF_ENABLE, mode=1)
    points = [(rng.uniform(-50, 50), rng.uniform(-50, 50)) for _ in range(12)]
    for n, point in enumerate(points):
        line(m, *point, id=n + 1, vel=80.0, termCond=2, tolerance=0.05)
    for _ in range(60):
        m["motion.adaptive-feed"] = rng.choice([-1.0, -0.3, 0.0, 0.2, 1.0, 1.0])
        m.step(rng.randrange(1, 400))
    m["motion.adaptive-feed"] = 1.0
    m.run_until_rest()
    assert place(m) == pytest.approx(points[-1])
    assert m.errors() == []
    assert m.worst_vel <= 1.0 + 1e-6
    assert m.worst_acc <= 1.0 + 1e-6
