"""Connections to Modbus devices: TCP, and a serial line (RTU). ``exchange`` sends a request and returns the answer.

A link opens itself when it is needed. After an error it is closed, so that the next exchange begins anew.
"""

from __future__ import annotations

import itertools
import socket
import struct
from dataclasses import dataclass
from typing import Protocol

import serial  # type: ignore[import-untyped]

from hal.modbus.protocol import ModbusError, answer_length, crc

HEAD = struct.Struct(">HHHB")
"""Number of the exchange, 0, bytes that follow, device."""


@dataclass(frozen=True, slots=True)
class Timeouts:
    """How long a device may take: for the first byte of an answer, and from byte to byte; seconds of host time."""

    response: float
    byte: float


class Link(Protocol):
    """What both kinds of link do."""

    def exchange(self, device: int, request: bytes, timeouts: Timeouts) -> bytes:
        """Send a request; the answer. ModbusError when none comes."""

    def close(self) -> None:
        """Hang up."""


@dataclass(frozen=True, slots=True)
class TcpPlace:
    """Where a TCP device is."""

    address: str
    port: int


@dataclass(frozen=True, slots=True)
class SerialPlace:
    """A serial line and how it is set."""

    device: str
    baud: int
    bits: int
    parity: str
    """N, E or O."""
    stop: int


class TcpLink:
    """Modbus TCP."""

    def __init__(self, place: TcpPlace) -> None:
        self._place = place
        self._socket: socket.socket | None = None
        self._numbers = itertools.count(1)

    def exchange(self, device: int, request: bytes, timeouts: Timeouts) -> bytes:
        """Answers to earlier requests, which came too late, are passed over."""
        try:
            connection = self._opened(timeouts.response)
            number = next(self._numbers) & 0xFFFF
            connection.settimeout(timeouts.response)
            connection.sendall(HEAD.pack(number, 0, 1 + len(request), device) + request)
            while True:
                answered, _, length, _ = HEAD.unpack(self._receive(connection, HEAD.size))
                connection.settimeout(timeouts.byte)
                answer = self._receive(connection, length - 1)
                if answered == number:
                    return answer
        except (OSError, struct.error) as error:
            self.close()
            raise ModbusError(f"{self._place.address}:{self._place.port}: {error}") from None

    def _opened(self, seconds: float) -> socket.socket:
        if self._socket is None:
            self._socket = socket.create_connection((self._place.address, self._place.port), seconds)
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return self._socket

    @staticmethod
    def _receive(connection: socket.socket, count: int) -> bytes:
        data = b""
        while len(data) < count:
            part = connection.recv(count - len(data))
            if not part:
                raise OSError("the device hung up")
            data += part
        return data

    def close(self) -> None:
        """The next exchange connects again."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None


class SerialLink:
    """Modbus RTU."""

    def __init__(self, place: SerialPlace) -> None:
        self._place = place
        self._line: serial.Serial | None = None

    def exchange(self, device: int, request: bytes, timeouts: Timeouts) -> bytes:
        """What is left of an earlier answer is thrown away first."""
        try:
            line = self._opened()
            line.reset_input_buffer()
            frame = bytes([device]) + request
            line.write(frame + crc(frame))
            line.timeout = timeouts.response
            frame = self._receive(line, 2)
            line.timeout = timeouts.byte
            frame += self._receive(line, 1)
            frame += self._receive(line, answer_length(frame[1:]) + 3 - len(frame))
        except (OSError, serial.SerialException) as error:
            self.close()
            raise ModbusError(f"{self._place.device}: {error}") from None
        if crc(frame[:-2]) != frame[-2:]:
            raise ModbusError(f"{self._place.device}: the checksum of the answer is wrong")
        if frame[0] != device:
            raise ModbusError(f"{self._place.device}: device {frame[0]} answered, device {device} was asked")
        return bytes(frame[1:-2])

    def _opened(self) -> serial.Serial:
        if self._line is None:
            place = self._place
            self._line = serial.Serial(place.device, place.baud, place.bits, place.parity, place.stop)
        return self._line

    @staticmethod
    def _receive(line: serial.Serial, count: int) -> bytes:
        data = bytes(line.read(count))
        if len(data) < count:
            raise OSError("the device does not answer")
        return data

    def close(self) -> None:
        """The next exchange opens the line again."""
        if self._line is not None:
            self._line.close()
            self._line = None


def make_link(place: TcpPlace | SerialPlace) -> Link:
    """The link to a place."""
    return TcpLink(place) if isinstance(place, TcpPlace) else SerialLink(place)
