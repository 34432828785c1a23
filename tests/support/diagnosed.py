"""A client of an NML server that introduces itself, peeks once and asks for the diagnostics report."""

from __future__ import annotations

import contextlib
import socket
import struct
from typing import Any, NamedTuple

NAME, HOST, PID, VERSION = b"tester", b"desk.example", 4711, 1.5
HEAD = struct.Struct(">iiii8sII")
ENTRY = struct.Struct(">16s32sI8s6I48sII")


class Entry(NamedTuple):
    """One process of a report."""

    name: bytes
    host: bytes
    pid: int
    version: float
    access: int
    last_id: int
    last_size: int
    last_type: int
    accesses: int
    new: int
    moved: float
    over_socket: float
    last: float
    first: float
    shortest: float
    longest: float
    wrote_last: int
    read_last: int


def report(port: int, number: int = 2) -> tuple[tuple[Any, ...], list[Entry]]:
    """Head (serial, status, last writer, last reader, time, count, bytes) and entries, as a little-endian client."""
    with socket.create_connection(("127.0.0.1", port), 10.0) as sock:
        info = struct.pack(">16s32sII", NAME, HOST, PID, 10) + struct.pack("<dI", VERSION, 0x11223344)
        sock.sendall(struct.pack(">5I", 0, 14, number, 0, 0) + info)
        sock.sendall(struct.pack(">5I", 1, 1, number, 3, 0))
        size = struct.unpack(">5I", sock.recv(20, socket.MSG_WAITALL))[2]
        sock.recv(size, socket.MSG_WAITALL)
        sock.sendall(struct.pack(">5I", 2, 15, number, 0, 0))
        head = list(HEAD.unpack(sock.recv(HEAD.size, socket.MSG_WAITALL)))
        head[4] = struct.unpack("<d", head[4])[0]
        body = sock.recv(head[6] - HEAD.size, socket.MSG_WAITALL)
        sock.settimeout(0.2)
        with contextlib.suppress(TimeoutError):
            assert sock.recv(1) == b"", "bytes behind the report"
    return tuple(head), [_entry(parts) for parts in ENTRY.iter_unpack(body)]


def _entry(parts: tuple[Any, ...]) -> Entry:
    name, host, pid, version, *counts, times, wrote, read = parts
    return Entry(
        name.rstrip(b"\0"), host.rstrip(b"\0"), pid, struct.unpack("<d", version)[0], *counts,
        *struct.unpack("<6d", times), wrote, read,
    )
