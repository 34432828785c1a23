"""The buffers that the server offers, each behind the same few operations for every kind of link.

``Shelf`` opens what the NML file's process lines tell the server to serve. A ``Desk`` is one client's place at it, and
a view one client's access to one buffer: to the newest message (encoded once per message, whoever asks), to a queue, or
to a broadcast queue, in which every client reads everything. Whatever can fail ends as a status code of ``wire``.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from nml import _shm
from nml._buffer import Buffer
from nml.channel import Channel
from nml.codecs import Codec, codec
from nml.config import ANY_BUFFER, BufferLine, NmlConfig, ProcessLine, ProcessType
from nml.emc import orders
from nml.errors import ChannelTimeout, ConfigError, DecodeError, EncodeError, NmlError, QueueFull, TooLong
from nml.message import Command, Message
from nml.net import diagnostics
from nml.net.forms import Form, Kind, form, vocabulary_checksum
from nml.net.passwords import PasswordFile
from nml.net.wire import BODY_FACTOR, MASK, CmsStatus, Request

LOCK_TIMEOUT = 0.05
"""s that a write waits for a process that holds the buffer; other clients wait with it."""
SAME_ID = 0x4000_0000
"""Set in the id of a queued message that a client would otherwise take for its last one."""

COMMAND_BUFFER = "emcCommand"
"""The buffer whose writers are noted in emcOrders."""

_Answer = tuple[int, int, int, bytes]


class ServedBuffer:
    """A buffer and what all clients share of it."""

    def __init__(self, line: BufferLine, process: ProcessLine, users: PasswordFile | None) -> None:
        self.line = line
        self.process = process
        self.users = users
        self.channel = Channel.connect(line, process)
        self.raw = self.channel.raw
        self._stored: Codec | None = codec(line.encoding.value) if line.neutral else None
        self._forms: dict[Kind, Form] = {}
        self.usages: list[diagnostics.Usage] = []
        self.number = 0
        """Write counter of the cached message."""
        self.id = 0
        """Its id on the wire; 0: there is none."""
        self._image = bytearray()
        self._bodies: dict[Kind, bytes] = {}

    def refresh(self) -> None:
        """Take the newest message of a single slot into the cache."""
        number = self.raw.write_counter
        image = self.raw.peek()
        if image is not None:
            self._image = self.image(image, self.raw.last)
            self.number = self.raw.last
            self.id = self.number & MASK
        else:
            self.number = number
            self.id = 0
        self._bodies = {}

    def image(self, data: bytearray, number: int) -> bytearray:
        """The native image of what lies in the buffer as message ``number``."""
        if self._stored is None:
            return data
        message = self._stored.decode(data)
        if self.line.serial and isinstance(message, Command):
            message.serial_number = number
        return bytearray(message.data)

    def write(self, raw: Buffer, message: Message, only_if_read: bool) -> int:
        """Put a message into the buffer: its number, 0 if the last one was not read."""
        if self._stored is not None:
            return raw.write(self._stored.encode(message), False, only_if_read)
        return raw.write(message.data, self.line.serial and isinstance(message, Command), only_if_read)

    def form(self, kind: Kind) -> Form:
        """How messages travel to clients of one kind."""
        if kind not in self._forms:
            self._forms[kind] = form(kind, self.line)
        return self._forms[kind]

    def body(self, kind: Kind) -> bytes:
        """The cached message as the client wants it, encoded on first use."""
        body = self._bodies.get(kind)
        if body is None:
            body = self._bodies[kind] = self.form(kind).encode(self._image)
        return body

    def close(self) -> None:
        self.channel.close()


class SlotView:
    """One client's access to a buffer that holds one message; the base of the other kinds."""

    def __init__(self, served: ServedBuffer, desk: Desk) -> None:
        self._served = served
        self._desk = desk
        self._kind = desk.kind
        self._readable = served.process.may_read
        self._guarded = served.users is not None
        self._raw = served.raw
        self._usage: diagnostics.Usage | None = None
        self._form = served.form(desk.kind)
        self.name = served.line.name
        self.confirm_write = served.line.confirm_write
        self.can_block = served.line.bsem not in (None, -1)
        self.largest_body = BODY_FACTOR * served.line.size

    @property
    def locked(self) -> bool:
        """Whether the client still has to log in."""
        return self._served.users is not None and self._served.users not in self._desk.logged_in

    @property
    def may_read(self) -> bool:
        return self._readable and not (self._guarded and self.locked)

    @property
    def may_write(self) -> bool:
        return self._served.process.may_write and not self.locked and self.name != orders.NOTE_BUFFER

    def fetch(self, consume: bool, last: int) -> _Answer:
        """status, id, was_read and encoded message for a client whose last message was ``last``."""
        if not self.may_read:
            return CmsStatus.PERMISSIONS_ERROR, last, 1, b""
        try:
            status, message_id, was_read, body = self._fetch(consume, last)
        except NmlError as error:
            return _status_of(error), last, 1, b""
        if self._usage is not None:
            self._usage.count(diagnostics.READ if consume else diagnostics.PEEK, message_id, len(body))
        return status, message_id, was_read, body

    def _fetch(self, consume: bool, last: int) -> _Answer:
        served = self._served
        if self._raw.write_counter != served.number:
            served.refresh()
        if consume:
            self._raw.mark_read()
        if served.id == last or not served.id:
            return CmsStatus.READ_OLD, last, 1, b""
        return CmsStatus.READ_OK, served.id, consume or self._raw.was_read(), served.body(self._kind)

    def store(self, body: bytes, only_if_read: bool) -> tuple[int, int]:
        """Write an encoded message: its id and the status."""
        if not self.may_write:
            return 0, CmsStatus.PERMISSIONS_ERROR
        raw = self._raw
        try:
            message = self._form.decode(body)
            number = self._served.write(raw, message, only_if_read)
        except NmlError as error:
            return raw.write_counter, _status_of(error)
        if not number:
            return raw.write_counter, CmsStatus.WRITE_WAS_BLOCKED
        if self._usage is not None:
            self._usage.count(diagnostics.WRITE, number, len(body))
        if self.name == COMMAND_BUFFER and isinstance(message, Command):
            self._desk.note(message, number)
        return number, CmsStatus.WRITE_OK

    def ask(self, question: int) -> tuple[int, int]:
        """Status and answer of a small question."""
        return CmsStatus.NOT_SET, _QUESTIONS[question](self._raw) & 0x7FFF_FFFF

    def clear(self) -> int:
        """Forget all messages, where the server's process line lets it write."""
        if not self.may_write:
            return CmsStatus.PERMISSIONS_ERROR
        try:
            self._raw.clear()
        except NmlError as error:
            return _status_of(error)
        return CmsStatus.CLEARED

    def log_in(self, user: bytes, password: bytes, challenge: bytes) -> bool:
        """Check a password; it holds for all buffers with the same file. True where none is needed."""
        users = self._served.users
        if users is None:
            return True
        if not users.accepts(user, password, challenge):
            return False
        self._desk.logged_in.add(users)
        return True

    def introduce(self, info: bytes) -> None:
        """Enter the client into the diagnostics of a buffer that keeps them."""
        if self._served.line.diag and self._usage is None:
            self._usage = diagnostics.introduced(info)
            self._served.usages.append(self._usage)

    def diagnostics(self, little_endian: bool) -> tuple[int, bytes]:
        """Status and report."""
        if not self._served.line.diag:
            return CmsStatus.SERVER_SIDE_ERROR, b""
        usages = diagnostics.local_usages(self._raw.diagnostics()) + self._served.usages
        return CmsStatus.NOT_SET, diagnostics.report(usages, little_endian)

    def close(self) -> None:
        """The client is gone."""
        if self._usage is not None:
            self._served.usages.remove(self._usage)


