"""HAL's types and directions: their numbers, names, and how values are read from text and shown.

The widths and formats are those of LinuxCNC 2.10's halcmd, because scripts read its output.
"""

from __future__ import annotations

from typing import Any

from hal._shm import BIT, FLOAT, IN, IO, OUT, PORT, RO, RW, S32, S64, U32, U64
from nml.errors import HalError

TYPE_NAMES = {BIT: "bit", FLOAT: "float", S32: "s32", U32: "u32", PORT: "port", S64: "s64", U64: "u64"}
TYPES = {name: number for number, name in TYPE_NAMES.items()}
PIN_DIR_NAMES = {IN: "IN", OUT: "OUT", IO: "I/O"}
PARAM_DIR_NAMES = {RO: "RO", RW: "RW"}
PIN_ARROWS = {IN: "<==", OUT: "==>", IO: "<=>"}  # from a pin's side, towards its signal
SIGNAL_ARROWS = {IN: "==>", OUT: "<==", IO: "<=>"}  # from a signal's side, towards its pin

RANGES = {
    S32: (-(2**31), 2**31 - 1),
    U32: (0, 2**32 - 1),
    S64: (-(2**63), 2**63 - 1),
    U64: (0, 2**64 - 1),
    PORT: (0, 2**20),  # bytes of its buffer
}
_BITS = {"1": True, "true": True, "0": False, "false": False}
_SHOWN = {
    FLOAT: lambda v: f"{v:.7g}",
    BIT: lambda v: "TRUE" if v else "FALSE",
    U32: lambda v: f"0x{v:08X}",
    U64: lambda v: f"0x{v:016X}",
}


def show_value(type_: int, value: Any) -> str:
    """A value as ``show`` and ``save`` print it, without the padding."""
    return _SHOWN.get(type_, str)(value)


def plain_value(type_: int, value: Any) -> str:
    """A value as ``getp`` and ``gets`` print it."""
    return str(value) if type_ in RANGES else show_value(type_, value)


def parse_value(type_: int, text: str) -> bool | float | int:
    """The value that ``text`` names; HalError where it is none of that type."""
    try:
        if type_ == BIT:
            return _BITS[text.lower()]
        if type_ == FLOAT:
            if "_" in text:
                raise ValueError(text)
            return float.fromhex(text) if "0x" in text.lower() else float(text)
        return _parse_integer(type_, text)
    except (ValueError, KeyError):
        raise HalError(f"value '{text}' invalid for {TYPE_NAMES[type_]}; {_allowed(type_)}") from None


def _parse_integer(type_: int, text: str) -> int:
    """Decimal, 0x hexadecimal or 0 octal, as C reads them; without a sign bit, a negative number wraps."""
    digits = text.lstrip("+-")
    if not digits or "_" in text:
        raise ValueError(text)
    octal = digits[0] == "0" and digits.isdigit()
    value = int(text, 8 if octal else 0)
    low, high = RANGES[type_]
    if type_ in (U32, U64) and -high - 1 <= value < 0:
        value += high + 1
    if not low <= value <= high:
        raise ValueError(text)
    return value


def _allowed(type_: int) -> str:
    """What would be right, for an error's text."""
    if type_ == BIT:
        return "1, TRUE, 0 or FALSE would be right"
    if type_ == FLOAT:
        return "a number would be right"
    low, high = RANGES[type_]
    return f"a whole number from {low} to {high} would be right"


def type_number(name: str) -> int:
    """The number of a type that a person named; HalError for none."""
    try:
        return TYPES[name.lower()]
    except KeyError:
        raise HalError(f"Unknown signal type '{name}'; known are {', '.join(sorted(TYPES))}") from None
