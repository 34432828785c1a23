"""The exceptions of the whole project: one root, so that a program can catch what it expects and no more.

    PyemcError
    ├── ConfigError          a file that a person wrote: INI, HAL, NML, tool table (also a ValueError)
    ├── NmlError
    │   ├── EncodeError      our side made a message that cannot be written (also a ValueError)
    │   │   └── TooLong      the buffer is too small for it
    │   ├── DecodeError      the other side wrote something that is no message (also a ValueError)
    │   ├── BufferError_     a buffer that is missing, too small, or not the one that was asked for
    │   │   └── QueueFull    no room until somebody reads
    │   └── ChannelTimeout   nobody answered within the buffer's timeout (also a TimeoutError)
    ├── HalError             a refusal of the hardware abstraction layer; carries the original's errno
    └── InterpError          a G-code program is wrong: file, line, column, block
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Place:
    """A place in a text file; line and column count from 1, 0 means unknown."""

    file: str
    line: int = 0
    column: int = 0

    def __str__(self) -> str:
        parts = [self.file]
        if self.line:
            parts.append(str(self.line))
            if self.column:
                parts.append(str(self.column))
        return ":".join(parts)


class PyemcError(Exception):
    """Root of all errors that this project raises on purpose."""


class ConfigError(PyemcError, ValueError):
    """A configuration file is wrong; the text reads ``file:line:column: what is wrong; what would be right``."""

    def __init__(self, message: str, place: Place | None = None) -> None:
        self.place = place
        self.message = message
        super().__init__(f"{place}: {message}" if place else message)


class NmlError(PyemcError):
    """A message, a buffer or a channel does not work."""


class EncodeError(NmlError, ValueError):
    """A message cannot be written: too long, a value out of range, an unknown field."""


class TooLong(EncodeError):
    """A message is longer than the buffer's longest; nothing was written."""


class DecodeError(NmlError, ValueError):
    """Bytes that no encoder of ours could have written."""


class BufferError_(NmlError):
    """A buffer is missing, of another size or kind than asked for, or not allowed to this process."""


class QueueFull(BufferError_):
    """A queue has no room for the message until somebody reads; nothing was written."""


class ChannelTimeout(NmlError, TimeoutError):
    """The other side did not react within the timeout of the process line."""


class HalError(PyemcError):
    """The hardware abstraction layer refuses; ``errno`` is the negative number LinuxCNC would return."""

    def __init__(self, message: str, errno: int = -22) -> None:
        self.errno = errno
        super().__init__(message)


class InterpError(PyemcError):
    """A program is wrong at ``place``; ``block`` is the offending line as written."""

    def __init__(self, message: str, place: Place | None = None, block: str = "") -> None:
        self.message = message
        self.place = place
        self.block = block
        super().__init__(f"{place}: {message}" if place else message)
