"""Encodings of messages, each derived from the one declaration: bytes in, bytes out, no channel and no process.

Every codec has ``encode(message, preamble=True) -> bytes`` and ``decode(data, preamble=True) -> Message``. A message is
header, preamble and body; whether the preamble is there depends on the channel (emcError carries none). Wire forms are
what LinuxCNC 2.9 sends. ``decode`` raises DecodeError, and nothing else, for what no encoder can have written.
"""

from __future__ import annotations

import importlib
from typing import Protocol, cast

from nml.fields import Field
from nml.message import Message


class Codec(Protocol):
    """What every module of this package offers."""

    def encode(self, message: Message, preamble: bool = True) -> bytes:
        """The message as bytes."""

    def decode(self, data: bytes | bytearray | memoryview, preamble: bool = True) -> Message:
        """The message in ``data``."""


def encoded_fields(cls: type[Message], preamble: bool, extended: bool = False) -> tuple[Field, ...]:
    """The fields of a message in the order of the wire; ``extended``: local ones too, in memory order."""
    head = tuple(f for f in cls.FIELDS if f.part == "header" or (preamble and f.part == "preamble"))
    return head + (cls.BODY if extended else cls.WIRE)


_MODULES = {"raw": "raw", "xdr": "xdr", "ascii": "ascii", "disp": "disp", "msgpack": "packed"}


def codec(name: str) -> Codec:
    """The codec that an NML file calls ``name``; 'raw' is the C layout."""
    return cast(Codec, importlib.import_module(f"nml.codecs.{_MODULES[name]}"))
