"""The client's end of TCP and STCP: connections that are made again when they are lost, at most once a second.

A command whose confirmation is lost with the connection is never sent twice; whoever gave it learns that by an error.
"""

from __future__ import annotations

import re
import select
import socket
import struct
from abc import abstractmethod

from nml.clock import host_now
from nml.config import BufferLine, ProcessLine
from nml.errors import ChannelTimeout
from nml.net import wire
from nml.net.forms import Kind, form
from nml.net.links import Answer, BinaryLink, Link, LinkDown, Words
from nml.net.passwords import plain_credentials
from nml.net.wire import LONGEST_LINE, Access, CmsStatus, Request, Subscription

RETRY_PERIOD = 1.0
"""s between attempts to connect again; in between a link fails at once."""


class StreamLink(Link):
    """A link over a connection, made again when it is lost."""

    def __init__(self, line: BufferLine, process: ProcessLine, port: int) -> None:
        super().__init__(line, process)
        self._address = (line.host, port)
        self._sock: socket.socket | None = None
        self._timeouts = 0
        self._retry_at = 0.0
        self._reason = ""
        """Why there is no connection."""
        self.connections = 0
        """How many there were so far."""
        self._connect()

    @property
    def where(self) -> str:
        return f"{self.line.name} at {self._address[0]}:{self._address[1]}"

    @abstractmethod
    def greet(self) -> None:
        """What to say first on a new connection. Raises what says why it is of no use."""

    def _connect(self) -> socket.socket:
        """The open connection, made anew if need be."""
        if self._sock is not None:
            return self._sock
        if self.connections and not self.process.reconnect:
            raise LinkDown(f"{self.where}: {self._reason}; the process line has noreconnect")
        if host_now() < self._retry_at:
            raise LinkDown(f"{self.where}: {self._reason}")
        try:
            sock = socket.create_connection(self._address, self.timeout)
        except OSError as error:
            self._retry_at = host_now() + RETRY_PERIOD
            raise self._lost(f"cannot connect: {error.strerror or error}") from None
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._sock = sock
        try:
            self.greet()
        except BaseException:
            self._retry_at = host_now() + RETRY_PERIOD
            self.close()
            raise
        self.connections += 1
        return sock

    def _lost(self, reason: str) -> LinkDown:
        """Close what is left of the connection; the error to raise."""
        self.close()
        self._reason = reason
        return LinkDown(f"{self.where}: {reason}")

    def _fresh(self) -> None:
        """Make sure that the server has not closed the connection meanwhile."""
        if self._sock is not None and self.has_input:
            self.close()
        self._connect()

    @property
    def connected(self) -> bool:
        """Whether there is a connection now."""
        return self._sock is not None

    @property
    def has_input(self) -> bool:
        """Whether something came from the server that was not received yet; also the end of the connection."""
        return self._sock is not None and bool(select.select([self._sock], [], [], 0.0)[0])

    def close(self) -> None:
        if self._sock is not None:
            self._sock.close()
            self._sock = None

    def send_bytes(self, data: bytes) -> None:
        """Send all of ``data``."""
        sock = self._connect()
        try:
            sock.sendall(data)
        except TimeoutError:
            raise self._too_late() from None
        except OSError as error:
            raise self._lost(f"connection lost: {error.strerror or error}") from None

    def receive_bytes(self, size: int) -> bytes:
        """Some bytes, at most ``size``."""
        assert self._sock is not None
        try:
            data = self._sock.recv(size)
        except TimeoutError:
            raise self._too_late() from None
        except OSError as error:
            raise self._lost(f"connection lost: {error.strerror or error}") from None
        if not data:
            raise self._lost("the server has closed the connection")
        self._timeouts = 0
        return data

    def _too_late(self) -> ChannelTimeout:
        """The error for a timeout. The connection is given up: the answer could still come and be taken for another."""
        self._timeouts += 1
        self._lost(f"no answer within {self.process.timeout} s")
        if self.process.max_timeouts is not None and self._timeouts >= self.process.max_timeouts:
            self._retry_at = float("inf")
            self._reason = f"{self._timeouts} timeouts, max_timeouts={self.process.max_timeouts}"
        return self.late("a request")


