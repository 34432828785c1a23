"""Signals that ask a program to end: remembered, and raised as ``Stopped`` wherever it is.

Not while it imports, where Python turns what is raised into other exceptions or drops it; nor does an exception leave a
destructor. A program that catches these signals therefore asks ``check`` after its imports and in its waits.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

END = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
IMPORT_SYSTEM = "<frozen importlib"  # how the file names of its code begin

_asked: int | None = None  # the signal that came


class Stopped(BaseException):
    """A signal asked this program to end."""

    def __init__(self, number: int) -> None:
        self.number = number
        super().__init__(f"stopped by {signal.Signals(number).name}")


def catch() -> None:
    """Raise Stopped when one of the signals comes; while something is imported, let the next ``check`` do it."""
    for number in END:
        signal.signal(number, _stop)


def ignore() -> None:
    """Let none of the signals interrupt what follows."""
    for number in END:
        signal.signal(number, signal.SIG_IGN)


def forget() -> None:
    """Be ended by the signals as any Python program, also by those held: for a fork that becomes another program."""
    global _asked
    _asked = None
    for number in END:
        signal.signal(number, signal.default_int_handler if number is signal.SIGINT else signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, END)


def check() -> None:
    """Raise Stopped if a signal came before."""
    if _asked is not None:
        raise Stopped(_asked)


@contextmanager
def held() -> Iterator[None]:
    """Let the signals wait: around a fork, whose two sides treat them differently from their first line on."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, END)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _stop(number: int, frame: FrameType | None) -> None:
    global _asked
    _asked = number
    if not _importing(frame):
        raise Stopped(number)


def _importing(frame: FrameType | None) -> bool:
    while frame is not None and not frame.f_code.co_filename.startswith(IMPORT_SYSTEM):
        frame = frame.f_back
    return frame is not None
