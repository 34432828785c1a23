"""XDR, what goes over the network: big endian, every item a multiple of four bytes, no names, no alignment.

Bytes are as LinuxCNC 2.9 sends them: single ``bool`` and ``unsigned char`` in 4 bytes, ``long`` as its low 32 bits (a
decoder zero-extends), text as a count and all bytes of the field, other arrays without a count.

For each class a plan is made once: one unpack of the native image and one pack of the wire form, however many fields.
"""

from __future__ import annotations

import struct as packing
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from operator import itemgetter
from typing import Any, NamedTuple

from nml.codecs import encoded_fields
from nml.errors import DecodeError
from nml.fields import ArrayField, CharField, Field, Scalar, StructArrayField, StructField
from nml.message import Message, Struct, registry

_NATIVE = {"q": "I4x", "Q": "I4x"}
"""Codes in memory where they differ from the declaration's: of a long only the low half travels."""
_WIRE = {"?": "3x?", "B": "3xB", "q": "I", "Q": "I"}
"""Codes on the wire where they differ."""
_HEADER = packing.Struct(">iI")
_COUNT = packing.Struct(">I")


class _Leaf(NamedTuple):
    """A number, an array of numbers or a text, at ``offset`` of the native image; ``text``: its length on the wire."""

    offset: int
    size: int
    native: str
    wire: str
    values: int
    name: str
    text: int = 0


@dataclass(frozen=True, slots=True)
class Plan:
    """How a class is encoded and decoded."""

    native: packing.Struct
    wire: packing.Struct
    to_wire: Callable[[tuple[Any, ...]], tuple[Any, ...]] | None
    """Puts values in memory order into wire order; None: it is the same."""
    to_native: Callable[[tuple[Any, ...]], tuple[Any, ...]] | None
    counts: tuple[tuple[int, int], ...]
    """Position and value of the count before every text."""
    kept: tuple[tuple[int, bytes], ...]
    """What a fresh message has where nothing is sent, if it is not zero: the headers of nested messages."""
    leaves: tuple[_Leaf, ...]
    texts: tuple[_Leaf, ...]


def encode(message: Message, preamble: bool = True, extended: bool = False) -> bytes:
    """The message as bytes; ``extended`` with the members that stock LinuxCNC does not send."""
    plan = plan_of(type(message), preamble, extended)
    values = plan.native.unpack_from(message._buf, message._at)
    data = bytearray(plan.wire.size)
    plan.wire.pack_into(data, 0, *(plan.to_wire(values) if plan.to_wire else values))
    for position, count in plan.counts:
        _COUNT.pack_into(data, position, count)
    return bytes(data)


def decode(data: bytes | bytearray | memoryview, preamble: bool = True, extended: bool = False) -> Message:
    """A new message; what was not sent has its default. Bytes behind the message are ignored."""
    if len(data) < _HEADER.size:
        raise DecodeError(f"{len(data)} bytes are no message, the header alone has {_HEADER.size}")
    type_id, _ = _HEADER.unpack_from(data)
    cls = registry.get(type_id)
    if cls is None:
        raise DecodeError(f"unknown message type {type_id} ({len(data)} bytes)")
    plan = plan_of(cls, preamble, extended)
    if len(data) < plan.wire.size or any(_COUNT.unpack_from(data, at)[0] != n for at, n in plan.counts):
        values = _read_with_short_texts(cls, plan, data)
    else:
        values = plan.wire.unpack_from(data)
    image = bytearray(plan.native.pack(*(plan.to_native(values) if plan.to_native else values)))
    for offset, kept in plan.kept:
        image[offset : offset + len(kept)] = kept
    _end_texts(plan, image)
    return cls.view(image)


def size_of(cls: type[Message], preamble: bool = True) -> int:
    """Encoded length of a message in bytes."""
    return plan_of(cls, preamble).wire.size