class TcpLink(StreamLink, BinaryLink):
    """The requests of ``wire`` over TCP."""

    _serial = 0

    def __init__(self, line: BufferLine, process: ProcessLine) -> None:
        assert line.tcp is not None
        super().__init__(line, process, line.tcp)

    def greet(self) -> None:
        self._serial = 0
        self.introduce()

    def send(self, kind: Request, word3: int, word4: int, extra: bytes) -> None:
        """Send a request; a reply is still to come."""
        self._connect()
        request = wire.REQUEST.pack(self._serial, kind, self.line.number, word3 & wire.MASK, word4 & wire.MASK)
        self._serial = (self._serial + 1) & wire.MASK
        self.send_bytes(request + extra)

    def _receive(self, size: int) -> bytes:
        """Exactly ``size`` bytes."""
        data = self.receive_bytes(size) if size else b""
        while len(data) < size:
            data += self.receive_bytes(size - len(data))
        return data

    def receive_reply(self, kind: Request, reply: struct.Struct) -> tuple[Words, bytes]:
        """The next reply, which must be the one to the last request."""
        words = reply.unpack(self._receive(reply.size))
        if kind is not Request.WRITE and words[0] != self._serial:
            raise self._lost(f"reply {words[0]} came where {self._serial} was due")
        if reply is not wire.READ_REPLY:
            return words, b""
        if words[2] > wire.BODY_FACTOR * self.line.size:
            raise self._lost(f"a message of {words[2]} bytes came, the buffer has {self.line.size}")
        return words, self._receive(words[2])

    def receive_push(self) -> Answer:
        """A message that the server sent by itself."""
        self._serial = (self._serial + 1) & wire.MASK
        (_, status, _, message_id, was_read), body = self.receive_reply(Request.READ, wire.READ_REPLY)
        return status, message_id, was_read, body

    def converse(
        self, kind: Request, word3: int = 0, word4: int = 0, extra: bytes = b"", *, reply: struct.Struct
    ) -> tuple[Words, bytes]:
        self.send(kind, word3, word4, extra)
        return self.receive_reply(kind, reply)

    def exchange(
        self, kind: Request, word3: int = 0, word4: int = 0, extra: bytes = b"", *, reply: struct.Struct
    ) -> tuple[Words, bytes]:
        if kind is Request.WRITE:
            self._fresh()
        elif self._sock is not None:
            try:
                return self.converse(kind, word3, word4, extra, reply=reply)
            except LinkDown:
                self._connect()
        return self.converse(kind, word3, word4, extra, reply=reply)

    def post(self, kind: Request, word3: int, word4: int, extra: bytes) -> None:
        self._fresh()
        self.send(kind, word3, word4, extra)


class PushLink(Link):
    """A link that never waits for a message: one connection for messages, another one for everything else."""

    def __init__(self, line: BufferLine, process: ProcessLine) -> None:
        super().__init__(line, process)
        self.messages = TcpLink(line, process)
        self.form = self.messages.form
        self._others: TcpLink | None = None

    @property
    def where(self) -> str:
        return self.messages.where

    @property
    def others(self) -> TcpLink:
        """The second connection, made when it is needed."""
        if self._others is None:
            self._others = TcpLink(self.line, self.process)
        return self._others

    def store(self, body: bytes, only_if_read: bool) -> tuple[int, int]:
        return self.others.store(body, only_if_read)

    def ask(self, question: Request) -> tuple[int, int]:
        return self.others.ask(question)

    def clear(self) -> int:
        return self.others.clear()

    def close(self) -> None:
        self.messages.close()
        if self._others is not None:
            self._others.close()


class PolledLink(PushLink):
    """POLL in the process line: a read takes the answer to the one before, and asks for the next."""

    _asked = 0
    """The connection on which an answer is due, as ``TcpLink.connections`` counts them."""

    def fetch(self, consume: bool, last: int) -> Answer:
        link = self.messages
        if self._asked != link.connections or not link.connected:
            link.send(Request.READ, Access.READ if consume else Access.PEEK, last, b"")
            self._asked = link.connections
        if not link.has_input:
            return CmsStatus.READ_OLD, last, 1, b""
        self._asked = 0
        (_, status, _, message_id, was_read), body = link.receive_reply(Request.READ, wire.READ_REPLY)
        self.form = link.form
        return status, message_id, was_read, body


