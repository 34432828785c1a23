"""NML over a serial line (serialPortDevName=): packets in frames that survive noise.

A frame is the packet and its CRC-32, big endian, in SLIP's escaping (RFC 1055): 0xC0 ends a frame, 0xDB 0xDC and
0xDB 0xDD stand for the two bytes themselves. A frame that is damaged or too long is dropped, and the client asks
again. Both ends use this: ``packet_ports`` and ``packet_links``.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from typing import Any

from nml.net.wire import LARGEST_FRAME

_END, _ESCAPE = b"\xc0", b"\xdb"
_CRC = struct.Struct(">I")


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
        if len(self._collected) > LARGEST_FRAME:
            self._collected.clear()


def _unescaped(body: bytes) -> bytes | None:
    body = body.replace(b"\xdb\xdc", _END).replace(b"\xdb\xdd", _ESCAPE)
    packet, crc = body[: -_CRC.size], body[-_CRC.size :]
    if len(packet) == 0 or crc != _CRC.pack(zlib.crc32(packet)):
        return None
    return packet


def open_line(device: str, baud: int, exclusive: bool = False) -> Any:
    """The serial port, raw and non-blocking, ``exclusive`` if no other process may have it; OSError if that fails."""
    import serial  # type: ignore[import-untyped]

    return serial.Serial(device, baudrate=baud, timeout=0, write_timeout=0, exclusive=exclusive)
