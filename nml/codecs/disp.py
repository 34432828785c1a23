"""The ``disp`` encoding: comma-separated text that people and line-oriented programs can read.

Every item ends with a comma. Integers have a sign (unsigned ones not), doubles six decimals; a character that is not
printable is a backslash and three decimal digits, comma ``\\c``, backslash ``\\\\``, newline ``\\n``.
"""

from __future__ import annotations

import re
from typing import Any

from nml.codecs import walk
from nml.errors import DecodeError
from nml.fields import BOOL, DOUBLE, FLOAT, INT, LONG, UCHAR, UINT, ULONG, CType
from nml.message import Message

_SPELLINGS: dict[CType, str] = {
    INT: "+6d",
    UINT: "6d",
    LONG: "+d",
    ULONG: "d",
    FLOAT: ".6f",
    DOUBLE: ".6f",
}
_CHARACTERS = (BOOL, UCHAR)
_NAMED = {ord(","): b"\\c", ord("\\"): b"\\\\", ord("\n"): b"\\n"}
_ESCAPES = [
    _NAMED.get(code) or (bytes([code]) if 0x21 <= code <= 0x7E else b"\\%03d" % code) for code in range(256)
]
_ESCAPE = re.compile(rb"\\(c|\\|n|\d{3})")
_CODES = {b"c": b",", b"\\": b"\\", b"n": b"\n"}


class _Writer(walk.Writer):
    def number(self, ctype: CType, value: Any) -> bytes:
        if ctype in _CHARACTERS:
            return _ESCAPES[value] + b","
        return format(value, _SPELLINGS[ctype]).encode() + b","

    def string(self, raw: bytes, length: int) -> bytes:
        return b"".join(_ESCAPES[code] for code in raw) + b","


class _Reader(walk.Reader):
    def __init__(self, data: bytes) -> None:
        self.items = iter(data.split(b",")[:-1])

    def _take(self) -> bytes:
        item = next(self.items, None)
        if item is None:
            raise DecodeError("too few items")
        return item

    def number(self, ctype: CType) -> Any:
        item = self._take()
        if ctype in _CHARACTERS:
            raw = _unescaped(item)
            if len(raw) != 1:
                raise ValueError(f"{item!r} is no single character")
            return raw[0]
        return float(item) if ctype in (FLOAT, DOUBLE) else int(item)

    def string(self, length: int) -> bytes:
        raw = _unescaped(self._take())
        if len(raw) > length:
            raise DecodeError(f"{len(raw)} bytes of text, {length} fit")
        return raw


def encode(message: Message, preamble: bool = True) -> bytes:
    """The message as text."""
    return walk.write(message, _Writer(), preamble)


def decode(data: bytes | bytearray | memoryview, preamble: bool = True) -> Message:
    """A new message; items behind it are ignored."""
    raw = bytes(data)
    try:
        type_id = int(raw.partition(b",")[0])
    except ValueError:
        raise DecodeError(f"{raw[:12]!r} is no message type") from None
    return walk.read(_Reader(raw), type_id, preamble)


def _unescaped(item: bytes) -> bytes:
    def plain(match: re.Match[bytes]) -> bytes:
        word = match[1]
        code = _CODES.get(word)
        if code is None:
            if int(word) > 255:
                raise DecodeError(f"\\{word.decode()} is no character")
            code = bytes([int(word)])
        return code

    return _ESCAPE.sub(plain, item)
