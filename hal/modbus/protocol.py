"""Modbus requests and answers as bytes, by the public specification; knows no connection and no pins.

A request is a function code with its data (a PDU); ``links`` puts the frame of TCP or of a serial line around it.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

from nml.errors import PyemcError

REFUSED = 0x80
"""Added to the function code by a device that refuses."""
COIL_ON = 0xFF00
WORD = 0xFFFF
MOST_BITS_READ, MOST_WORDS_READ, MOST_BITS_WRITTEN, MOST_WORDS_WRITTEN = 2000, 125, 1968, 123
REASONS = {
    1: "illegal function",
    2: "illegal data address",
    3: "illegal data value",
    4: "the device failed",
    5: "acknowledged, it takes long",
    6: "the device is busy",
    7: "negative acknowledge",
    8: "memory parity error",
    10: "no path through the gateway",
    11: "the device behind the gateway does not answer",
}


class ModbusError(PyemcError):
    """A device refused, answered nonsense or not at all."""


@dataclass(frozen=True, slots=True)
class Function:
    """What a transaction does: its code in the protocol, whether it writes, and whether it is about bits."""

    code: int
    writes: bool
    bits: bool
    most: int
    """Elements of one transaction at most."""


def read_request(function: Function, address: int, count: int) -> bytes:
    """Ask for ``count`` elements from ``address`` on."""
    return struct.pack(">BHH", function.code, address, count)


def write_requests(function: Function, address: int, values: Sequence[int]) -> list[bytes]:
    """Set elements from ``address`` on; functions for a single element need a request for each."""
    if function.code in (5, 6):
        on = COIL_ON if function.bits else 1
        return [struct.pack(">BHH", function.code, address + n, value * on) for n, value in enumerate(values)]
    count = len(values)
    if function.bits:
        packed = sum(value << n for n, value in enumerate(values)).to_bytes((count + 7) // 8, "little")
    else:
        packed = struct.pack(f">{count}H", *values)
    return [struct.pack(">BHHB", function.code, address, count, len(packed)) + packed]


def answer_length(head: bytes) -> int:
    """How long an answer is whose first two bytes are these."""
    code, second = head[0], head[1]
    if code & REFUSED:
        return 2
    return 2 + second if code <= 4 else 5


def values(function: Function, count: int, answer: bytes) -> list[int]:
    """The elements of an answer to ``read_request``."""
    check(function, answer)
    data = answer[2:]
    size = (count + 7) // 8 if function.bits else 2 * count
    if answer[1] != size or len(data) != size:
        raise ModbusError(f"{len(data)} bytes came, {size} were asked for")
    if function.bits:
        return [data[n // 8] >> n % 8 & 1 for n in range(count)]
    return list(struct.unpack(f">{count}H", data))


def check(function: Function, answer: bytes) -> None:
    """ModbusError when the device refused, or answered something else."""
    if len(answer) < 2:
        raise ModbusError("the answer is too short")
    if answer[0] == function.code | REFUSED:
        raise ModbusError(f"refused with {answer[1]}: {REASONS.get(answer[1], 'unknown reason')}")
    if answer[0] != function.code:
        raise ModbusError(f"answer to function {answer[0]}, function {function.code} was asked for")


def crc(frame: bytes) -> bytes:
    """The checksum of a frame on a serial line."""
    register = WORD
    for byte in frame:
        register ^= byte
        for _ in range(8):
            register = register >> 1 ^ (0xA001 if register & 1 else 0)
    return register.to_bytes(2, "little")
