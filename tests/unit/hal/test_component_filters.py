"""What the components that limit and smooth a value over time do."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from tests.unit.hal.conftest import Bench

Load = Callable[..., Bench]


def test_ddt_and_integ_undo_each_other(component: Load) -> None:
    bench = component("ddt")
    bench.load("integ")
    bench.hal.net("v", ["ddt.0.out", "integ.0.in"])
    for n in range(200):
        bench.use("ddt.0").set(in_=math.sin(n / 20))
        bench.run("ddt.0")
        bench.run("integ.0")
    assert bench.use("integ.0").get("out") == pytest.approx(math.sin(199 / 20), abs=1e-9)


def test_lincurve_draws_straight_lines(component: Load) -> None:
    bench = component("lincurve", "personality=3")
    for n, (x, y) in enumerate([(0, 0), (10, 100), (20, 0)]):
        bench.set(**{f"x_val_0{n}": x, f"y_val_0{n}": y})
    got = []
    for value in (-5.0, 5.0, 10.0, 15.0, 99.0):
        bench.set(in_=value)
        bench.run("lincurve.0")
        got.append(bench.get("out"))
    assert got == [0.0, 50.0, 100.0, 50.0, 0.0]


def test_limit2_keeps_its_velocity(component: Load) -> None:
    bench = component("limit2")
    bench.set(in_=1.0, maxv=300.0)
    got = []
    for _ in range(4):
        bench.run("limit2.0")
        got.append(round(bench.get("out"), 6))
    assert got == [0.3, 0.6, 0.9, 1.0]


@pytest.mark.parametrize("seed", range(20))
def test_limit3_keeps_all_limits_whatever_comes(component: Load, seed: int) -> None:
    import random

    rng = random.Random(seed)
    bench = component("limit3")
    maxv, maxa, low, high = rng.uniform(1, 50), rng.uniform(10, 2000), -rng.uniform(0.1, 5), rng.uniform(0.1, 5)
    bench.set(maxv=maxv, maxa=maxa, min=low, max=high)
    old, old_v, target = 0.0, 0.0, 0.0
    for _ in range(600):
        if rng.random() < 0.02:
            target = rng.uniform(-6, 6)
        target += rng.uniform(-0.001, 0.001)
        bench.set(in_=target)
        bench.run("limit3.0")
        out = bench.get("out")
        v = (out - old) / 1e-3
        assert low - 1e-9 <= out <= high + 1e-9
        assert abs(v) <= maxv * (1 + 1e-9) + 1e-6
        assert abs(v - old_v) <= maxa * 1e-3 * (1 + 1e-6) + 1e-6
        old, old_v = out, v


def test_limit3_follows_a_ramp_without_lag(component: Load) -> None:
    bench = component("limit3")
    bench.set(maxv=100.0, maxa=1000.0)
    for n in range(400):
        bench.set(in_=0.01 * n)
        bench.run("limit3.0")
    assert bench.get("out") == pytest.approx(0.01 * 399, abs=1e-9)


def test_lowpass_approaches_and_loads(component: Load) -> None:
    bench = component("lowpass")
    bench.set(in_=1.0, gain=0.5)
    bench.run("lowpass.0", 2)
    assert bench.get("out") == 0.75
    bench.set(load=True, in_=9.0)
    bench.run("lowpass.0")
    assert bench.get("out") == 9.0


def test_simple_tp_arrives_without_passing_its_target(component: Load) -> None:
    bench = component("simple_tp")
    bench.set(target_pos=1.0, maxvel=20.0, maxaccel=500.0, enable=True)
    places = []
    for _ in range(150):
        bench.run("simple-tp.0.update")
        places.append(bench.get("current_pos"))
    assert max(places) <= 1.0 + 1e-6
    assert places[-1] == pytest.approx(1.0, abs=1e-4)
    assert bench.get("active") is False


def test_histobins_counts_what_lies_outside(component: Load) -> None:
    bench = component("histobins")
    bench.set(nbins=2, index=1)
    for value in (0.0, 1.5, 1.9, -1.0, 7.0):
        bench.set(input=value)
        bench.run("histobins.0")
    assert [bench.get(name) for name in ("binvalue", "nextra", "pextra")] == [2.0, 1.0, 1.0]


def test_limit3_accelerates_fully_or_brakes_fully_until_it_is_there(component: Load) -> None:
    bench = component("limit3")
    bench.set(maxa=10000.0, in_=0.955)
    got = []
    for _ in range(22):
        bench.run("limit3.0")
        got.append(round(bench.get("out") * 1000))
    assert got[:10] == [10, 30, 60, 100, 150, 210, 280, 360, 450, 530]
    assert got[10:] == [600, 660, 730, 790, 840, 880, 910, 930, 940, 940, 950, 955]


def test_limit3_meets_a_target_that_comes_towards_it_at_its_velocity(component: Load) -> None:
    bench = component("limit3")
    bench.set(maxv=4000.0, maxa=10000.0, in_=100.0)
    ways = []
    for n in range(400):
        bench.set(in_=100.0 - 0.8 * n)
        bench.run("limit3.0")
        ways.append(bench.get("out"))
    assert ways[-1] == pytest.approx(100.0 - 0.8 * 399)
    assert max(ways) < 13.0, "it turned round early enough"
