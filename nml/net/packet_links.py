"""The client's end of links that may lose what is sent: UDP and serial lines; see ``packet_ports`` for the packets.

A request is sent again until its answer comes or the process line's timeout is over; the server makes sure that
a command which arrives twice is taken once.
"""

from __future__ import annotations

import os
import secrets
import select
import socket
import struct
from abc import abstractmethod
from typing import Any, ClassVar

from nml.clock import host_now
from nml.config import BufferLine, ProcessLine
from nml.errors import BufferError_, ChannelTimeout
from nml.net import wire
from nml.net.forms import Kind, form, vocabulary_checksum
from nml.net.links import BinaryLink, LinkDown, Words
from nml.net.serial_line import Unframer, frame, open_line
from nml.net.wire import CmsStatus, Request

UDP_REPEAT = 0.1
"""s after which a request is sent again."""
SERIAL_REPEAT = 0.5
"""s of silence on a serial line after which a request is sent again."""
_CHUNK = 4096


class PacketLink(BinaryLink):
    """Asks, and asks again."""

    repeat = UDP_REPEAT

    def __init__(self, line: BufferLine, process: ProcessLine) -> None:
        super().__init__(line, process)
        self._token = secrets.randbits(32)
        self._serial = secrets.randbits(32)
        self._open()
        try:
            self.introduce()
        except BaseException:
            self.close()
            raise

    @abstractmethod
    def _open(self) -> None: ...

    @abstractmethod
    def _send(self, packet: bytes) -> None: ...

    @abstractmethod
    def _receive(self, seconds: float) -> bytes | None:
        """A packet that came within that time, or None; again None when only a part has come."""

    def _ask(self, kind: Request, word3: int, word4: int, extra: bytes) -> bytes:
        """The reply to a request, as TCP would send it."""
        self._serial = (self._serial + 1) & wire.MASK
        words = (kind, self.line.number, self._serial, word3 & wire.MASK, word4 & wire.MASK)
        packet = wire.PACKET_REQUEST.pack(*words, self._token, vocabulary_checksum()) + extra
        deadline = float("inf") if self.timeout is None else host_now() + self.timeout
        try:
            while host_now() < deadline:
                self._send(packet)
                reply = self._wait_for_reply(min(deadline, host_now() + self.repeat), deadline)
                if reply is not None:
                    return reply
        except OSError as error:
            raise LinkDown(f"{self.where}: {error.strerror or error}") from None
        raise self.late(f"request {kind.name}")

    def _wait_for_reply(self, until: float, deadline: float) -> bytes | None:
        while (left := until - host_now()) > 0.0:
            packet = self._receive(left)
            if packet is not None and len(packet) >= wire.PACKET_REPLY.size:
                serial, native = wire.PACKET_REPLY.unpack_from(packet)
                if serial == self._serial:
                    self.form = form(Kind.NATIVE if native else Kind.CODED, self.line)
                    return packet[wire.PACKET_REPLY.size :]
        return None

    def converse(
        self, kind: Request, word3: int = 0, word4: int = 0, extra: bytes = b"", *, reply: struct.Struct
    ) -> tuple[Words, bytes]:
        answer = self._ask(kind, word3, word4, extra)
        if len(answer) == wire.READ_REPLY.size != reply.size:
            raise BufferError_(f"{self.where}: {CmsStatus.describe(wire.READ_REPLY.unpack(answer)[1])}")
        if len(answer) < reply.size:
            raise LinkDown(f"{self.where}: a reply of {len(answer)} bytes came, {reply.size} were due")
        return reply.unpack_from(answer), answer[reply.size :]

    def exchange(
        self, kind: Request, word3: int = 0, word4: int = 0, extra: bytes = b"", *, reply: struct.Struct
    ) -> tuple[Words, bytes]:
        """As ``converse``; a server that has been restarted is told the password again."""
        words, body = self.converse(kind, word3, word4, extra, reply=reply)
        if words[1] == CmsStatus.PERMISSIONS_ERROR and self.process.passwd is not None:
            self.introduce()
            words, body = self.converse(kind, word3, word4, extra, reply=reply)
        return words, body

    def post(self, kind: Request, word3: int, word4: int, extra: bytes) -> None:
        self._ask(kind, word3, word4, extra)


