"""A process's way to one buffer: reads and writes messages under the rules of the process's line in the NML file.

    status = Channel(None, "emcStatus", process="xemc")
    while status.wait(1.0):
        print(status.peek().task.mode)

Every process of a controller, and every client, talks through channels; what lies in memory is ``nml._shm``'s.
"""

from __future__ import annotations

import importlib
import mmap
import os
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

from nml import _shm
from nml.config import BufferLine, BufferType, Mutex, NmlConfig, ProcessLine, ProcessType, is_this_host
from nml.errors import BufferError_, ConfigError, DecodeError, EncodeError
from nml.message import Command, Message, decode
from nml.namespace import runtime_dir
from nml.segment import Memory, Segment

Configuration = NmlConfig | str | os.PathLike[str] | None


@dataclass(frozen=True, slots=True)
class BufferLayout:
    """What a B line wants of its memory (``nml.segment.Layout``)."""

    line: BufferLine

    @property
    def kind(self) -> int:
        if not self.line.queue:
            return _shm.SLOT
        return _shm.BROADCAST if self.line.broadcast else _shm.QUEUE

    @property
    def size(self) -> int:
        return _shm.segment_size(self.kind, self.line.size, self.line.max_procs)

    def make(self, memory: mmap.mmap) -> None:
        _shm.format_segment(memory, self.line.name, self.kind, self.line.size, self.line.max_procs)

    def renew(self, memory: mmap.mmap) -> None:
        _shm.renew_locks(memory)

    def complete(self, memory: mmap.mmap) -> bool:
        return _shm.is_complete(memory)

    def check(self, memory: mmap.mmap) -> None:
        _shm.check_segment(memory, self.line.name, self.kind, self.line.size, self.line.max_procs)


class Channel:
    """One process's access to one buffer. For one thread at a time; only ``wait`` may run beside the others.

    ``config`` is a parsed NML file, a path, or None for the controller's own (``NmlConfig.load``).
    """

    line: BufferLine
    process: ProcessLine
    _let_go: Callable[[], object]

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
        self._memory = _memory(line)
        self._let_go = weakref.finalize(self, self._memory.close)
        self._attach()

    def _attach(self) -> None:
        line, process = self.line, self.process
        assert self._memory.map is not None
        BufferLayout(line).check(self._memory.map)
        self._serial = line.serial
        self._may_write = process.may_write
        self.raw = _shm.Buffer(
            self._memory.map,
            timeout=process.timeout,
            lock_writes=line.mutex is not Mutex.NONE,
            shared=process.shared,
            c_num=process.c_num if line.diag else -1,
            process=process.process,
        )
        """The buffer itself: bytes instead of messages."""
        if process.may_read:
            self.poll_into = self.raw.poll_into
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
        return self._memory.orphaned

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
            return self.raw.write(message.data, self._serial and isinstance(message, Command), only_if_read)
        except EncodeError:
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
        """Forget every message. Numbers go on, so nobody takes a later message for an old one."""
        self.raw.clear()

    def diagnostics(self) -> list[dict[str, object]]:
        """What each process did with a buffer declared ``diag``: counts, bytes, times."""
        return self.raw.diagnostics()

    def close(self) -> None:
        """Let go of the buffer; its last user removes the segment."""
        self.raw.close()
        self._let_go()

    def reader(self) -> Channel:
        """Another channel in this channel's memory, with a cursor of its own in a broadcast queue; close it first."""
        other: Channel = object.__new__(type(self))
        other.line = self.line
        other.process = self.process
        other._memory = self._memory
        other._let_go = lambda: None
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
            return decode(data)
        except DecodeError as error:
            raise DecodeError(f"buffer {self.name}: {error}") from None

    def _too_long(self, message: Message) -> EncodeError:
        kind = type(message).__name__
        longest = self.raw.longest
        return EncodeError(f"buffer {self.name}: {kind} has {message.SIZE} bytes, the longest message has {longest}")

    def _not_allowed(self, what: str) -> BufferError_:
        line = self.process
        return BufferError_(f"{line.place}: {line.process} may not {what} {self.name}, its ops are {line.ops}")


def _memory(line: BufferLine) -> Memory | Segment:
    layout = BufferLayout(line)
    match line.type:
        case BufferType.LOCMEM:
            return Memory(line.name, layout, line.key)
        case BufferType.FILEMEM:
            return Segment(line.name, layout, line.key, _file_of(line))
        case _:
            return Segment(line.name, layout, line.key)


def _file_of(line: BufferLine) -> Path:
    return runtime_dir() / f"{line.name}.nml-buffer"
