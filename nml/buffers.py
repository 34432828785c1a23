"""Opens the buffer that a B line declares: which memory it lies in, and what is made there. Used by ``nml.channel``."""

from __future__ import annotations

import mmap
from dataclasses import dataclass
from typing import cast

from nml import _shm
from nml._buffer import Buffer
from nml.config import BufferLine, BufferType, Mutex, ProcessLine
from nml.namespace import runtime_dir
from nml.phantom import PhantomBuffer
from nml.segment import Memory, Segment


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


def open_memory(line: BufferLine) -> Memory | Segment | None:
    """The memory of a buffer, made if it is not there yet; None for a phantom, which has none.

    SHMEM and GLOBMEM are a segment, FILEMEM a file in the runtime folder, LOCMEM this process's own memory.
    """
    layout = BufferLayout(line)
    match line.type:
        case BufferType.PHANTOM:
            return None
        case BufferType.LOCMEM:
            memory: Memory | Segment = Memory(line.name, layout, line.key)
        case BufferType.FILEMEM:
            memory = Segment(line.name, layout, line.key, runtime_dir() / f"{line.name}.nml-buffer")
        case _:
            memory = Segment(line.name, layout, line.key)
    assert memory.map is not None
    layout.check(memory.map)
    return memory


def attach(memory: Memory | Segment | None, line: BufferLine, process: ProcessLine) -> Buffer:
    """A process's hold on the buffer in ``memory``."""
    if memory is None:
        return cast(Buffer, PhantomBuffer(line.name, line.size))
    assert memory.map is not None
    return Buffer(
        memory.map,
        keeper=memory,
        timeout=process.timeout,
        lock_writes=line.mutex is not Mutex.NONE,
        shared=process.shared,
        observe=process.observer,
        c_num=process.c_num if line.diag else -1,
        process=process.process,
    )
