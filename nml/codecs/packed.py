"""The ``msgpack`` encoding, our own: field names and values, all fields, also those that stock LinuxCNC does not send.

A message is ``[type number, preamble, body]`` with two maps. A name that the reader does not know is an error, a name
that is missing keeps its default.
"""

from __future__ import annotations

from typing import Any

import msgpack

from nml.errors import DecodeError, EncodeError
from nml.fields import ArrayField, Field, StructArrayField, StructField
from nml.message import Message, Struct, registry


def encode(message: Message, preamble: bool = True) -> bytes:
    """The message as bytes."""
    head = {f.name: f.plain(message) for f in message.FIELDS if f.part == "preamble"} if preamble else {}
    packed: bytes = msgpack.packb([message.TYPE_ID, head, message.to_dict()], unicode_errors="surrogateescape")
    return packed


def decode(data: bytes | bytearray | memoryview, preamble: bool = True) -> Message:
    """A new message."""
    try:
        content = msgpack.unpackb(bytes(data), unicode_errors="surrogateescape")
    except Exception as error:  # msgpack has no common root of what it raises for bad data
        raise DecodeError(f"no msgpack data: {error}") from None
    match content:
        case [int(type_id), dict(head), dict(body)]:
            cls = registry.get(type_id)
            if cls is None:
                raise DecodeError(f"unknown message type {type_id}")
        case _:
            raise DecodeError("msgpack data, but no message: [type, preamble, body] is expected")
    message = cls()
    preambles = tuple(field for field in cls.FIELDS if field.part == "preamble")
    if preamble:
        _fill(message, preambles, head)
    _fill(message, cls.BODY, body)
    return message


def _fill(view: Struct, fields: tuple[Field, ...], values: dict[Any, Any]) -> None:
    by_name = {field.name: field for field in fields}
    for name, value in values.items():
        field = by_name.get(name)
        if field is None:
            raise DecodeError(f"{type(view).__name__} has no field {name!r}")
        try:
            _put(view, field, value)
        except (EncodeError, TypeError, AttributeError) as error:
            raise DecodeError(f"{type(view).__name__}.{name}: {error}") from None


def _put(view: Struct, field: Field, value: Any) -> None:
    match field:
        case StructField():
            _fill(field.__get__(view), field.struct.BODY, value)
        case StructArrayField():
            elements = field.__get__(view)
            if len(value) != len(elements):
                raise DecodeError(f"{len(value)} elements, {len(elements)} are needed")
            for element, content in zip(elements, value, strict=True):
                _fill(element, field.struct.BODY, content)
        case ArrayField() if not isinstance(value, list):
            raise DecodeError(f"{value!r} is no array")
        case _:
            field.assign(view, value)
