"""The client's end of a link to one buffer of a server, whatever carries it; ``remote`` makes a channel of it.

A link offers ``fetch``, ``store``, ``ask`` and ``clear`` in the words of ``wire``. It connects again by itself when the
connection is lost, unless its process line says ``noreconnect``; meanwhile it raises ``LinkDown``. The kinds of links:
``stream_links`` (TCP, STCP) and ``packet_links`` (UDP, serial lines).
"""

from __future__ import annotations

import struct
from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any

from nml.config import BufferLine, ProcessLine
from nml.errors import BufferError_, ChannelTimeout
from nml.net import wire
from nml.net.forms import Form, Kind, form, vocabulary_checksum
from nml.net.passwords import credentials, proof
from nml.net.wire import Access, CmsStatus, Request

Answer = tuple[int, int, int, bytes]
Words = tuple[Any, ...]


class LinkDown(BufferError_):
    """There is no connection to the server, and why."""


class Link(ABC):
    """One buffer of a server."""

    def __init__(self, line: BufferLine, process: ProcessLine) -> None:
        self.line = line
        self.process = process
        self.form: Form = form(Kind.CODED, line)
        """How messages travel; settled when the connection is made."""

    @property
    def timeout(self) -> float | None:
        """s for each answer; None: for ever."""
        return None if self.process.timeout < 0.0 else max(self.process.timeout, 1e-3)

    @abstractmethod
    def fetch(self, consume: bool, last: int) -> Answer:
        """status, id, was_read and body of a message newer than ``last``."""

    @abstractmethod
    def store(self, body: bytes, only_if_read: bool) -> tuple[int, int]:
        """Write a message: its id and the status."""

    @abstractmethod
    def ask(self, question: Request) -> tuple[int, int]:
        """Status and answer to CHECK_IF_READ, MESSAGE_COUNT, QUEUE_LENGTH or SPACE."""

    @abstractmethod
    def clear(self) -> int:
        """Empty the buffer: the status."""

    @abstractmethod
    def close(self) -> None: ...

    def late(self, what: str) -> ChannelTimeout:
        """The error for a server that does not answer."""
        seconds = self.process.timeout
        return ChannelTimeout(f"{self.process.place}: {self.where}: no answer to {what} within {seconds} s")

    @property
    @abstractmethod
    def where(self) -> str:
        """The other end, for error texts."""


class BinaryLink(Link):
    """A link that sends the requests of ``wire``; ``exchange`` is what differs between kinds of them."""

    @abstractmethod
    def converse(
        self, kind: Request, word3: int = 0, word4: int = 0, extra: bytes = b"", *, reply: struct.Struct
    ) -> tuple[Words, bytes]:
        """Words of the reply to a request, and the body of the reply to a read."""

    def exchange(
        self, kind: Request, word3: int = 0, word4: int = 0, extra: bytes = b"", *, reply: struct.Struct
    ) -> tuple[Words, bytes]:
        """As ``converse``, over a new connection where the old one is gone."""
        return self.converse(kind, word3, word4, extra, reply=reply)

    @abstractmethod
    def post(self, kind: Request, word3: int, word4: int, extra: bytes) -> None:
        """Send a request that gets no reply."""

    def fetch(self, consume: bool, last: int) -> Answer:
        access = Access.READ if consume else Access.PEEK
        (_, status, _, message_id, was_read), body = self.exchange(Request.READ, access, last, reply=wire.READ_REPLY)
        return status, message_id, was_read, body

    def store(self, body: bytes, only_if_read: bool) -> tuple[int, int]:
        access = Access.WRITE_IF_READ if only_if_read else Access.WRITE
        if self.line.confirm_write:
            words, _ = self.exchange(Request.WRITE, access, len(body), body, reply=wire.SHORT_REPLY)
            return words[0], words[1]
        self.post(Request.WRITE, access, len(body), body)
        return self.ask(Request.MESSAGE_COUNT)[1], CmsStatus.WRITE_OK

    def ask(self, question: Request) -> tuple[int, int]:
        words, _ = self.exchange(question, reply=wire.SHORT_REPLY)
        return words[1], words[2]

    def clear(self) -> int:
        words, _ = self.exchange(Request.CLEAR, reply=wire.STATUS_REPLY)
        return int(words[1])

    def introduce(self) -> None:
        """Check the buffer's name, find out whether the server knows native images, and log in where asked to."""
        (_, status, field), _ = self.converse(
            Request.GET_NAME, wire.EXTENDED_MAGIC, vocabulary_checksum(), reply=wire.NAME_REPLY
        )
        name = field.partition(b"\0")[0].decode("utf-8", "replace")
        if status < 0 or name != self.line.name[: wire.NAME_LENGTH]:
            found = f"is {name!r} there" if status >= 0 else CmsStatus.describe(status)
            raise LinkDown(f"{self.line.place}: {self.where}: buffer number {self.line.number}: {found}")
        kind = Kind.NATIVE if field.endswith(wire.EXTENDED_MARK) else Kind.CODED
        self.form = form(kind, self.line)
        if self.process.passwd is not None:
            self._log_in(self.process.place.file, self.process.passwd)

    def _log_in(self, nml_file: str, passwd: str) -> None:
        user, key = credentials(Path(nml_file).parent / passwd)
        (_, first, second), _ = self.converse(Request.GET_KEYS, extra=user.ljust(16, b"\0"), reply=wire.KEYS_REPLY)
        login = wire.LOGIN.pack(user, proof(key, first + second))
        (_, success), _ = self.converse(Request.LOGIN, extra=login, reply=wire.STATUS_REPLY)
        if not success:
            raise LinkDown(f"{self.process.place}: {self.where} does not accept user {user.decode()} of {passwd}")
