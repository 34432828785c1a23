"""The manual's other classes under their own names: channels for commands and for status, Timer and Semaphore.

Chapters 3.18, 3.19 and 3.22 of the Developer Manual. A Timer runs on controller time (``nml.clock``).
"""

from __future__ import annotations

import contextlib

import posix_ipc

from nml import clock
from nml.channel import Channel
from nml.errors import EncodeError, NmlError
from nml.message import Command, Message, Status
from nml.namespace import shm_name


class RCS_CMD_CHANNEL(Channel):
    """A channel that carries commands, each with its serial number."""

    def write(self, message: Message) -> int:
        """Publish a command; EncodeError if the message is none."""
        if not isinstance(message, Command):
            raise EncodeError(f"buffer {self.name}: {type(message).__name__} is no command")
        return super().write(message)


class RCS_STAT_CHANNEL(Channel):
    """A channel that carries a status."""

    def write(self, message: Message) -> int:
        """Publish a status; EncodeError if the message is none."""
        if not isinstance(message, Status):
            raise EncodeError(f"buffer {self.name}: {type(message).__name__} is no status")
        return super().write(message)


class Timer:
    """Wakes every ``interval`` s of controller time, however long the work between two waits takes."""

    def __init__(self, interval: float) -> None:
        if not interval > 0.0:
            raise ValueError(f"an interval of {interval} s")
        self.interval = interval
        self._next = clock.now() + interval

    def wait(self) -> int:
        """Sleep until the next interval begins; how many whole intervals went by before this call."""
        late = int(max(0.0, clock.now() - self._next) / self.interval)
        self._next += late * self.interval
        clock.sleep(self._next - clock.now())
        self._next += self.interval
        return late

    def sync(self) -> None:
        """Let the next interval begin now."""
        self._next = clock.now() + self.interval


class Semaphore:
    """Mutual exclusion between processes by a key; made by whoever comes first.

    ``timeout`` s of host time: 0 returns at once, negative waits for ever. Unlike a buffer's lock it is not given back
    when its holder dies.
    """

    def __init__(self, key: int, timeout: float = -1.0) -> None:
        self.key = key
        self.timeout = timeout
        name = shm_name(f"sem.{key}")
        self._semaphore = posix_ipc.Semaphore(name, flags=posix_ipc.O_CREAT, mode=0o600, initial_value=1)

    def wait(self) -> bool:
        """Take it; False if it did not become free within the timeout."""
        try:
            self._semaphore.acquire(None if self.timeout < 0.0 else self.timeout)
        except posix_ipc.BusyError:
            return False
        return True

    def trywait(self) -> bool:
        """Take it if it is free."""
        try:
            self._semaphore.acquire(0)
        except posix_ipc.BusyError:
            return False
        return True

    def post(self) -> None:
        """Give it back."""
        self._semaphore.release()

    def close(self) -> None:
        """Let go of it; others keep it."""
        self._semaphore.close()

    def destroy(self) -> None:
        """Remove it; for the last process that uses it."""
        with contextlib.suppress(posix_ipc.ExistentialError):
            self._semaphore.unlink()

    def __enter__(self) -> Semaphore:
        if not self.wait():
            raise NmlError(f"semaphore {self.key}: not free within {self.timeout} s")
        return self

    def __exit__(self, *exception: object) -> None:
        self.post()
