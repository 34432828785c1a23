"""A process's way to one buffer: reads and writes messages under the rules of the process's line in the NML file.

    status = Channel(None, "emcStatus", process="xemc")
    while status.wait(1.0):
        print(status.peek().task.mode)

Every process of a controller, and every client, talks through channels; how things lie in memory is ``nml._shm``'s.
"""

from __future__ import annotations

import importlib
import os
from types import TracebackType

from nml.buffers import attach, open_memory
from nml.codecs import codec
from nml.config import BufferLine, NmlConfig, ProcessLine, ProcessType, is_this_host
from nml.errors import BufferError_, ConfigError, DecodeError, EncodeError, TooLong
from nml.message import Command, Message, decode

Configuration = NmlConfig | str | os.PathLike[str] | None


class Channel:
    """One process's access to one buffer. For one thread at a time; only ``wait`` may run beside the others.

    ``config`` is a parsed NML file, a path, or None for the controller's own (``NmlConfig.load``).
    """

    line: BufferLine
    process: ProcessLine
    remote = False
    """Whether the buffer is reached through a server, which then knows who writes."""

    def __new__(cls, config: Configuration = None, buffer: str = "", process: str = "xemc") -> Channel:
        parsed = config if isinstance(config, NmlConfig) else NmlConfig.load(config)
        return cls.connect(parsed.buffer(buffer), parsed.process(process, buffer))

    @classmethod
    def connect(cls, line: BufferLine, process: ProcessLine) -> Channel:
        """A channel for two lines that need not stand in a file; a remote one (``nml.net``) where they say so."""
        if process.type is ProcessType.REMOTE or (process.type is ProcessType.AUTO and not is_this_host(line.host)):
            cls = importlib.import_module("nml.net.remote").RemoteChannel
        self: Channel = object.__new__(cls)
        self.line = line
        self.process = process
        self._open(line, process)
        return self

    def _open(self, line: BufferLine, process: ProcessLine) -> None:
        if process.c_num >= line.max_procs:
            message = f"c_num {process.c_num} of {process.process}; buffer {line.name} has max_procs {line.max_procs}"
            raise ConfigError(message, process.place)
        self._memory = open_memory(line)
        self._owner = True
        self._attach()

    def _attach(self) -> None:
        line, process = self.line, self.process
        self._serial = line.serial
        self._may_write = process.may_write
        self._codec = codec(line.encoding.value) if line.neutral else None
        self.raw = attach(self._memory, line, process)
        """The buffer itself: bytes instead of messages."""
        if process.may_read:
            self.poll_into = self.raw.poll_into if self._codec is None else self._poll_decoded
            """``poll_into(bytearray) -> bool``: copy a new single-slot message; False, and quick, if there is none."""

    @property
    def name(self) -> str:
        """Name of the buffer."""
        return self.line.name

    @property
    def address(self) -> int:
        """The buffer's head as a ``void*``, for the C functions of ``nml/_shm.pxd``."""
        return self.raw.address

    @property
    def pulse(self) -> int:
        """Signs of life of the process that writes the buffer (``nml.pulse``)."""
        return self.raw.pulse

    @property
    def write_counter(self) -> int:
        """Messages ever written to the buffer."""
        return self.raw.write_counter

    @property
    def missed(self) -> int:
        """Broadcast queue: messages that were dropped before this reader came to them."""
        return self.raw.missed

    @property
    def orphaned(self) -> bool:
        """Whether the buffer was removed while this channel was open: nobody else will ever meet it there."""
        return self._memory is not None and self._memory.orphaned

    def write(self, message: Message) -> int:
        """Publish a message: its number in the buffer, which a ``serial`` buffer also stores in the message.

        QueueFull, ChannelTimeout or EncodeError (too long): nothing was written.
        """
        return self._put(message)

    def write_if_read(self, message: Message) -> int:
        """As ``write``, but only if the last message was read; 0 if it was not."""
        return self._put(message, True)

    def _put(self, message: Message, only_if_read: bool = False) -> int:
        if not self._may_write:
            raise self._not_allowed("write")
        try:
            if self._codec is not None:
                return self.raw.write(self._encoded(message), False, only_if_read)
            return self.raw.write(message.data, self._serial and isinstance(message, Command), only_if_read)
        except TooLong:
            raise self._too_long(message) from None

    def read(self) -> Message | None:
        """The next message, taken from a queue; None: nothing new since this channel's last read or peek."""
        if not self.process.may_read:
            raise self._not_allowed("read")
        data = self.raw.read()
        return None if data is None else self._decoded(data)

    def peek(self) -> Message | None:
        """As ``read``, but leaves the message to others: a queue keeps it, a single slot does not count as read."""
        if not self.process.may_read:
            raise self._not_allowed("read")
        data = self.raw.peek()
        return None if data is None else self._decoded(data)

    def blocking_read(self, timeout: float = -1.0) -> Message | None:
        """The next message, waited for up to ``timeout`` s of host time (negative: for ever); None if none came."""
        if self.line.bsem == -1:
            raise BufferError_(f"buffer {self.name}: bsem=-1 in the NML file forbids blocking reads")
        message = self.read()
        while message is None and self.raw.wait(timeout):
            message = self.read()
        return message

    def wait(self, timeout: float) -> bool:
        """Sleep until there is something to read, at most ``timeout`` s of host time (negative: for ever)."""
        return self.raw.wait(timeout)

    def has_news(self) -> bool:
        """Whether ``read`` would return a message."""
        return self.raw.has_news()

    def check_if_read(self) -> bool:
        """Whether the last message was read (queue: all of them)."""
        return self.raw.was_read()

    def queue_length(self) -> int:
        """Messages that wait in the queue for this reader; 0 for a single slot."""
        return self.raw.queue_length()

    def space(self) -> int:
        """Length in bytes of the longest message that could be written now."""
        return self.raw.space()

    def age(self) -> float | None:
        """Seconds of host time since the message in a single slot was written; None if there is none."""
        return self.raw.age()

    def clear(self) -> None:
        """Forget every message. Numbers go on, so nobody takes a later message for an old one.

        A reader may empty a queue, which it could also read; otherwise it takes the right to write.
        """
        if not self._may_write and not (self.line.queue and self.process.may_read):
            raise self._not_allowed("clear")
        self.raw.clear()

    def diagnostics(self) -> list[dict[str, object]]:
        """What each process did with a buffer declared ``diag``: counts, bytes, times."""
        return self.raw.diagnostics()

    def close(self) -> None:
        """Let go of the buffer; its last user removes the segment."""
        self.raw.close()
        if self._memory is not None and self._owner:
            self._memory.close()

    def reader(self) -> Channel:
        """Another channel in this channel's memory, with a cursor of its own in a broadcast queue; close it first."""
        other: Channel = object.__new__(type(self))
        other.line = self.line
        other.process = self.process
        other._memory = self._memory
        other._owner = False
        other._attach()
        return other

    def __enter__(self) -> Channel:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<channel {self.process.process} {self.process.ops} {self.line.name}>"

    def _decoded(self, data: bytearray) -> Message:
        try:
            if self._codec is None:
                return decode(data)
            message = self._codec.decode(data)
        except DecodeError as error:
            raise DecodeError(f"buffer {self.name}: {error}") from None
        if self._serial and isinstance(message, Command):
            message.serial_number = self.raw.last
        return message

    def _encoded(self, message: Message) -> bytes:
        """The message as it lies in a neutral buffer; there its serial number is that of the record."""
        assert self._codec is not None
        encoded = self._codec.encode(message)
        limit = self.line.enc_max_size
        if limit is not None and len(encoded) > limit:
            kind = type(message).__name__
            raise EncodeError(f"buffer {self.name}: {kind} has {len(encoded)} bytes encoded, enc_max_size is {limit}")
        return encoded

    def _poll_decoded(self, into: bytearray) -> bool:
        data = self.raw.peek()
        if data is None:
            return False
        message = self._decoded(data)
        if len(into) < message.SIZE:
            raise BufferError_(f"buffer {self.name}: the message has {message.SIZE} bytes, the reader {len(into)}")
        into[: message.SIZE] = message.data
        return True

    def _too_long(self, message: Message) -> TooLong:
        kind = type(message).__name__
        longest = self.raw.longest
        return TooLong(f"buffer {self.name}: {kind} has {message.SIZE} bytes, the longest message has {longest}")

    def _not_allowed(self, what: str) -> BufferError_:
        line = self.process
        return BufferError_(f"{line.place}: {line.process} may not {what} {self.name}, its ops are {line.ops}")
