"""XDR straight from the image of a message: the order of its bytes is worked out once for each class.

All that XDR does to the fields of a message is to move bytes (``nml.codecs.xdr`` says which), and neighbours of one
kind move together, so a status of a thousand numbers is encoded in some 250 runs. Used by ``forms`` where the
server encodes.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from numpy.typing import NDArray

from nml.codecs import xdr
from nml.errors import DecodeError, EncodeError
from nml.message import Message, registry
from nml.net._gather import gather

_ONE_BYTE = "?B"
_WIDTHS = (8, 4, 1)


@cache
def _order(cls: type[Message], preamble: bool) -> tuple[NDArray[np.int32], bytes]:
    """The runs of ``gather`` for a class of messages, and the encoded message with what no run writes."""
    places, fixed = _places(cls, preamble)
    return np.array(list(_runs(places)), dtype=np.int32).reshape(-1, 4), fixed


def _runs(places: list[int]) -> Iterator[tuple[int, int, int, int]]:
    """Width of the elements, place on the wire, place in the image, number of elements."""
    at = 0
    while at < len(places):
        if places[at] < 0:
            at += 1
            continue
        width = next(width for width in _WIDTHS if _element(places, at, width) is not None)
        first = _element(places, at, width)
        assert first is not None
        count = 1
        while _element(places, at + width * count, width) == first + width * count:
            count += 1
        yield width, at, first, count
        at += width * count


def _element(places: list[int], at: int, width: int) -> int | None:
    """Where the element begins in the image that stands at ``at`` on the wire, its bytes turned round."""
    if at + width > len(places) or places[at] < 0:
        return None
    first = places[at] - width + 1
    turned = all(places[at + number] == places[at] - number for number in range(width))
    return first if turned else None


def _places(cls: type[Message], preamble: bool) -> tuple[list[int], bytes]:
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
    return places, bytes(fixed)


def encode(image: bytearray, preamble: bool) -> bytes:
    """The encoded message of which ``image`` is the image. DecodeError if it is none."""
    type_id = int.from_bytes(image[:4], "little", signed=True)
    cls = registry.get(type_id)
    if cls is None:
        raise DecodeError(f"unknown message type {type_id} ({len(image)} bytes)")
    runs, fixed = _order(cls, preamble)
    try:
        return gather(image, runs, fixed)
    except ValueError as error:
        raise EncodeError(f"{cls.__name__}: {error}") from None
