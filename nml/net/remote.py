"""Channels to buffers elsewhere: what ``nml.channel.Channel`` becomes where the process line says REMOTE.

A ``RemoteBuffer`` offers what ``nml._buffer.Buffer`` offers, with a link instead of shared memory below, so that a
program does not see where a buffer is. Only waiting differs: nobody wakes a remote reader, so it looks again every few
milliseconds.
"""

from __future__ import annotations

import struct
import weakref

from nml import _shm
from nml.channel import Channel
from nml.clock import host_now, host_sleep
from nml.config import BufferLine, ProcessLine
from nml.errors import BufferError_, ChannelTimeout, ConfigError, DecodeError, EncodeError, NmlError, QueueFull
from nml.message import registry
from nml.net.forms import BARE_BUFFERS, Native
from nml.net.links import Link
from nml.net.packet_links import SerialLink, UdpLink
from nml.net.stream_links import PolledLink, SubscribedLink, TcpLink, TextLink
from nml.net.wire import CmsStatus, Request

LOOK_AGAIN = 0.005
"""s between looks of a reader that waits."""
NO_TEXT = "(the server did not send the text of this message)"
"""Text of an operator message from LinuxCNC's server, which cuts it off."""

_SERIAL_AT = 16
_SERIAL = struct.Struct("<i")
_HEADER = struct.Struct(">iI")
_ERRORS: dict[int, type[NmlError]] = {
    CmsStatus.QUEUE_FULL: QueueFull,
    CmsStatus.TIMED_OUT: ChannelTimeout,
    CmsStatus.INSUFFICIENT_SPACE_ERROR: EncodeError,
    CmsStatus.UPDATE_ERROR: EncodeError,
}


class RemoteBuffer:
    """A buffer on the other side of a link, in the terms of ``nml._buffer.Buffer``: images of messages, and numbers."""

    def __init__(self, link: Link) -> None:
        self.link = link
        self.name = link.line.name
        self.missed = 0
        self.closed = False
        self.last = 0
        """Id of the message that was read or peeked last."""
        self.last_time_ns = 0
        """When it was written: not known at this end."""

    # Messages

    def read(self) -> bytearray | None:
        """The next message, taken from a queue."""
        return self._take(True)

    def peek(self) -> bytearray | None:
        """The next message, left where it is."""
        return self._take(False)

    def poll_into(self, into: bytearray) -> bool:
        """Copy a new message over the start of ``into``; False if there is none."""
        image = self._take(False)
        if image is None:
            return False
        if len(image) > len(into):
            raise BufferError_(f"buffer {self.name}: the message has {len(image)} bytes, the reader {len(into)}")
        into[: len(image)] = image
        return True

    def _take(self, consume: bool) -> bytearray | None:
        self._check_open()
        queue = self.link.line.queue
        takes = consume and not (self.link.process.observer and self._shared)
        status, message_id, _, body = self.link.fetch(takes, 0 if queue else self.last)
        self._check(status, "read")
        if status != CmsStatus.READ_OK or (not queue and message_id == self.last):
            return None
        self.last = message_id
        return self._image(body)

    @property
    def _shared(self) -> bool:
        """Whether a read changes what others find: not in a broadcast queue of our own server."""
        return not (self.link.line.broadcast and isinstance(self.link.form, Native))

    def _image(self, body: bytes) -> bytearray:
        form = self.link.form
        if isinstance(form, Native):
            return bytearray(body)
        if self.name in BARE_BUFFERS and len(body) == _HEADER.size:
            return _without_text(body)
        return bytearray(form.decode(body).data)

    def write(self, data: bytearray, serial: bool = False, only_if_read: bool = False) -> int:
        """Write a message and return its number; 0 if ``only_if_read`` and the last one was not read yet."""
        self._check_open()
        number, status = self.link.store(self.link.form.encode(data), only_if_read)
        if status == CmsStatus.WRITE_WAS_BLOCKED:
            return 0
        self._check(status, "write")
        if serial:
            _SERIAL.pack_into(data, _SERIAL_AT, number)
        return number

    def mark_read(self) -> None:
        """Mark the message of a single slot as read."""
        self._check(self.link.fetch(True, self.last)[0], "read")

    # Questions

    @property
    def kind(self) -> int:
        return _shm.QUEUE if self.link.line.queue else _shm.SLOT

    @property
    def longest(self) -> int:
        return self.link.line.size

    @property
    def write_counter(self) -> int:
        """Messages ever written."""
        return self._ask(Request.MESSAGE_COUNT)

    def was_read(self) -> bool:
        """Whether the newest message was read."""
        return bool(self._ask(Request.CHECK_IF_READ))

    def queue_length(self) -> int:
        """Messages that wait; 0 for a single slot."""
        return self._ask(Request.QUEUE_LENGTH)

    def space(self) -> int:
        """Bytes of the longest message that could be written now."""
        return self._ask(Request.SPACE)

    def has_news(self) -> bool:
        """Whether ``read`` would return a message."""
        if self.link.line.queue:
            return self.queue_length() > 0
        return self.write_counter not in (0, self.last)

    def _ask(self, question: Request) -> int:
        self._check_open()
        status, value = self.link.ask(question)
        self._check(status, "ask about")
        return value

    def wait(self, seconds: float) -> bool:
        """Look until there is something to read, at most ``seconds`` (host time; negative: for ever)."""
        until = host_now() + seconds
        while not self.has_news():
            left = until - host_now()
            if seconds >= 0.0 and left <= 0.0:
                return False
            host_sleep(LOOK_AGAIN if seconds < 0.0 else min(LOOK_AGAIN, left))
        return True

    def clear(self) -> None:
        """Forget every message."""
        self._check(self.link.clear(), "clear")

    def age(self) -> float | None:
        """Not known at this end."""
        return None

    def diagnostics(self) -> list[dict[str, object]]:
        """Kept where the buffer is."""
        return []

    def close(self) -> None:
        """Let go of the link."""
        self.closed = True
        self.link.close()

    def _check_open(self) -> None:
        if self.closed:
            raise BufferError_(f"buffer {self.name}: the channel is closed")

    def _check(self, status: int, what: str) -> None:
        if status < 0:
            error = _ERRORS.get(status, BufferError_)
            raise error(f"{self.link.where}: cannot {what} it: {CmsStatus.describe(status)}")


