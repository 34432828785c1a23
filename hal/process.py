"""Is the process that wrote its number somewhere still the same one? For owners of components and the host."""

from __future__ import annotations

import os


def start_time(pid: int) -> int:
    """When process ``pid`` started, in clock ticks since boot; 0 where there is none, or a zombie."""
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            fields = file.read().rpartition(b")")[2].split()
    except (FileNotFoundError, ProcessLookupError):
        return 0
    return 0 if fields[0] in (b"Z", b"X") else int(fields[19])


def alive(pid: int, start: int) -> bool:
    """Whether the process that had number ``pid`` and began at ``start`` still runs."""
    return pid > 0 and start > 0 and start_time(pid) == start


def own_identity() -> tuple[int, int]:
    """(pid, start time) of this process."""
    pid = os.getpid()
    return pid, start_time(pid)
