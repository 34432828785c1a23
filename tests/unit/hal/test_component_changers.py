"""Tool changers: how a carousel finds a pocket with each kind of feedback, and which way round is shorter."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from nml.errors import HalError
from tests.unit.hal.conftest import Bench

Load = Callable[..., Bench]
AT_REST, TO_POCKET, ARRIVED, HOMING = 0, 2, 9, 11


def carousel(component: Load, *words: str) -> Bench:
    bench = component("carousel", *words)
    bench.set(fwd_dc=1.0, rev_dc=2.0, hold_dc=3.0)
    return bench


def after(bench: Bench, periods: int = 1, **pins: object) -> tuple[float, float, float]:
    """State, position and motor velocity after these pins have been seen."""
    bench.set(**pins)
    bench.run("carousel.0", periods)
    return bench.get("state"), bench.get("current_position"), bench.get("motor_vel")


def sensors(bits: int) -> dict[str, bool]:
    return {f"sense_{i}": bool(bits >> i & 1) for i in range(4)}


@pytest.mark.parametrize(
    ("encoding", "bits", "position"),
    [("gray", 0b0110, 4), ("gray", 0b1100, 8), ("binary", 0b0110, 6), ("bcd", 0b1001, 9), ("single", 0b0100, 3)],
)
def test_sensors_tell_the_pocket(component: Load, encoding: str, bits: int, position: int) -> None:
    bench = carousel(component, "pockets=12", f"encoding={encoding}")
    assert after(bench, **sensors(bits))[1] == position
    assert after(bench, strobe=False, **sensors(0b0001))[1] == position, "read without a strobe"


def test_parity_is_watched(component: Load) -> None:
    bench = carousel(component, "pockets=8", "encoding=binary")
    after(bench, **sensors(0b0010))
    assert bench.get("parity_error")
    after(bench, parity=True)
    assert not bench.get("parity_error")


@pytest.mark.parametrize(
    ("direction", "pocket", "speed"), [(2, 3, 1.0), (2, 7, 2.0), (2, 5, 1.0), (1, 7, 1.0), (2, 15, 2.0)]
)
def test_it_turns_the_shorter_way_to_the_pocket_and_stops_there(
    component: Load, direction: int, pocket: int, speed: float
) -> None:
    bench = carousel(component, "pockets=8", "encoding=binary", f"dir={direction}")
    after(bench, **sensors(1))
    assert after(bench, pocket_number=pocket, enable=True) == (TO_POCKET, 1, speed)
    assert (bench.get("motor_fwd"), bench.get("motor_rev")) == (speed == 1.0, speed == 2.0)
    assert after(bench, **sensors((pocket - 1) % 8 + 1)) == (ARRIVED, (pocket - 1) % 8 + 1, 3.0)
    assert (bench.get("ready"), bench.get("active")) == (True, False)
    assert after(bench, enable=False)[0] == AT_REST


def test_enable_falling_stops_it_on_the_way(component: Load) -> None:
    bench = carousel(component, "pockets=8", "encoding=binary")
    after(bench, pocket_number=3, enable=True, **sensors(1))
    assert after(bench, enable=False) == (AT_REST, 1, 3.0)
    assert not bench.get("ready")


@pytest.mark.parametrize("pocket", [0, -1])
def test_no_pocket_is_no_move(component: Load, pocket: int) -> None:
    bench = carousel(component, "pockets=8", "encoding=binary")
    assert after(bench, pocket_number=pocket, enable=True, **sensors(4)) == (ARRIVED, 4, 3.0)


def test_an_index_is_searched_first_and_pockets_are_counted_from_it(component: Load) -> None:
    bench = carousel(component, "pockets=6", "encoding=index")
    assert after(bench, pocket_number=3, enable=True) == (HOMING, 0, 1.0)
    assert after(bench, enable=False)[0] == HOMING, "homing stopped"
    after(bench, enable=True, sense_1=True)
    assert after(bench, sense_0=True) == (TO_POCKET, 1, 1.0)
    for seen in (False, True, False):
        after(bench, sense_0=False, sense_1=seen)
    assert after(bench, sense_1=True) == (ARRIVED, 3, 3.0)
    after(bench, enable=False, sense_1=False)
    after(bench, pocket_number=2, enable=True)
    assert after(bench, sense_1=True) == (ARRIVED, 2, 3.0)
    assert after(bench, enable=False, unhome=True)[0] == AT_REST
    assert after(bench, enable=True, unhome=False)[0] == HOMING


def test_counts_are_pockets_within_a_width(component: Load) -> None:
    bench = carousel(component, "pockets=6", "encoding=counts")
    bench.set(scale=100, width=10, counts=300, home_offset=0)
    assert after(bench, pocket_number=6, enable=True)[0] == HOMING
    assert bench.get("index_enable")
    assert after(bench, index_enable=False)[:2] == (TO_POCKET, 1)
    assert after(bench, counts=209)[:2] == (TO_POCKET, 1)
    assert after(bench, counts=204)[:2] == (ARRIVED, 6)


def test_it_is_pressed_against_a_stop(component: Load) -> None:
    bench = carousel(component, "pockets=8", "encoding=binary")
    bench.set(rev_pulse=0.0025)
    after(bench, pocket_number=2, enable=True, **sensors(1))
    assert [after(bench, **sensors(2))[2] for _ in range(5)] == [2.0, 2.0, 2.0, 3.0, 3.0]


def test_it_creeps_over_the_marker_to_its_near_edge(component: Load) -> None:
    bench = carousel(component, "pockets=8", "encoding=binary")
    bench.set(align_dc=0.5, decel_time=0.0015)
    after(bench, pocket_number=2, enable=True, **sensors(1))
    assert after(bench, **sensors(2))[2] == 0.0, "slows down"
    assert after(bench, 3, **sensors(0))[2] == -0.5, "back to the marker that it has run over"
    assert after(bench, 2, **sensors(2))[2] == -0.5, "over the marker"
    assert after(bench, **sensors(0))[2] == 0.5, "off it"
    assert after(bench, **sensors(2)) == (ARRIVED, 2, 3.0)


def test_a_jog_goes_one_pocket_on(component: Load) -> None:
    bench = carousel(component, "pockets=8", "encoding=binary")
    after(bench, **sensors(8))
    assert after(bench, jog_fwd=True)[2] == 1.0
    assert after(bench, **sensors(1))[2] == 3.0
    assert after(bench, 5)[2] == 3.0, "once for each press"
    assert after(bench, jog_fwd=False)[0] == AT_REST


def test_lists_make_several_and_the_last_value_goes_on(bench: Bench) -> None:
    bench.load("carousel", "pockets=4,5,6", "encoding=index,gray", "num_sense=2,3")
    names = [item.name for item in bench.hal.segment.items(0) if ".sense-" in item.name]
    assert sorted(names) == [f"carousel.{n}.sense-{i}" for n, senses in enumerate((2, 3, 3)) for i in range(senses)]


@pytest.mark.parametrize(
    ("words", "what"),
    [
        (["pockets="], "pockets=: up to 8 numbers from 1 to 255 would be right"),
        (["pockets=4", "encoding=morse"], "encoding=morse: gray, binary, bcd"),
        (["pockets=4", "dir=3"], "dir=3: from 0 to 2 would be right"),
    ],
)
def test_wrong_parameters_are_named(bench: Bench, words: list[str], what: str) -> None:
    with pytest.raises(HalError, match=what):
        bench.load("carousel", *words)


@pytest.mark.parametrize(
    ("first", "last", "wrap", "actual", "desired", "way"),
    [(0, 15, 1, 0, 8, 1), (0, 15, 1, 0, 9, -1), (0, 15, 0, 0, 9, 1), (1, 6, 1, 1, 6, -1), (-2, 3, 1, 2, 2, 0)],
)
def test_modmath_finds_the_shorter_way_round(
    component: Load, first: int, last: int, wrap: int, actual: int, desired: int, way: int
) -> None:
    bench = component("modmath", "mod_dir=1", instance="mod-dir.0")
    bench.set(min_num=first, max_num=last, wrap=wrap, actual=actual, desired=desired)
    bench.run("mod-dir.0")
    assert [bench.get(name) for name in ("up", "down", "on_target")] == [way > 0, way < 0, way == 0]
