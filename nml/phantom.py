"""A buffer without memory (PHANTOM), for trying out a program alone: what is written is counted and forgotten.

Has the methods of ``nml._buffer.Buffer``, so that a channel need not know.
"""

from __future__ import annotations

from nml.errors import BufferError_


class PhantomBuffer:
    """Takes every message of up to ``longest`` bytes, never gives one."""

    missed = 0
    last = 0
    last_time_ns = 0
    address = 0

    def __init__(self, name: str, size: int) -> None:
        self.name = name
        self.longest = size
        self.write_counter = 0
        self.closed = False

    def write(self, data: bytes | bytearray | memoryview, serial: bool = False, only_if_read: bool = False) -> int:
        """Count a message."""
        if self.closed:
            raise BufferError_(f"buffer {self.name}: the channel is closed")
        self.write_counter += 1
        return self.write_counter

    def read(self) -> None:
        """Nothing: there never is a message."""

    peek = read

    def poll_into(self, into: bytearray) -> bool:
        """False: there never is a message."""
        return False

    def wait(self, seconds: float) -> bool:
        """False, at once: nobody else could ever write."""
        return False

    def has_news(self) -> bool:
        """False: there never is a message."""
        return False

    def was_read(self) -> bool:
        """True, so that whoever waits for a reader goes on."""
        return True

    def mark_read(self) -> None:
        """Nothing to mark."""

    def queue_length(self) -> int:
        """No message waits."""
        return 0

    def space(self) -> int:
        """There is always room."""
        return self.longest

    def clear(self) -> None:
        """Nothing to forget."""

    def age(self) -> None:
        """There is no newest message."""

    def last_writer(self) -> int:
        """Nobody."""
        return 0

    def diagnostics(self) -> list[dict[str, object]]:
        """No counts."""
        return []

    def close(self) -> None:
        """Refuse further messages."""
        self.closed = True
