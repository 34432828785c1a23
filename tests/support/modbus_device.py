"""A Modbus device for tests, over TCP or as the far end of a serial line; written from the public specification."""

from __future__ import annotations

import contextlib
import os
import pty
import socket
import struct
import threading
import tty
from collections.abc import Iterator


def checksum(data: bytes) -> bytes:
    """Of a frame on a serial line."""
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            odd = value & 1
            value >>= 1
            if odd:
                value ^= 0xA001
    return bytes([value & 255, value >> 8])


class Device:
    """Number 7. Coils and inputs are numbers 0 or 1; an address that is not there is refused with 2."""

    NUMBER = 7

    def __init__(self) -> None:
        self.coils = dict.fromkeys(range(20), 0)
        self.inputs = {n: int(n % 3 == 0) for n in range(20)}
        self.holding = dict.fromkeys(range(20), 0)
        self.registers = {n: 1000 * n for n in range(20)}

    def answer(self, request: bytes) -> bytes:
        """To a request without its frame."""
        code, address, count = struct.unpack(">BHH", request[:5])
        try:
            return bytes([code]) + self._obey(code, address, count, request[6:], request[3:5])
        except KeyError:
            return bytes([code | 0x80, 2])

    def _obey(self, code: int, address: int, count: int, data: bytes, word: bytes) -> bytes:
        places = range(address, address + count)
        if code in (1, 2):
            table = self.coils if code == 1 else self.inputs
            text = "".join(str(table[n]) for n in reversed(places))
            size = (count + 7) // 8
            return bytes([size]) + int(text, 2).to_bytes(size, "little")
        if code in (3, 4):
            table = self.holding if code == 3 else self.registers
            return bytes([2 * count]) + b"".join(table[n].to_bytes(2, "big") for n in places)
        if code == 5:
            self._store(self.coils, address, int(word == b"\xff\x00"))
        elif code == 6:
            self._store(self.holding, address, int.from_bytes(word, "big"))
        else:
            for offset, n in enumerate(places):
                if code == 15:
                    self._store(self.coils, n, data[offset // 8] >> offset % 8 & 1)
                else:
                    self._store(self.holding, n, int.from_bytes(data[2 * offset : 2 * offset + 2], "big"))
        return address.to_bytes(2, "big") + word

    @staticmethod
    def _store(table: dict[int, int], place: int, value: int) -> None:
        if place not in table:
            raise KeyError(place)
        table[place] = value


@contextlib.contextmanager
def over_tcp(device: Device) -> Iterator[int]:
    """Answer connections one after the other; the port."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        threading.Thread(target=_serve, args=(server, device), daemon=True).start()
        yield server.getsockname()[1]
        server.shutdown(socket.SHUT_RDWR)


def _serve(server: socket.socket, device: Device) -> None:
    with contextlib.suppress(OSError):
        while True:
            connection, _ = server.accept()
            with connection, connection.makefile("rb") as stream:
                while len(head := stream.read(7)) == 7:
                    number, _, length, unit = struct.unpack(">HHHB", head)
                    answer = device.answer(stream.read(length - 1))
                    connection.sendall(struct.pack(">HHHB", number, 0, len(answer) + 1, unit) + answer)


@contextlib.contextmanager
def on_a_line(device: Device) -> Iterator[str]:
    """Answer what comes over a serial line; the name of its near end."""
    far, near = pty.openpty()
    tty.setraw(near)
    threading.Thread(target=_listen, args=(far, device), daemon=True).start()
    try:
        yield os.ttyname(near)
    finally:
        os.close(near)
        os.close(far)


def _listen(line: int, device: Device) -> None:
    frame = b""
    with contextlib.suppress(OSError):
        while True:
            frame += os.read(line, 256)
            if len(frame) >= 8 and checksum(frame[:-2]) == frame[-2:]:
                if frame[0] == device.NUMBER:
                    answer = frame[:1] + device.answer(frame[1:-2])
                    os.write(line, answer + checksum(answer))
                frame = b""
