"""The ``ascii`` encoding: text of fixed width, for machines without a common number format.

int 8 bytes (6 wide, then zeros), long 16 (14 wide), float and double 16 (7 decimals), bool and char one raw byte, text
all bytes of its field. An integer that the form would cut is refused; a double keeps eight digits.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from nml.codecs import walk
from nml.errors import DecodeError, EncodeError
from nml.fields import BOOL, DOUBLE, FLOAT, INT, LONG, UCHAR, UINT, ULONG, CType
from nml.message import Message


class _Form(NamedTuple):
    """Width of the number and of the whole item, and how the number is written and read."""

    width: int
    size: int
    spelling: str
    read: type[int] | type[float]


_FORMS: dict[CType, _Form] = {
    INT: _Form(6, 8, "d", int),
    UINT: _Form(6, 8, "d", int),
    LONG: _Form(14, 16, "d", int),
    ULONG: _Form(14, 16, "d", int),
    FLOAT: _Form(13, 16, ".7e", float),
    DOUBLE: _Form(13, 16, ".7e", float),
}
_BYTES = (BOOL, UCHAR)


class _Writer(walk.Writer):
    def number(self, ctype: CType, value: Any) -> bytes:
        if ctype in _BYTES:
            return bytes([value])
        form = _FORMS[ctype]
        text = format(value, form.spelling).ljust(form.width)
        if len(text) >= form.size:
            raise EncodeError(f"{value} has more than {form.size - 1} digits")
        return text.encode().ljust(form.size, b"\0")

    def string(self, raw: bytes, length: int) -> bytes:
        return raw.ljust(length, b"\0")


class _Reader(walk.Reader):
    def __init__(self, data: bytes) -> None:
        self.data = data
        self.at = 0

    def _take(self, size: int) -> bytes:
        if self.at + size > len(self.data):
            raise DecodeError(f"{len(self.data)} bytes, too few")
        self.at += size
        return self.data[self.at - size : self.at]

    def number(self, ctype: CType) -> Any:
        if ctype in _BYTES:
            return self._take(1)[0]
        form = _FORMS[ctype]
        return form.read(self._take(form.size).rstrip(b"\0 "))

    def string(self, length: int) -> bytes:
        return self._take(length)


def encode(message: Message, preamble: bool = True) -> bytes:
    """The message as bytes; EncodeError for an integer that the form would cut."""
    return walk.write(message, _Writer(), preamble)


def decode(data: bytes | bytearray | memoryview, preamble: bool = True) -> Message:
    """A new message; bytes behind it are ignored."""
    raw = bytes(data)
    try:
        type_id = int(raw[:8].rstrip(b"\0 "))
    except ValueError:
        raise DecodeError(f"{raw[:8]!r} is no message type") from None
    return walk.read(_Reader(raw), type_id, preamble)
