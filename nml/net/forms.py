"""How a message travels: in the encoding of its buffer's line, as native image between our own ends, or as text.

A form turns the image of a message (its bytes in a buffer) into the body of a reply, and the body of a write into a
message. Operator messages on emcError travel without the preamble of their class, as LinuxCNC's clients expect.
"""

from __future__ import annotations

import functools
import zlib
from enum import IntEnum
from typing import Protocol

import nml.emc.emcmot
from nml.codecs import Codec, codec
from nml.config import BufferLine, Encoding
from nml.errors import DecodeError
from nml.message import Message, decode, registry
from nml.net import xdr_images

BARE_BUFFERS = frozenset({"emcError", "emcOrders", "emcResults"})
"""Buffers whose messages are encoded without a preamble."""


class Form(Protocol):
    """One way of putting messages on the wire. Raises EncodeError or DecodeError and nothing else."""

    def encode(self, image: bytearray) -> bytes: ...

    def decode(self, body: bytes) -> Message: ...


class Native:
    """The image itself. A message that is longer than its class keeps no more than the class."""

    def encode(self, image: bytearray) -> bytes:
        return bytes(image)

    def decode(self, body: bytes) -> Message:
        message = decode(bytearray(body))
        if len(body) != message.SIZE:
            raise DecodeError(f"{type(message).__name__} has {message.SIZE} bytes, here are {len(body)}")
        message.nml_size = message.SIZE
        return message


@functools.cache
def vocabulary_checksum() -> int:
    """A number that two programs share exactly if every message has the same layout in both."""
    ours = [cls for cls in registry.values() if cls.__module__.startswith(nml.emc.__name__ + ".")]
    lines = sorted(f"{cls.TYPE_ID} {cls.__name__} {cls.FLAT.format}" for cls in ours)
    return zlib.crc32("\n".join(lines).encode())


class Encoded:
    """A codec of ``nml.codecs``, with or without the preamble as the buffer wants it."""

    def __init__(self, codec: Codec, preamble: bool) -> None:
        self._codec = codec
        self._preamble = preamble

    def encode(self, image: bytearray) -> bytes:
        return self._codec.encode(decode(image), self._preamble)

    def decode(self, body: bytes) -> Message:
        return self._codec.decode(body, self._preamble)


class Xdr(Encoded):
    """XDR, encoded from the image without a look at its fields."""

    def encode(self, image: bytearray) -> bytes:
        return xdr_images.encode(image, self._preamble)


class Kind(IntEnum):
    """How a client takes messages; an integer, because it is looked up for every request."""

    CODED = 0
    """In the encoding of the buffer's line, as stock programs do."""
    NATIVE = 1
    """As images of memory, once two of our own ends know that they agree."""
    TEXT = 2
    """As text that a person reads and types."""


def form(kind: Kind, line: BufferLine) -> Form:
    """How messages of a buffer travel to such a client. ``ascii`` means XDR on the network, as in LinuxCNC."""
    if kind is Kind.NATIVE:
        return Native()
    encoding = Encoding.XDR if line.encoding is Encoding.ASCII else line.encoding
    if kind is Kind.TEXT:
        encoding = Encoding.DISP
    make = Xdr if encoding is Encoding.XDR else Encoded
    return make(codec(encoding.value), line.name not in BARE_BUFFERS)