class SubscribedLink(PushLink):
    """sub= in the process line: the server sends messages by itself, and a read takes what has come."""

    _subscribed = 0

    def __init__(self, line: BufferLine, process: ProcessLine) -> None:
        super().__init__(line, process)
        self._mode, self._interval_ms = Subscription.VARIABLE, 0
        if process.subscription != "var":
            self._mode, self._interval_ms = Subscription.POLLED, round(float(process.subscription) * 1000.0)

    def fetch(self, consume: bool, last: int) -> Answer:
        link = self.messages
        if self._subscribed != link.connections or not link.connected:
            link.exchange(Request.SUBSCRIBE, self._mode, self._interval_ms, reply=wire.STATUS_REPLY)
            self._subscribed = link.connections
            self.form = link.form
        answer = (int(CmsStatus.READ_OLD), last, 1, b"")
        while link.has_input:
            answer = link.receive_push()
            if self.line.queue:
                break
        return answer


class TextLink(StreamLink):
    """The questions of ``stcp`` as lines of text."""

    def __init__(self, line: BufferLine, process: ProcessLine) -> None:
        assert line.stcp is not None
        self._inbox = bytearray()
        super().__init__(line, process, line.stcp)

    def greet(self) -> None:
        self._inbox.clear()
        self.form = form(Kind.TEXT, self.line)
        _, name = self._converse("name")
        if name.decode("utf-8", "replace") != self.line.name:
            raise LinkDown(f"{self.line.place}: {self.where}: buffer number {self.line.number} is {name!r} there")
        if self.process.passwd is not None:
            self._converse("login", text=plain_credentials(self.process.place, self.process.passwd))

    def _converse(self, verb: str, last: int | None = None, text: bytes = b"") -> tuple[int, bytes]:
        """Ask, and give the number and the text of the answer; ``Refused`` with the status of an error."""
        number = self.line.number if last is None else f"{self.line.number},{last}"
        self.send_bytes(f"{verb}({number}):".encode() + text + b"\n")
        line = self._line()
        match = _REPLY.fullmatch(line)
        if match is None:
            raise Refused(self.where, line)
        return int(match[1] or 0), match[2]

    def _line(self) -> bytes:
        while b"\n" not in self._inbox:
            if len(self._inbox) > LONGEST_LINE:
                raise self._lost("the server sends a line without end")
            self._inbox += self.receive_bytes(_CHUNK)
        line, _, rest = self._inbox.partition(b"\n")
        self._inbox = rest
        return bytes(line.rstrip(b"\r"))

    def _again(self, verb: str, last: int | None = None) -> tuple[int, bytes]:
        """Ask something that may be asked twice, over a new connection where the old one is gone."""
        if self.connected:
            try:
                return self._converse(verb, last)
            except Refused:
                raise
            except LinkDown:
                self._connect()
        return self._converse(verb, last)

    def fetch(self, consume: bool, last: int) -> Answer:
        try:
            number, text = self._again("read" if consume else "peek", last)
        except Refused as refused:
            return refused.status, last, 1, b""
        return (CmsStatus.READ_OK if text else CmsStatus.READ_OLD), number, int(consume), text

    def store(self, body: bytes, only_if_read: bool) -> tuple[int, int]:
        self._fresh()
        try:
            number, _ = self._converse("write_if_read" if only_if_read else "write", text=body)
        except Refused as refused:
            return 0, refused.status
        return number, CmsStatus.WRITE_OK

    def ask(self, question: Request) -> tuple[int, int]:
        try:
            _, text = self._again(_QUESTIONS[question])
        except Refused as refused:
            return refused.status, 0
        return CmsStatus.NOT_SET, int(text)

    def clear(self) -> int:
        try:
            self._again("clear")
        except Refused as refused:
            return refused.status
        return CmsStatus.CLEARED


class Refused(LinkDown):
    """The server answered ``ERR:``."""

    def __init__(self, where: str, line: bytes) -> None:
        super().__init__(f"{where}: {line.decode('utf-8', 'replace')}")
        match = _STATUS.search(line)
        self.status = int(match[1]) if match else int(CmsStatus.MISC_ERROR)


_CHUNK = 65536
_REPLY = re.compile(rb"\w+\(\d+(?:,(\d+))?\):(.*)", re.DOTALL)
_STATUS = re.compile(rb"\((-?\d+)\)$")
_QUESTIONS = {
    Request.CHECK_IF_READ: "check_if_read",
    Request.MESSAGE_COUNT: "message_count",
    Request.QUEUE_LENGTH: "queue_length",
    Request.SPACE: "space",
}
