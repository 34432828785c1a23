"""Who used a buffer declared ``diag``, and how: the answer to the diagnostics request, made of the counts in shared
memory for local processes and of what the server has seen of its remote clients. Called by ``served`` only.
"""

from __future__ import annotations

import socket
import struct
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from nml.net import wire

READ, PEEK, WRITE = 1, 3, 4
_BIG, _SMALL = ">", "<"
_NS = 1e-9
NO_INTERVAL = 10_000.0
"""Shortest interval, in s, of a process that has not accessed the buffer twice."""
ENTRY_SIZE = struct.calcsize(">16s32sId6I6d2I")
"""Bytes of the report for each process."""


@dataclass(slots=True)
class Usage:
    """What one process, local or remote, did with a buffer. Times in s since 1970."""

    name: str
    host: str
    pid: int
    version: float = 0.0
    access: int = READ
    last_id: int = 0
    last_size: int = 0
    last_type: int = 0
    accesses: int = 0
    new: int = 0
    moved: float = 0.0
    over_socket: float = 0.0
    first: float = 0.0
    last: float = 0.0
    shortest: float = NO_INTERVAL
    longest: float = 0.0

    def count(self, access: int, message_id: int, size: int) -> None:
        """Take note of an access that moved ``size`` bytes (0: nothing new)."""
        now = time.time()
        if self.accesses:
            gap = now - self.last
            self.shortest = min(self.shortest, gap)
            self.longest = max(self.longest, gap)
        else:
            self.first = now
        self.last = now
        self.access = access
        self.accesses += 1
        if size:
            self.new += 1
            self.last_id, self.last_size = message_id & wire.MASK, size
            self.moved += size
            self.over_socket += size


def introduced(info: bytes) -> Usage:
    """What a client says of itself."""
    name, host, pid, _, version, order = wire.DIAG_INFO.unpack(info)
    (number,) = struct.unpack("<d" if order == struct.pack("<I", 0x11223344) else ">d", version)
    return Usage(_text(name), _text(host), pid, number)


def local_usages(counts: Iterable[dict[str, object]]) -> list[Usage]:
    """The counts that ``Channel.diagnostics`` gives, whose times are of the host's monotonic clock."""
    host, boot = socket.gethostname(), time.time() - time.monotonic()
    return [_local(host, boot, one) for one in counts]


def _local(host: str, boot: float, count: dict[str, object]) -> Usage:
    def number(key: str) -> int:
        value = count.get(key, 0)
        return value if isinstance(value, int) else 0

    return Usage(
        str(count["name"]),
        host,
        number("pid"),
        access=WRITE if number("writes") else READ,
        last_type=number("last_type"),
        accesses=number("reads") + number("writes"),
        new=number("new_reads") + number("writes"),
        moved=float(number("bytes_read") + number("bytes_written")),
        first=boot + number("first_ns") * _NS,
        last=boot + number("last_ns") * _NS,
        shortest=number("shortest_ns") * _NS or NO_INTERVAL,
        longest=number("longest_ns") * _NS,
    )


def report(usages: Sequence[Usage], little_endian: bool) -> bytes:
    """The diagnostics reply after serial number and status; floating point in the client's byte order."""
    order = _SMALL if little_endian else _BIG
    total = 32 + len(usages) * ENTRY_SIZE
    writer, reader = (_last(usages, kinds) for kinds in ((WRITE,), (READ, PEEK)))
    parts = [struct.pack(">ii", writer, reader), struct.pack(order + "d", time.time())]
    parts.append(struct.pack(">II", len(usages), total))
    for index, one in enumerate(usages):
        parts += [
            struct.pack(">16s32sI", one.name.encode()[:15], one.host.encode()[:31], one.pid & wire.MASK),
            struct.pack(order + "d", one.version),
            struct.pack(
                ">6I", one.access, one.last_id, one.last_size, one.last_type & wire.MASK,
                one.accesses & wire.MASK, one.new & wire.MASK,
            ),
            struct.pack(
                order + "6d", one.moved, one.over_socket, one.last, one.first, one.shortest, one.longest
            ),
            struct.pack(">II", index == writer, index == reader),
        ]
    return b"".join(parts)


def _last(usages: Sequence[Usage], kinds: tuple[int, ...]) -> int:
    """Index of the process with the latest access of these kinds, -1: none."""
    found = [(one.last, index) for index, one in enumerate(usages) if one.access in kinds and one.accesses]
    return max(found)[1] if found else -1


def _text(raw: bytes) -> str:
    return raw.partition(b"\0")[0].decode("utf-8", "replace")