def _without_text(body: bytes) -> bytearray:
    """The operator message of which only the header came."""
    type_id, _ = _HEADER.unpack(body)
    cls = registry.get(type_id)
    if cls is None:
        raise DecodeError(f"unknown message type {type_id}")
    message = cls()
    for field in cls.BODY:
        if field.c_type.startswith("char["):
            field.assign(message, NO_TEXT)
    return bytearray(message.data)


class RemoteChannel(Channel):
    """A channel whose buffer is elsewhere. Errors: ``LinkDown`` and ChannelTimeout while the server is away."""

    remote = True

    def _open(self, line: BufferLine, process: ProcessLine) -> None:
        link = open_link(line, process)
        self._memory = None
        self._serial = line.serial
        self._may_write = process.may_write
        self._codec = None
        self.raw = RemoteBuffer(link)  # type: ignore[assignment]
        self._finalizer = weakref.finalize(self, link.close)
        if process.may_read:
            self.poll_into = self.raw.poll_into

    def close(self) -> None:
        """Let go of the link."""
        self.raw.close()
        self._finalizer.detach()

    @property
    def address(self) -> int:
        raise BufferError_(f"buffer {self.name} is remote: it has no address here")

    def reader(self) -> Channel:
        return Channel.connect(self.line, self.process)


def open_link(line: BufferLine, process: ProcessLine) -> Link:
    """The link that a buffer's line and a process's line ask for: TCP, else STCP, UDP or a serial line.

    A serial port in the process's line comes first: it is this end of the cable.
    """
    if process.serial_port is not None:
        return SerialLink(line, process)
    if line.tcp is not None and process.subscription != "none":
        return SubscribedLink(line, process)
    if line.tcp is not None and process.poll:
        return PolledLink(line, process)
    offered = ((line.tcp, TcpLink), (line.stcp, TextLink), (line.udp, UdpLink), (line.serial_port, SerialLink))
    for where, kind in offered:
        if where is not None:
            return kind(line, process)
    message = f"buffer {line.name} has no TCP=, STCP=, UDP= or serialPortDevName=, so {process.process} cannot reach it"
    raise ConfigError(message, line.place)
