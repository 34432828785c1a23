"""Fast ways into messages: several neighbouring fields packed or unpacked by one ``struct`` call."""

from __future__ import annotations

import struct
from collections import namedtuple
from typing import Any

from nml.message import Message, Struct


def image(message: Message) -> bytearray:
    """The bytes of a message that owns its memory, live."""
    data = message.data
    assert isinstance(data, bytearray)
    return data


class Span:
    """The fields of ``cls`` from ``first`` to ``last``, in memory order, as one flat tuple of numbers."""

    def __init__(self, cls: type[Struct], first: str, last: str) -> None:
        names = [field.name for field in cls.FIELDS]
        fields = cls.FIELDS[names.index(first) : names.index(last) + 1]
        self.offset = fields[0].offset
        parts, at = ["<"], self.offset
        for field in fields:
            parts.append(f"{field.offset - at}x" if field.offset > at else "")
            parts.append(field.flat())
            at = field.offset + field.size
        packer = struct.Struct("".join(parts))
        self.size = packer.size
        self.pack = packer.pack
        self.pack_into = packer.pack_into
        self.unpack_from = packer.unpack_from
        record: Any = namedtuple("record", [field.name for field in fields])  # type: ignore[misc]
        self._make = record._make

    def read(self, source: bytearray, start: int = 0) -> Any:
        """The fields by name, of the structure that begins at ``start``; only for spans of plain numbers."""
        return self._make(self.unpack_from(source, start + self.offset))


class Copy:
    """Copies a member of one message to a member of another, byte for byte; both have the same layout."""

    def __init__(self, source: type[Struct], from_path: str, target: type[Struct], to_path: str) -> None:
        from_field, from_at = source.field(from_path)
        to_field, to_at = target.field(to_path)
        assert from_field.flat() == to_field.flat(), (from_path, to_path)
        self._source = slice(from_at, from_at + from_field.size)
        self._target = slice(to_at, to_at + to_field.size)

    def __call__(self, source: bytearray, target: bytearray) -> None:
        target[self._target] = source[self._source]