class QueueView(SlotView):
    """Access to a queue: the oldest message, which one reader takes and nobody else gets."""

    def _fetch(self, consume: bool, last: int) -> _Answer:
        image = self._raw.read() if consume else self._raw.peek()
        if image is None:
            return CmsStatus.READ_OLD, last, 1, b""
        message_id = self._raw.last & MASK
        if message_id in (last, 0):
            message_id ^= SAME_ID
        body = self._form.encode(self._served.image(image, self._raw.last))
        return CmsStatus.READ_OK, message_id, consume, body


class BroadcastView(QueueView):
    """Access to a queue in which every client has its own cursor, so that nobody takes anything from anybody."""

    def __init__(self, served: ServedBuffer, desk: Desk) -> None:
        super().__init__(served, desk)
        self._reader = served.channel.reader()
        self._raw = self._reader.raw

    def close(self) -> None:
        super().close()
        self._reader.close()


_VIEWS = {_shm.SLOT: SlotView, _shm.QUEUE: QueueView, _shm.BROADCAST: BroadcastView}
_QUESTIONS: Mapping[int, Callable[[Buffer], int]] = {
    Request.CHECK_IF_READ: lambda raw: int(raw.was_read()),
    Request.MESSAGE_COUNT: lambda raw: raw.write_counter,
    Request.QUEUE_LENGTH: lambda raw: raw.queue_length(),
    Request.SPACE: lambda raw: raw.space(),
}
_STATUS: tuple[tuple[type[NmlError], CmsStatus], ...] = (
    (QueueFull, CmsStatus.QUEUE_FULL),
    (TooLong, CmsStatus.INSUFFICIENT_SPACE_ERROR),
    (ChannelTimeout, CmsStatus.TIMED_OUT),
    (DecodeError, CmsStatus.UPDATE_ERROR),
    (EncodeError, CmsStatus.UPDATE_ERROR),
)


