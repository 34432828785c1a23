"""XDR straight from the image of a message: the order of its bytes is worked out once for each class.

All that XDR does to the fields of a message is to move bytes (``nml.codecs.xdr`` says which), so a status of several
hundred fields is encoded by one compiled loop. Used by ``forms`` where the server encodes.
"""

from __future__ import annotations

from array import array
from functools import cache

from nml.codecs import xdr
from nml.errors import DecodeError, EncodeError
from nml.message import Message, registry
from nml.net._gather import gather

_ONE_BYTE = "?B"


@cache
def _order(cls: type[Message], preamble: bool) -> tuple[array[int], bytes]:
    """For each byte on the wire its place in the image, or -1 where the second value has it."""
    places: list[int] = []
    plan = xdr.plan_of(cls, preamble)
    for leaf in plan.leaves:
        if leaf.text:
            places += [-1] * 4
            sent = min(leaf.size, leaf.text)
            places += [leaf.offset + number if number < sent else -1 for number in range(leaf.text + -leaf.text % 4)]
            continue
        stride = leaf.size // leaf.values
        for start in range(leaf.offset, leaf.offset + leaf.size, stride):
            significant = 1 if leaf.wire[-1] in _ONE_BYTE else 8 if leaf.wire[-1] == "d" else 4
            places += [-1] * (-significant % 4)
            places += range(start + significant - 1, start - 1, -1)
    fixed = bytearray(len(places))
    for position, count in plan.counts:
        fixed[position : position + 4] = count.to_bytes(4, "big")
    return array("i", places), bytes(fixed)


def encode(image: bytearray, preamble: bool) -> bytes:
    """The encoded message of which ``image`` is the image. DecodeError if it is none."""
    type_id = int.from_bytes(image[:4], "little", signed=True)
    cls = registry.get(type_id)
    if cls is None:
        raise DecodeError(f"unknown message type {type_id} ({len(image)} bytes)")
    places, fixed = _order(cls, preamble)
    try:
        return gather(image, places, fixed)
    except ValueError as error:
        raise EncodeError(f"{cls.__name__}: {error}") from None
