"""Every message type through every codec: what goes in comes out; garbage is accepted or refused, never a third."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

import nml.emc
import nml.emc.emcmot
from nml.codecs import codec, encoded_fields, xdr
from nml.errors import DecodeError, EncodeError
from nml.fields import (
    BOOL,
    DOUBLE,
    FLOAT,
    INT,
    LONG,
    UCHAR,
    UINT,
    ULONG,
    ArrayField,
    CharField,
    Field,
    Scalar,
    StructArrayField,
    StructField,
)
from nml.message import Message, registry

TYPES = [cls for _, cls in sorted(registry.items()) if cls.__module__.startswith(nml.emc.__name__)]
NUMBERS = {
    BOOL: st.booleans(),
    UCHAR: st.integers(0, 255),
    INT: st.integers(-(2**31), 2**31 - 1),
    UINT: st.integers(0, 2**32 - 1),
    LONG: st.integers(0, 2**32 - 1),
    ULONG: st.integers(0, 2**32 - 1),
    FLOAT: st.floats(width=32, allow_nan=False),
    DOUBLE: st.floats(allow_nan=False),
}
SMALL = {
    INT: st.integers(-99999, 999999),
    UINT: st.integers(0, 999999),
    LONG: st.integers(0, 10**13),
    ULONG: st.integers(0, 10**13),
    FLOAT: st.integers(-9999, 9999).map(float),
    DOUBLE: st.integers(-9999, 9999).map(float),
}
TEXT = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=8)
RELAXED = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])


def fill(draw: st.DrawFn, view: Any, fields: tuple[Field, ...], numbers: dict) -> None:
    """Give a few fields random values; all of them would be slow for the status messages."""
    for field in draw(st.lists(st.sampled_from(fields), max_size=6, unique_by=id)) if fields else []:
        match field:
            case Scalar():
                field.assign(view, draw(numbers[field.type]))
            case ArrayField():
                at = draw(st.integers(0, field.length - 1))
                field.__get__(view)[at] = draw(numbers[field.type])
            case CharField():
                text = draw(TEXT)
                if len(text.encode()) < field.length:
                    field.assign(view, text)
            case StructField():
                fill(draw, field.__get__(view), sent(field), numbers)
            case StructArrayField():
                at = draw(st.integers(0, field.length - 1))
                fill(draw, field.__get__(view)[at], sent(field), numbers)


def sent(field: StructField | StructArrayField) -> tuple[Field, ...]:
    return field.struct.WIRE


@st.composite
def messages(draw: st.DrawFn, numbers: dict = NUMBERS) -> Message:
    cls = draw(st.sampled_from(TYPES))
    message = cls()
    fill(draw, message, encoded_fields(cls, preamble=True)[2:], numbers)
    return message


@RELAXED
@given(messages())
def test_raw_and_msgpack_keep_every_bit(message: Message):
    for name in ("raw", "msgpack"):
        assert codec(name).decode(codec(name).encode(message)) == message


@RELAXED
@given(messages(), st.binary(max_size=4))
def test_xdr_keeps_every_field_that_it_sends(message: Message, tail: bytes):
    encoded = xdr.encode(message)
    assert len(encoded) == xdr.size_of(type(message))
    assert xdr.decode(encoded + tail) == message


@RELAXED
@given(messages(NUMBERS | SMALL))
def test_the_text_forms_keep_what_they_have_room_for(message: Message):
    for name in ("ascii", "disp"):
        assert codec(name).decode(codec(name).encode(message)) == message


@given(st.integers(-(2**31), 2**31 - 1))
def test_ascii_refuses_an_integer_that_it_would_cut(number: int):
    message = nml.emc.EMC_SET_DEBUG(debug=number)
    if len(str(number)) <= 7:
        assert codec("ascii").decode(codec("ascii").encode(message)) == message
    else:
        with pytest.raises(EncodeError, match=r"EMC_SET_DEBUG\.debug: \S+ has more than 7 digits"):
            codec("ascii").encode(message)


@RELAXED
@given(messages(NUMBERS | SMALL), st.sampled_from(["xdr", "ascii", "disp", "msgpack", "raw"]), st.data())
def test_a_truncated_message_is_refused(message: Message, name: str, data: st.DataObject):
    encoded = codec(name).encode(message)
    end = len(encoded.rstrip(b"\0")) if name == "ascii" else len(encoded)
    cut = data.draw(st.integers(0, max(0, end - 1)))
    with pytest.raises(DecodeError):
        codec(name).decode(encoded[:cut])


@RELAXED
@given(messages(NUMBERS | SMALL), st.sampled_from(["xdr", "ascii", "disp", "msgpack", "raw"]), st.data())
def test_damaged_bytes_are_a_message_or_a_decode_error(message: Message, name: str, data: st.DataObject):
    encoded = bytearray(codec(name).encode(message))
    assume(encoded)
    for _ in range(data.draw(st.integers(1, 4))):
        encoded[data.draw(st.integers(0, len(encoded) - 1))] = data.draw(st.integers(0, 255))
    try:
        decoded = codec(name).decode(bytes(encoded))
    except DecodeError:
        return
    assert isinstance(decoded, Message)


@RELAXED
@given(st.binary(max_size=300), st.sampled_from(["xdr", "ascii", "disp", "msgpack", "raw"]))
def test_garbage_is_a_message_or_a_decode_error(data: bytes, name: str):
    try:
        decoded = codec(name).decode(data)
    except DecodeError:
        return
    assert isinstance(decoded, Message)
