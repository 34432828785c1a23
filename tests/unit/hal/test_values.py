"""Values as people write and read them."""

from __future__ import annotations

import pytest

from hal._shm import BIT, FLOAT, S32, S64, U32, U64
from hal.values import parse_value, plain_value, show_value
from nml.errors import HalError


@pytest.mark.parametrize(
    ("type_", "text", "value"),
    [
        (BIT, "TRUE", True), (BIT, "true", True), (BIT, "1", True), (BIT, "0", False), (BIT, "FALSE", False),
        (FLOAT, "1.5", 1.5), (FLOAT, "-1e-7", -1e-7), (FLOAT, "0x10", 16.0), (FLOAT, ".5", 0.5),
        (S32, "-2147483648", -(2**31)), (S32, "0x7fffffff", 2**31 - 1), (S32, "010", 8),
        (U32, "0xffffffff", 2**32 - 1), (U32, "-1", 2**32 - 1), (S64, "-9223372036854775808", -(2**63)),
        (U64, "0xffffffffffffffff", 2**64 - 1),
    ],
)  # fmt: skip
def test_a_value_is_read_as_c_would_read_it(type_: int, text: str, value: float) -> None:
    assert parse_value(type_, text) == value


@pytest.mark.parametrize(
    ("type_", "text"),
    [(BIT, "7"), (BIT, "yes"), (FLOAT, "1,5"), (FLOAT, "1_0"), (FLOAT, ""), (S32, "1.5"), (S32, "2147483648"),
     (U32, "4294967296"), (U32, "-4294967297"), (U64, "18446744073709551616"), (S32, "x"), (S32, "")],
)  # fmt: skip
def test_a_value_that_is_none_is_refused_with_what_would_be_right(type_: int, text: str) -> None:
    with pytest.raises(HalError, match=r"invalid for .*would be right"):
        parse_value(type_, text)


@pytest.mark.parametrize(
    ("type_", "value", "shown", "plain"),
    [
        (BIT, True, "TRUE", "TRUE"),
        (FLOAT, 2147483647.0, "2.147484e+09", "2.147484e+09"),
        (S32, -5, "-5", "-5"),
        (U32, 255, "0x000000FF", "255"),
        (U64, 255, "0x00000000000000FF", "255"),
    ],
)
def test_values_are_shown_as_linuxcnc_shows_them(type_: int, value: float, shown: str, plain: str) -> None:
    assert show_value(type_, value) == shown
    assert plain_value(type_, value) == plain
