"""The C layout itself: what lies in a buffer that is not neutral. Header and preamble are always there."""

from __future__ import annotations

from nml.message import Message
from nml.message import decode as view_of


def encode(message: Message, preamble: bool = True) -> bytes:
    """The message as bytes."""
    return bytes(message)


def decode(data: bytes | bytearray | memoryview, preamble: bool = True) -> Message:
    """A copy of the message in ``data``."""
    message = view_of(bytearray(data))
    return type(message).from_bytes(data)
