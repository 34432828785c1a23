"""Memory of a buffer: a POSIX shared-memory segment, a file, or the process's own; used by ``nml.channel``.

Whoever comes first makes the segment, master or not, and the last one to go removes it. Both hang on advisory locks of
the open segment, which the kernel drops when a process dies, however it dies: an exclusive lock means 'nobody else is
here' (make it, or remove it), a shared one is held as long as the buffer is in use.
"""

from __future__ import annotations

import contextlib
import fcntl
import mmap
import os
import stat
import weakref
from pathlib import Path
from typing import Protocol

import posix_ipc

from nml import clock
from nml.errors import BufferError_, ChannelTimeout
from nml.namespace import shm_name


class Layout(Protocol):
    """What a buffer puts into its memory."""

    @property
    def size(self) -> int:
        """Bytes of the whole memory."""

    def make(self, memory: mmap.mmap) -> None:
        """Make an empty buffer."""

    def renew(self, memory: mmap.mmap) -> None:
        """Take over a buffer that nobody else uses, messages included."""

    def complete(self, memory: mmap.mmap) -> bool:
        """Whether a buffer was made to its end."""


PATIENCE = 5.0
"""s of host time to wait for another process that is making a segment."""

_SHM_FOLDER = Path("/dev/shm")
_local: dict[int, mmap.mmap] = {}


class Memory:
    """Memory that only this process sees (LOCMEM): one block per key, for the life of the process."""

    def __init__(self, name: str, layout: Layout, key: int) -> None:
        self.name = name
        block = _local.get(key)
        if block is None:
            block = _local[key] = mmap.mmap(-1, layout.size)
            layout.make(block)
        elif len(block) != layout.size:
            raise BufferError_(f"buffer {name}: {layout.size} bytes asked for, the block of key {key} has {len(block)}")
        self.map: mmap.mmap | None = block

    @property
    def orphaned(self) -> bool:
        """Whether others can no longer find this memory."""
        return False

    def close(self) -> None:
        """Let go of it; what was written stays."""
        self.map = None


class Segment:
    """A shared-memory segment, or a file when ``path`` is given (FILEMEM: its messages outlive its users)."""

    def __init__(self, name: str, layout: Layout, key: int, path: Path | None = None) -> None:
        self.name = name
        self.layout = layout
        self.shm = shm_name(f"nml.{key}")
        self.path = path
        self.map: mmap.mmap | None = None
        end = clock.host_now() + PATIENCE
        while self.map is None:
            if clock.host_now() > end:
                raise BufferError_(f"buffer {name}: {path or self.shm} is in use by another version of this program")
            self.fd = self._open()
            try:
                self.map = self._attach()
            finally:
                if self.map is None:
                    os.close(self.fd)
            if self.map is None:
                clock.host_sleep(0.001)
        named = self.shm if path is None else None
        self._release = weakref.finalize(self, _release, self.fd, named, os.getpid())

    def _open(self) -> int:
        try:
            if self.path is not None:
                return os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
            return posix_ipc.SharedMemory(self.shm, flags=os.O_CREAT, mode=0o600).fd
        except (OSError, posix_ipc.Error) as error:
            raise BufferError_(f"buffer {self.name}: cannot open {self.path or self.shm}: {error}") from None

    def _attach(self) -> mmap.mmap | None:
        """Map the segment, made first if nobody else uses it; None if it was removed, or left unfinished, meanwhile."""
        if _lock_alone(self.fd):
            self._make()
        self._share()
        status = os.fstat(self.fd)
        if status.st_nlink == 0 or status.st_size == 0:
            return None
        if status.st_size != self.layout.size:
            here, there = self.layout.size, status.st_size
            raise BufferError_(f"buffer {self.name}: {here} bytes by this NML file, {there} by that of other users")
        memory = mmap.mmap(self.fd, self.layout.size)
        return memory if self.layout.complete(memory) else None

    def _make(self) -> None:
        status = os.fstat(self.fd)
        if stat.S_IMODE(status.st_mode) & 0o077 or status.st_uid != os.geteuid():
            raise BufferError_(f"buffer {self.name}: {self.path or self.shm} is not this user's alone")
        same_size = status.st_size == self.layout.size
        os.ftruncate(self.fd, self.layout.size)
        try:
            os.posix_fallocate(self.fd, 0, self.layout.size)  # else whoever writes first dies of a bus error
        except OSError as error:
            os.ftruncate(self.fd, 0)
            place = self.path or _SHM_FOLDER
            message = f"buffer {self.name}: no room for its {self.layout.size} bytes in {place}: {error.strerror}"
            raise BufferError_(message) from None
        with mmap.mmap(self.fd, self.layout.size) as memory:
            if self.path is not None and same_size and self.layout.complete(memory):
                self.layout.renew(memory)
            else:
                self.layout.make(memory)

    def _share(self) -> None:
        """Take the lock of a user; it is free as soon as whoever makes or removes the segment is done."""
        end = clock.host_now() + PATIENCE
        while True:
            try:
                fcntl.flock(self.fd, fcntl.LOCK_SH | fcntl.LOCK_NB)
            except BlockingIOError:
                if clock.host_now() > end:
                    message = f"buffer {self.name}: being made by another process for {PATIENCE} s"
                    raise ChannelTimeout(message) from None
                clock.host_sleep(0.001)
            else:
                return

    @property
    def orphaned(self) -> bool:
        """Whether others can no longer find this memory, because somebody cleaned up while it was in use."""
        return self.map is not None and os.fstat(self.fd).st_nlink == 0

    def close(self) -> None:
        """Let go; the last user removes a segment (a file stays). Happens by itself when nobody refers to it."""
        self.map = None
        self._release()


def _lock_alone(fd: int) -> bool:
    """Take the exclusive lock if nobody else uses the segment."""
    try:
        fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _release(fd: int, shm: str | None, pid: int) -> None:
    """End the use of a segment; a child process that inherited it shares its parent's locks and leaves them alone."""
    if pid == os.getpid():
        if shm is not None and _lock_alone(fd) and os.fstat(fd).st_nlink:
            with contextlib.suppress(posix_ipc.ExistentialError):
                posix_ipc.unlink_shared_memory(shm)
        fcntl.flock(fd, fcntl.LOCK_UN)
    os.close(fd)


def segments() -> list[str]:
    """Names of all buffer segments of this namespace."""
    prefix = shm_name("nml.")
    return sorted("/" + entry.name for entry in _SHM_FOLDER.glob(prefix[1:] + "*"))


def cleanup() -> list[str]:
    """Remove every buffer segment of this namespace, whoever uses it; their names. For the launcher."""
    removed = []
    for name in segments():
        with contextlib.suppress(posix_ipc.ExistentialError):
            posix_ipc.unlink_shared_memory(name)
            removed.append(name)
    return removed
