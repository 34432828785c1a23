"""The words of the remote protocol: request types, access kinds, status codes, limits and the packers of every frame.

Shared by both ends of TCP, UDP and serial links. All integers on the wire are 32 bits, big endian; a request starts
with five words (serial, type, buffer number and two that depend on the type). ``docs/nml-remote.md`` has the page that
describes every frame byte by byte.
"""

from __future__ import annotations

import struct
from enum import IntEnum

REQUEST = struct.Struct(">IIIII")
"""serial, type, buffer number, word 3, word 4"""
READ_REPLY = struct.Struct(">IiIII")
"""serial, status, length of the encoded message, its id, was_read"""
SHORT_REPLY = struct.Struct(">Iii")
"""serial (write: id of the message), status, value"""
STATUS_REPLY = struct.Struct(">Ii")
"""serial, status"""
NAME_REPLY = struct.Struct(">Ii32s")
"""serial, status, buffer name"""
KEYS_REPLY = struct.Struct(">I8s8s")
"""serial, first and second half of the challenge of a login"""
LOGIN = struct.Struct(">16s16s")
"""user name, password or proof"""
DIAG_INFO = struct.Struct(">16s32sII8s4s")
"""process name, host, process id, connection number, library version (double), 0x11223344; the last two native"""

PACKET_REQUEST = struct.Struct(">IIIIIII")
"""On UDP and serial lines: type, buffer number, serial, word 3, word 4, token of the client, vocabulary checksum"""
PACKET_REPLY = struct.Struct(">II")
"""serial of the request, 1 if messages are native images; the reply as on TCP follows"""
LARGEST_UDP = 65507
LARGEST_FRAME = 1 << 20
"""Bytes of the longest frame that is collected from a serial line."""
LONGEST_LINE = 1 << 20
"""Bytes of the longest line of STCP."""

MASK = 0xFFFF_FFFF
NAME_LENGTH = 31
"""Characters of a buffer name that both ends compare."""

EXTENDED_MAGIC = 0x70794D31
"""Word 3 of a name request from a client that takes native images; word 4 is then ``vocabulary_checksum()``."""
EXTENDED_MARK = b"pyM1"
"""Last four bytes of the name field in the reply when both ends have the same vocabulary."""

DEFAULT_PORT = 5005
BODY_FACTOR = 4
"""A write may announce at most this many times the size of the buffer."""


class Request(IntEnum):
    """Word 1 of a request."""

    READ = 1
    WRITE = 2
    CHECK_IF_READ = 3
    CLEAN = 4
    CLEAR = 5
    CLOSE = 6
    GET_KEYS = 7
    LOGIN = 8
    SUBSCRIBE = 9
    BLOCKING_READ = 11
    GET_NAME = 12
    SET_DIAG = 14
    GET_DIAG = 15
    MESSAGE_COUNT = 16
    QUEUE_LENGTH = 17
    SPACE = 18


EXTRA_BYTES = {Request.GET_KEYS: 16, Request.LOGIN: 32, Request.BLOCKING_READ: 4, Request.SET_DIAG: 68}
"""What follows the five words, where that is a fixed number of bytes; a write is followed by ``word 4`` bytes."""


class Access(IntEnum):
    """Word 3 of reads and writes."""

    READ = 1
    PEEK = 3
    WRITE = 4
    WRITE_IF_READ = 5


class Subscription(IntEnum):
    """Word 3 of a subscription."""

    POLLED = 1
    NONE = 2
    VARIABLE = 3


class CmsStatus(IntEnum):
    """Word 1 of a reply."""

    NOT_SET = 0
    READ_OLD = 1
    READ_OK = 2
    WRITE_OK = 3
    WRITE_WAS_BLOCKED = 4
    CLEARED = 5
    CLOSED = 6
    MISC_ERROR = -1
    UPDATE_ERROR = -2
    INTERNAL_ACCESS_ERROR = -3
    NO_MASTER_ERROR = -4
    CONFIG_ERROR = -5
    TIMED_OUT = -6
    QUEUE_FULL = -7
    CREATE_ERROR = -8
    PERMISSIONS_ERROR = -9
    NO_SERVER_ERROR = -10
    RESOURCE_CONFLICT_ERROR = -11
    NO_IMPLEMENTATION_ERROR = -12
    INSUFFICIENT_SPACE_ERROR = -13
    LIBRARY_UNAVAILABLE_ERROR = -14
    SERVER_SIDE_ERROR = -15
    NO_BLOCKING_SEM_ERROR = -16

    @property
    def meaning(self) -> str:
        """The status in words, for error texts."""
        return _MEANINGS.get(self, self.name.replace("_", " ").lower())

    @classmethod
    def describe(cls, number: int) -> str:
        """The meaning of a status number from the wire, known or not."""
        try:
            return f"{cls(number).meaning} ({number})"
        except ValueError:
            return f"status {number}"


_MEANINGS = {
    CmsStatus.UPDATE_ERROR: "the message could not be decoded",
    CmsStatus.TIMED_OUT: "the buffer was in use by another process for too long",
    CmsStatus.QUEUE_FULL: "the queue is full",
    CmsStatus.PERMISSIONS_ERROR: "the server's process line or password file does not allow that",
    CmsStatus.INSUFFICIENT_SPACE_ERROR: "the message is too large for the buffer",
    CmsStatus.SERVER_SIDE_ERROR: "the server does not have this buffer",
    CmsStatus.NO_BLOCKING_SEM_ERROR: "the buffer has no bsem, so nobody can wait for it",
    CmsStatus.WRITE_WAS_BLOCKED: "the message before it has not been read yet",
}
