"""The one clock of a controller: every timer, timeout and sleep of the project comes from here.

Controller time runs ``speed()`` times as fast as the monotonic clock of the host; the launcher's ``--speed N`` sets the
environment variable ``PYEMC_SPEED`` for all of its processes. Waits for other processes to *react* (a timeout on a dead
partner) are host time, because a process does not die faster when the machine is simulated faster: see ``host_now``.
"""

from __future__ import annotations

import os
import time

VARIABLE = "PYEMC_SPEED"


def _checked(text: str) -> float:
    try:
        factor = float(text)
    except ValueError:
        factor = 0.0
    if not 0.01 <= factor <= 10000.0:
        raise ValueError(f"{VARIABLE}={text!r}: a number from 0.01 to 10000 is allowed")
    return factor


_SPEED = _checked(os.environ.get(VARIABLE, "1"))


def set_speed(factor: float) -> None:
    """Change the speed of this process and of those it starts from now on; ValueError outside 0.01 to 10000."""
    global _SPEED
    _SPEED = _checked(repr(factor))
    os.environ[VARIABLE] = repr(factor)


def speed() -> float:
    """How many seconds of controller time pass in a second of host time."""
    return _SPEED


def now() -> float:
    """Controller time in s; only differences mean anything."""
    return time.monotonic() * _SPEED


def sleep(seconds: float) -> None:
    """Sleep for ``seconds`` of controller time."""
    if seconds > 0.0:
        time.sleep(seconds / _SPEED)


def host_now() -> float:
    """Host time in s, for timeouts on other processes."""
    return time.monotonic()


def host_sleep(seconds: float) -> None:
    """Sleep for ``seconds`` of host time."""
    if seconds > 0.0:
        time.sleep(seconds)
