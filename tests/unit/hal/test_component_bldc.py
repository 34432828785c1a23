"""Commutation of three-phase motors: how the rotor's angle is found, and what tells that it is not."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from hal.components.motors import HALL_PATTERNS
from hal.realtime import Host
from nml.errors import HalError
from tests.unit.hal.conftest import Bench

Load = Callable[..., Bench]
ALIGNMENT = 2401  # periods


def motor(component: Load, kind: str, **pins: object) -> Bench:
    bench = component("bldc", f"cfg={kind}", instance="bldc.0")
    bench.set(**pins)
    bench.run("bldc.0")
    return bench


def test_a_motor_is_pulled_to_its_zero_before_it_turns(component: Load) -> None:
    bench = motor(component, "q", value=1.0, rawcounts=100)
    bench.run("bldc.0", 10)
    assert bench.get("A-value") == 0.0, "nothing is driven before the alignment"
    bench.set(init=True)
    bench.run("bldc.0", 101)
    assert bench.get("out") == pytest.approx(0.05), "the current rises slowly"
    bench.set(init=False)
    bench.run("bldc.0", 5000)
    assert not bench.get("init-done"), "it waits"
    bench.set(init=True)
    bench.run("bldc.0", ALIGNMENT - 1)
    assert (bench.get("init-done"), bench.get("rotor-angle"), bench.get("A-value")) == (0, 0.0, pytest.approx(0.2))
    bench.set(rawcounts=117)
    bench.run("bldc.0", 3)
    assert (bench.get("init-done"), bench.get("offset-measured")) == (1, 117)
    assert (bench.get("rotor-angle"), bench.get("phase-angle"), bench.get("out")) == (0.0, 0.25, 1.0)


@pytest.mark.parametrize(("rev", "angle"), [(False, 0.05), (True, 0.95)])
def test_a_motor_is_turned_until_the_index_is_seen(component: Load, rev: bool, angle: float) -> None:
    bench = motor(component, "qi", value=1.0, rev=rev, encoder_offset=30, init=True)
    bench.run("bldc.0", 50)
    assert (bench.get("rotor-angle"), bench.get("out")) == (pytest.approx(angle), 0.2)
    assert bench.get("index-enable"), "the encoder is asked for its index"
    bench.set(rawcounts=1000, index_enable=False)
    bench.run("bldc.0", 2)
    assert (bench.get("init-done"), bench.get("offset-measured")) == (1, 1030)
    bench.set(rawcounts=1030 + 64)
    bench.run("bldc.0", 2)
    assert bench.get("rotor-angle") == pytest.approx(0.25), "256 counts are an electrical revolution"


def test_sensors_turn_a_motor_until_the_index_is_more_exact(component: Load) -> None:
    bench = motor(component, "qhi", value=1.0, hall1=True)
    bench.run("bldc.0")
    assert (bench.get("A-value"), bench.get("B-value"), bench.get("C-value")) == (-1.0, 0.0, 1.0)
    bench.set(rawcounts=-8, index_enable=False)
    bench.run("bldc.0", 2)
    assert (bench.get("rotor-angle"), bench.get("offset-measured")) == (0.0, -8)
    assert bench.get("B-value") == pytest.approx(0.8660254)


def test_an_impossible_reading_is_an_error_until_another_pattern_is_tried(component: Load) -> None:
    bench = motor(component, "h", value=1.0, hall1=True)
    bench.run("bldc.0")
    assert not bench.get("hall-error")
    bench.set(hall1=False)
    bench.run("bldc.0")
    assert bench.get("hall-error")
    assert [bench.get(f"{phase}-value") for phase in "ABC"] == [0.0, 0.0, 0.0]
    bench.set(hall1=True)
    bench.run("bldc.0")
    assert (bench.get("hall-error"), bench.get("C-value")) == (1, 1.0)
    bench.set(pattern=0)
    bench.run("bldc.0")
    assert not bench.get("hall-error")
    bench.set(pattern=48)
    bench.run("bldc.0")
    assert (bench.get("hall-error"), bench.get("C-value")) == (1, 0.0), "there is no such pattern"


def test_each_pattern_has_six_readings_of_which_no_two_are_the_same() -> None:
    assert len(set(HALL_PATTERNS)) == 48
    assert all(len(set(readings)) == 6 for readings in HALL_PATTERNS)


@pytest.mark.parametrize("kind", ["", "z", "q,", "Q"])
def test_a_motor_of_no_kind_is_refused(host: Host, kind: str) -> None:
    with pytest.raises(HalError, match="would be right"):
        host.load("bldc", [f"cfg={kind}"])