class UdpLink(PacketLink):
    """A link over UDP."""

    def _open(self) -> None:
        self._sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._sock.connect((self.line.host, self.line.udp))
        except OSError as error:
            self._sock.close()
            raise LinkDown(f"{self.where}: {error.strerror or error}") from None

    @property
    def where(self) -> str:
        return f"{self.line.name} at udp:{self.line.host}:{self.line.udp}"

    def _send(self, packet: bytes) -> None:
        self._sock.send(packet)

    def _receive(self, seconds: float) -> bytes | None:
        self._sock.settimeout(seconds)
        try:
            return self._sock.recv(wire.LARGEST_UDP)
        except TimeoutError:
            return None

    def close(self) -> None:
        self._sock.close()


class Line:
    """A serial line, shared by the links of this process and by no other process."""

    _open: ClassVar[dict[str, Line]] = {}

    def __init__(self, device: str, baud: int) -> None:
        self.device = device
        self.port: Any = open_line(device, baud, exclusive=True)
        self.packets: list[bytes] = []
        self.users = 0
        self._unframer = Unframer()

    @classmethod
    def use(cls, device: str, baud: int) -> Line:
        """The line of a device, opened by its first user."""
        line = cls._open.get(device)
        if line is None:
            line = cls._open[device] = cls(device, baud)
        line.users += 1
        return line

    def release(self) -> None:
        """Close the line after its last user."""
        self.users -= 1
        if not self.users:
            del self._open[self.device]
            self.port.close()

    def write(self, data: bytes, seconds: float) -> bool:
        """Send all of ``data``; whether that was possible in time."""
        deadline = host_now() + seconds
        while data:
            _, writable, _ = select.select([], [self.port], [], max(deadline - host_now(), 0.0))
            if not writable:
                return False
            data = data[os.write(self.port.fileno(), data[:_CHUNK]) :]
        return True

    def listen(self, seconds: float) -> bool:
        """Collect what comes; whether anything came."""
        readable, _, _ = select.select([self.port], [], [], seconds)
        if readable:
            self.packets += self._unframer.receive(os.read(self.port.fileno(), _CHUNK))
        return bool(readable)


class SerialLink(PacketLink):
    """A link over a serial line."""

    repeat = SERIAL_REPEAT

    def _open(self) -> None:
        self.device = self.process.serial_port or self.line.serial_port or ""
        self._closed = False
        self._heard = False
        try:
            self._line = Line.use(self.device, self.line.baud)
        except OSError as error:
            raise LinkDown(f"{self.where}: {error}") from None

    @property
    def where(self) -> str:
        return f"{self.line.name} at {self.device}"

    def _send(self, packet: bytes) -> None:
        self._line.packets.clear()
        if not self._line.write(frame(packet), 10.0 if self.timeout is None else self.timeout):
            raise ChannelTimeout(f"{self.process.place}: {self.where}: the line takes nothing")

    def _wait_for_reply(self, until: float, deadline: float) -> bytes | None:
        """As long as bytes come, the answer may be on its way."""
        while True:
            self._heard = False
            reply = super()._wait_for_reply(until, deadline)
            if reply is not None or not self._heard:
                return reply
            until = min(deadline, host_now() + self.repeat)

    def _receive(self, seconds: float) -> bytes | None:
        packets = self._line.packets
        if not packets:
            self._heard |= self._line.listen(seconds)
        return packets.pop(0) if packets else None

    def close(self) -> None:
        if not self._closed:
            self._closed = True
            self._line.release()
