"""Fast ways into messages: several neighbouring fields packed or unpacked by one ``struct`` call."""

from __future__ import annotations

import struct

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
