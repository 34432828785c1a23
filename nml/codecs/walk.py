"""What the two text codecs share: walking a message item by item while writing or reading a stream."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from nml.codecs import encoded_fields
from nml.errors import DecodeError, EncodeError
from nml.fields import ArrayField, CharField, CType, Scalar
from nml.message import Message, Struct, registry


class Writer(ABC):
    """Collects the encoded items (a ``Cms``)."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []

    @abstractmethod
    def number(self, ctype: CType, value: Any) -> bytes:
        """One number, encoded; EncodeError if the form has no room for it."""

    @abstractmethod
    def string(self, raw: bytes, length: int) -> bytes:
        """The text of a field of ``length`` bytes, encoded."""

    def scalar(self, view: Struct, field: Scalar[Any]) -> None:
        self.parts.append(self._number(field, field.type, field.__get__(view)))

    def array(self, view: Struct, field: ArrayField[Any]) -> None:
        self.parts += [self._number(field, field.type, value) for value in field.__get__(view)]

    def text(self, view: Struct, field: CharField) -> None:
        raw = field.__get__(view).encode("utf-8", "surrogateescape")
        self.parts.append(self.string(raw, field.wire))

    def _number(self, field: Scalar[Any] | ArrayField[Any], ctype: CType, value: Any) -> bytes:
        try:
            return self.number(ctype, value)
        except EncodeError as error:
            raise EncodeError(f"{field.owner}.{field.name}: {error}") from None


class Reader(ABC):
    """Takes items from the data and puts them into the message (a ``Cms``)."""

    @abstractmethod
    def number(self, ctype: CType) -> Any:
        """The next item as a number; ValueError if it is none."""

    @abstractmethod
    def string(self, length: int) -> bytes:
        """The next item as a text for a field of ``length`` bytes."""

    def scalar(self, view: Struct, field: Scalar[Any]) -> None:
        field.assign(view, self.number(field.type))

    def array(self, view: Struct, field: ArrayField[Any]) -> None:
        field.assign(view, [self.number(field.type) for _ in range(field.length)])

    def text(self, view: Struct, field: CharField) -> None:
        raw = self.string(field.wire).partition(b"\0")[0]
        field.assign(view, raw[: field.length - 1])


def write(message: Message, writer: Writer, preamble: bool) -> bytes:
    """Walk ``message`` with ``writer`` and join what it wrote."""
    for field in encoded_fields(type(message), preamble):
        field.walk(message, writer)
    return b"".join(writer.parts)


def read(reader: Reader, type_id: int, preamble: bool) -> Message:
    """A new message of type ``type_id``, filled by ``reader``, which stands at the start of the header."""
    cls = registry.get(type_id)
    if cls is None:
        raise DecodeError(f"unknown message type {type_id}")
    message = cls()
    try:
        for field in encoded_fields(cls, preamble):
            field.walk(message, reader)
    except DecodeError:
        raise
    except (ValueError, OverflowError) as error:
        raise DecodeError(f"{cls.__name__}: {error}") from None
    return message
