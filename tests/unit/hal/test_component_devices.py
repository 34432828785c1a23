"""Components for things at plain pins: a pad of keys, converters of thermocouples."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from hal.realtime import Host
from nml.errors import HalError
from tests.unit.hal.conftest import Bench

Load = Callable[..., Bench]


def pressed(bench: Bench) -> set[str]:
    return {f"r{r}c{c}" for r in range(2) for c in range(3) if bench.get(f"key.r{r}c{c}")}


def type_in(pad: Bench, *codes: int) -> set[str]:
    for code in codes:
        pad.set(keycode=code)
        pad.run("matrix_kb.0")
    return pressed(pad)


def test_keys_follow_their_codes_and_a_third_one_is_left_out(component: Load) -> None:
    pad = component("matrix_kb", "config=2x3", instance="matrix_kb.0")
    assert type_in(pad, 0xC1, 0xC4) == {"r0c1", "r1c0"}
    assert type_in(pad, 0xC6) == {"r0c1", "r1c0"}, "two keys at a time"
    assert type_in(pad, 0x86, 0xC2) == {"r0c1", "r1c0"}, "the release of a key that was left out counts for nothing"
    assert type_in(pad, 0x81, 0xC2) == {"r1c0", "r0c2"}
    assert type_in(pad, 0x42, 0xC3, 0xFF) == {"r1c0", "r0c2"}, "no event, no such column, no such row"


def test_a_scanned_pad_drives_its_rows_in_turn_and_wants_two_scans_that_agree(component: Load) -> None:
    pad = component("matrix_kb", "config=2x3s", instance="matrix_kb.0")
    matrix = {"r0c2": (0, 2), "r1c1": (1, 1)}

    def scan(held: set[str], periods: int) -> set[str]:
        for _ in range(periods):
            low = [row for row in range(2) if not pad.get(f"row-{row:02}-out")]
            down = {matrix[key][1] for key in held if matrix[key][0] in low}
            pad.set(**{f"col_{column:02}_in": column not in down for column in range(3)})
            pad.run("matrix_kb.0")
        return pressed(pad)

    assert scan(set(), 4) == set()
    assert scan({"r1c1"}, 2) == set(), "seen once"
    assert scan(set(), 4) == set()
    assert scan({"r1c1"}, 4) == {"r1c1"}
    assert scan({"r0c2", "r1c1"}, 4) == {"r0c2", "r1c1"}
    assert scan({"r0c2"}, 4) == {"r0c2"}


@pytest.mark.parametrize("words", [["config=2"], ["config=33x2"], ["config=2x3,x"], ["config=2x3", "names=a,b"]])
def test_a_pad_of_no_size_is_refused(host: Host, words: list[str]) -> None:
    with pytest.raises(HalError, match="would be right"):
        host.load("matrix_kb", words)


def send(bench: Bench, celsius: float, cold_end: float, flags: int = 0) -> float:
    """One reading: the bits of a converter, in time with its selection; the temperature afterwards."""
    word = (round(celsius * 4) << 18 & 0xFFFC0000) | (round(cold_end * 16) << 4 & 0xFFF0) | flags
    while not bench.get("cs.out"):
        bench.run("max31855.0.bitbang-spi")
    while bench.get("cs.out"):
        bench.run("max31855.0.bitbang-spi")
    bench.run("max31855.0.bitbang-spi")
    for call in range(64):
        bench.set(**{"data.0.in": bool(word >> 31 - call // 2 & 1)})
        bench.run("max31855.0.bitbang-spi")
    return bench.get("temp-celsius.0")


def test_a_thermocouple_s_reading_is_made_linear_but_beyond_the_tables(component: Load) -> None:
    chip = component("max31855", "personality=1")
    assert send(chip, 25.0, 25.0) == pytest.approx(24.99, abs=0.01)
    assert chip.get("temp-kelvin.0") == pytest.approx(298.14, abs=0.01)
    assert chip.get("temp-fahrenheit.0") == pytest.approx(76.98, abs=0.02)
    assert send(chip, 100.0, 0.0) == pytest.approx(100.73, abs=0.01)
    assert send(chip, -50.0, 20.0) == pytest.approx(-55.68, abs=0.01)
    assert send(chip, -220.0, 10.0) == -220.0
    assert send(chip, 1500.0, 20.0) == 1500.0


def test_a_broken_thermocouple_leaves_the_temperature_as_it_was(component: Load) -> None:
    chip = component("max31855", "personality=1")
    before = send(chip, 100.0, 20.0)
    assert (send(chip, 900.0, 20.0, flags=4), chip.get("fault.0"), chip.get("fault-flags.0")) == (before, 1, 4)
    assert send(chip, 200.0, 20.0) > before
    assert not chip.get("fault.0")