@cache
def plan_of(cls: type[Message], preamble: bool, extended: bool = False) -> Plan:
    """The plan of a class."""
    leaves = [leaf for field in encoded_fields(cls, preamble, extended) for leaf in _leaves(field, 0, extended)]
    by_offset = sorted(leaves, key=lambda leaf: leaf.offset)
    numbered, first = {}, 0
    for leaf in by_offset:
        numbered[leaf.offset] = range(first, first + leaf.values)
        first += leaf.values
    order = [number for leaf in leaves for number in numbered[leaf.offset]]
    same = order == sorted(order)
    wire = packing.Struct(">" + "".join(leaf.wire for leaf in leaves))
    return Plan(
        native=packing.Struct(_native_format(by_offset, cls.SIZE)),
        wire=wire,
        to_wire=None if same else itemgetter(*order),
        to_native=None if same else itemgetter(*(order.index(number) for number in range(len(order)))),
        counts=_counts(leaves),
        kept=_kept(cls, by_offset),
        leaves=tuple(leaves),
        texts=tuple(leaf for leaf in leaves if leaf.text),
    )


def _leaves(field: Field, base: int, extended: bool) -> list[_Leaf]:
    at = base + field.offset
    match field:
        case Scalar():
            code = field.type.code
            return [_Leaf(at, field.size, _NATIVE.get(code, code), _WIRE.get(code, code), 1, field.name)]
        case ArrayField():
            code, length = field.type.code, field.length
            native = _NATIVE[code] * length if code in _NATIVE else f"{length}{code}"
            wire = _WIRE[code] * length if code in _WIRE else f"{length}{code}"
            return [_Leaf(at, field.size, native, wire, length, field.name)]
        case CharField():
            wire = f"4x{field.wire}s{-field.wire % 4}x"
            return [_Leaf(at, field.size, f"{field.length}s", wire, 1, field.name, field.wire)]
        case StructField():
            return _struct_leaves(field.struct, at, extended)
        case StructArrayField():
            starts = range(at, at + field.size, field.stride)
            return [leaf for start in starts for leaf in _struct_leaves(field.struct, start, extended)]
    raise TypeError(f"no wire form for {field!r}")


def _struct_leaves(cls: type[Struct], base: int, extended: bool) -> list[_Leaf]:
    fields = cls.BODY if extended else cls.WIRE
    return [leaf for field in fields for leaf in _leaves(field, base, extended)]


def _native_format(leaves: list[_Leaf], size: int) -> str:
    parts, at = ["<"], 0
    for leaf in leaves:
        parts.append(f"{leaf.offset - at}x{leaf.native}")
        at = leaf.offset + leaf.size
    parts.append(f"{size - at}x")
    return "".join(parts)


def _counts(leaves: list[_Leaf]) -> tuple[tuple[int, int], ...]:
    found, at = [], 0
    for leaf in leaves:
        if leaf.text:
            found.append((at, leaf.text))
        at += packing.calcsize(">" + leaf.wire)
    return tuple(found)


def _kept(cls: type[Message], leaves: list[_Leaf]) -> tuple[tuple[int, bytes], ...]:
    kept, at = [], 0
    for start, size in [*((leaf.offset, leaf.size) for leaf in leaves), (cls.SIZE, 0)]:
        gap = cls.TEMPLATE[at:start]
        if any(gap):
            kept.append((at, gap))
        at = start + size
    return tuple(kept)


def _read_with_short_texts(cls: type[Message], plan: Plan, data: bytes | bytearray | memoryview) -> tuple[Any, ...]:
    """The values of a message whose texts may be shorter than their fields: a decoder takes a smaller count."""
    values: list[Any] = []
    at = 0
    try:
        for leaf in plan.leaves:
            if not leaf.text:
                values += packing.unpack_from(">" + leaf.wire, data, at)
                at += packing.calcsize(">" + leaf.wire)
                continue
            (count,) = _COUNT.unpack_from(data, at)
            if count > leaf.text:
                raise DecodeError(f"{cls.__name__}.{leaf.name}: {count} bytes of text, {leaf.text} fit")
            values += packing.unpack_from(f"{count}s", data, at + 4)
            at += 4 + count + -count % 4
    except packing.error:
        message = f"{cls.__name__}: {len(data)} bytes, too few for its {plan.wire.size}"
        raise DecodeError(message) from None
    return tuple(values)


def _end_texts(plan: Plan, image: bytearray) -> None:
    """Cut every text at its first zero byte, and end it where the sender did not."""
    for leaf in plan.texts:
        end = leaf.offset + leaf.size
        zero = image.find(0, leaf.offset, end - 1)
        start = end - 1 if zero < 0 else zero
        image[start:end] = bytes(end - start)
