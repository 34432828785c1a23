"""NML over a serial line (serialPortDevName=): packets of ``datagram`` in frames that survive noise.

A frame is the packet and its CRC-32, big endian, in SLIP's escaping (RFC 1055): 0xC0 ends a frame, 0xDB 0xDC and
0xDB 0xDD stand for the two bytes themselves. A frame that is damaged or too long is dropped, and the client asks again.
"""

from __future__ import annotations

import os
import select
import struct
import zlib
from collections.abc import Iterator
from typing import Any

from nml.clock import host_now
from nml.net.datagram import Peers
from nml.net.served import Shelf
from nml.net.streams import Loop

LARGEST = 1 << 20
"""Bytes of the longest frame that is collected."""
DEFAULT_BAUD = 115200

_END, _ESCAPE = b"\xc0", b"\xdb"
_CRC = struct.Struct(">I")
_CHUNK = 4096


def frame(packet: bytes) -> bytes:
    """``packet`` as it goes on the line. It begins with an end mark too, which ends whatever noise came before."""
    body = packet + _CRC.pack(zlib.crc32(packet))
    return _END + body.replace(_ESCAPE, b"\xdb\xdd").replace(_END, b"\xdb\xdc") + _END


class Unframer:
    """Finds the packets in what comes from the line."""

    def __init__(self) -> None:
        self._collected = bytearray()

    def receive(self, data: bytes) -> Iterator[bytes]:
        """The complete and undamaged packets."""
        *frames, rest = data.split(_END)
        for piece in frames:
            self._collected += piece
            packet = _unescaped(bytes(self._collected))
            self._collected.clear()
            if packet is not None:
                yield packet
        self._collected += rest
        if len(self._collected) > LARGEST:
            self._collected.clear()


def _unescaped(body: bytes) -> bytes | None:
    body = body.replace(b"\xdb\xdc", _END).replace(b"\xdb\xdd", _ESCAPE)
    packet, crc = body[: -_CRC.size], body[-_CRC.size :]
    if len(packet) == 0 or crc != _CRC.pack(zlib.crc32(packet)):
        return None
    return packet


def open_line(device: str, baud: int) -> Any:
    """The serial port, raw and non-blocking; OSError if that fails."""
    import serial  # type: ignore[import-untyped]

    return serial.Serial(device, baudrate=baud, timeout=0, write_timeout=0, exclusive=False)


class SerialPort:
    """The server's end of a serial line."""

    def __init__(self, device: str, baud: int, loop: Loop, shelf: Shelf) -> None:
        self._loop = loop
        self._peers = Peers(shelf, LARGEST)
        self._port = open_line(device, baud)
        self._fd: int = self._port.fileno()
        os.set_blocking(self._fd, False)
        self._unframer = Unframer()
        self._out = b""
        loop.watch(self._fd, self, select.EPOLLIN)

    def ready(self, events: int) -> None:
        """Answer packets, one after the other: while a reply is on its way, further requests are dropped."""
        try:
            if events & select.EPOLLOUT:
                self._send()
            if events & select.EPOLLIN:
                for packet in self._unframer.receive(os.read(self._fd, _CHUNK)):
                    reply = self._peers.answer(None, packet, host_now())
                    if reply is not None and not self._out:
                        self._out = frame(reply)
                        self._send()
            elif events & (select.EPOLLHUP | select.EPOLLERR):
                self.close()
        except BlockingIOError:
            return
        except OSError:
            self.close()

    def _send(self) -> None:
        had = self._out
        try:
            self._out = self._out[os.write(self._fd, self._out) :]
        except BlockingIOError:
            pass
        finally:
            if had:
                self._loop.change(self._fd, select.EPOLLIN | (select.EPOLLOUT if self._out else 0))

    def close(self) -> None:
        if self._fd >= 0:
            self._loop.forget(self._fd)
            self._fd = -1
            self._port.close()
            self._peers.close()