def _status_of(error: NmlError) -> int:
    for kind, status in _STATUS:
        if isinstance(error, kind):
            return status
    return CmsStatus.INTERNAL_ACCESS_ERROR


class Desk:
    """One client's place: which form of messages it takes, where it has logged in, which buffers it has open."""

    def __init__(self, buffers: Mapping[int, ServedBuffer], origin: str, notes: Channel | None) -> None:
        """``origin``: the client's address, for the ``notes`` about its commands."""
        self._buffers = buffers
        self._origin = origin
        self._notes = notes
        self._views: dict[int, SlotView] = {}
        self.kind = Kind.CODED
        self.logged_in: set[PasswordFile] = set()

    def view(self, number: int) -> SlotView | None:
        """The client's access to a buffer; None if the server does not have it."""
        view = self._views.get(number)
        if view is None:
            served = self._buffers.get(number)
            if served is None:
                return None
            view = self._views[number] = _VIEWS[served.raw.kind](served, self)
        return view

    def agree(self, checksum: int) -> bool:
        """Whether the client shares our vocabulary; then it gets native images from now on."""
        agreed = checksum == vocabulary_checksum()
        kind = Kind.NATIVE if agreed else Kind.CODED
        if kind is not self.kind:
            self.close()
            self.kind = kind
        return agreed

    def note(self, command: Command, serial: int) -> None:
        """Let those who watch know of a command that the client gave."""
        if self._notes is not None:
            with contextlib.suppress(NmlError):
                self._notes.write(orders.note(command, serial, self._origin))

    def close(self) -> None:
        """Let go of everything that the client had open."""
        for view in self._views.values():
            view.close()
        self._views.clear()


class Shelf:
    """Every buffer that one server process serves, by the link and the number under which clients know it."""

    def __init__(self, config: NmlConfig, process: str) -> None:
        self.links: dict[WireLink, dict[int, ServedBuffer]] = {}
        self._served: list[ServedBuffer] = []
        self._notes: Channel | None = None
        users: dict[Path, PasswordFile] = {}
        try:
            for line, process_line in served_lines(config, process):
                if line.subdivisions > 1:
                    raise ConfigError(f"buffer {line.name}: subdiv={line.subdivisions} is not served", line.place)
                patient = replace(process_line, timeout=LOCK_TIMEOUT)
                served = ServedBuffer(line, patient, _users(config, line, users))
                self._served.append(served)
                for link in links_of(line):
                    self._place(served, self.links.setdefault(link, {}), link)
                if line.name == orders.NOTE_BUFFER and process_line.may_write:
                    self._notes = served.channel
        except BaseException:
            self.close()
            raise

    @staticmethod
    def _place(served: ServedBuffer, buffers: dict[int, ServedBuffer], link: WireLink) -> None:
        number = served.line.number
        if number in buffers:
            other = buffers[number].line.name
            message = f"buffer {served.line.name} has number {number}, as {other} on {link.kind}={link.where}"
            raise ConfigError(message, served.line.place)
        buffers[number] = served

    def desk(self, link: WireLink, origin: str) -> Desk:
        """A place for a new client of a link, who comes from ``origin``."""
        return Desk(self.links[link], origin, self._notes)

    def close(self) -> None:
        """Let go of the buffers."""
        for served in self._served:
            served.close()


class WireLink(NamedTuple):
    """Where clients find buffers: an option of B lines and its value, a port or a device."""

    kind: str
    where: int | str


def links_of(line: BufferLine) -> list[WireLink]:
    """The links that a B line asks for."""
    wanted = (("TCP", line.tcp), ("STCP", line.stcp), ("UDP", line.udp), ("serialPortDevName", line.serial_port))
    return [WireLink(kind, where) for kind, where in wanted if where is not None]


def served_lines(config: NmlConfig, process: str) -> Iterator[tuple[BufferLine, ProcessLine]]:
    """The buffers that ``process`` serves: a local process line with the server flag, a link in the buffer's line."""
    own = {line.buffer: line for line in config.process_lines if line.process == process}
    for line in config.buffer_lines:
        process_line = own.get(line.name) or own.get(ANY_BUFFER)
        if process_line is None or not process_line.server or process_line.type is ProcessType.REMOTE:
            continue
        if links_of(line):
            yield line, process_line


def _users(config: NmlConfig, line: BufferLine, known: dict[Path, PasswordFile]) -> PasswordFile | None:
    if line.passwd is None:
        return None
    path = config.path.parent / line.passwd
    if path not in known:
        known[path] = PasswordFile(path)
    return known[path]
