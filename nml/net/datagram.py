"""Requests and replies in packets that may get lost: UDP, and the frames of a serial line.

A request has the words type, buffer number, serial, word 3, word 4 and a token that the client chose, then what
would follow the five words on TCP. A reply is the serial of its request, then the reply as on TCP (nothing more where
TCP sends none). A client repeats its request until the reply with that serial comes; the server answers a repeated
request with the reply that it gave before, so that a command is never taken twice. ``links`` has the client's end.
"""

from __future__ import annotations

import select
import socket
import struct
from collections import OrderedDict
from collections.abc import Hashable

from nml.clock import host_now
from nml.net import wire
from nml.net.protocol import Session
from nml.net.served import Desk, Shelf
from nml.net.streams import Loop
from nml.net.wire import CmsStatus, Request

HEADER = struct.Struct(">IIIIII")
"""type, buffer number, serial, word 3, word 4, token"""
SERIAL = struct.Struct(">I")
LARGEST = 65507
"""Bytes of the largest UDP packet."""
PEERS = 256
"""Clients that the server remembers; the one that was quiet for longest is forgotten."""
_ONE_REPLY_EACH = (Request.SUBSCRIBE, Request.BLOCKING_READ)
_TURN = 64
"""Packets taken before other links have their turn."""


class Peer:
    """What the server remembers of a client."""

    __slots__ = ("count", "desk", "reply", "serial", "session")

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.session = Session(desk)
        self.count = 0
        self.serial: int | None = None
        self.reply = b""


class Peers:
    """Answers packets, for clients that are told apart by address and token."""

    def __init__(self, shelf: Shelf, largest: int = LARGEST) -> None:
        self._shelf = shelf
        self._largest = largest
        self._peers: OrderedDict[Hashable, Peer] = OrderedDict()

    def answer(self, address: Hashable, packet: bytes, now: float) -> bytes | None:
        """The reply to a packet; None for one that is no request, or an old one."""
        if len(packet) < HEADER.size:
            return None
        kind, number, serial, word3, word4, token = HEADER.unpack_from(packet)
        rest = packet[HEADER.size :]
        expected = word4 if kind == Request.WRITE else wire.EXTRA_BYTES.get(kind, 0)
        if len(rest) != expected:
            return None
        peer = self._peer((address, token))
        if peer.serial == serial:
            return peer.reply
        if peer.serial is not None and (serial - peer.serial) & wire.MASK >= 1 << 31:
            return None
        peer.serial = serial
        peer.reply = SERIAL.pack(serial) + self._reply(peer, kind, number, word3, word4, rest, now)
        return peer.reply

    def _reply(self, peer: Peer, kind: int, number: int, word3: int, word4: int, rest: bytes, now: float) -> bytes:
        if kind in _ONE_REPLY_EACH:
            return wire.READ_REPLY.pack(0, CmsStatus.NO_IMPLEMENTATION_ERROR, 0, word4, 1)
        request = wire.REQUEST.pack(peer.count, kind, number, word3, word4) + rest
        peer.count = (peer.count + 1) & wire.MASK
        reply = peer.session.receive(request, now)
        if len(reply) > self._largest - SERIAL.size:
            return wire.READ_REPLY.pack(peer.count, CmsStatus.INSUFFICIENT_SPACE_ERROR, 0, word4, 1)
        return reply

    def _peer(self, key: Hashable) -> Peer:
        peer = self._peers.get(key)
        if peer is not None and not peer.session.closed:
            self._peers.move_to_end(key)
            return peer
        if peer is not None:
            self._peers.pop(key).desk.close()
        if len(self._peers) >= PEERS:
            self._peers.popitem(last=False)[1].desk.close()
        peer = self._peers[key] = Peer(self._shelf.desk())
        return peer

    def close(self) -> None:
        """Forget all clients."""
        for peer in self._peers.values():
            peer.desk.close()
        self._peers.clear()


class UdpPort:
    """The server's UDP socket."""

    def __init__(self, address: tuple[str, int], loop: Loop, shelf: Shelf) -> None:
        self._loop = loop
        self._peers = Peers(shelf)
        family = socket.AF_INET6 if ":" in address[0] else socket.AF_INET
        self._sock = socket.socket(family, socket.SOCK_DGRAM)
        try:
            self._sock.bind(address)
        except OSError:
            self._sock.close()
            raise
        self._sock.setblocking(False)
        loop.watch(self._sock.fileno(), self, select.EPOLLIN)

    def ready(self, events: int) -> None:
        """Answer the packets that wait; one that cannot be sent now is lost, and its client will repeat it."""
        for _ in range(_TURN):
            try:
                packet, address = self._sock.recvfrom(LARGEST)
            except OSError:
                return
            reply = self._peers.answer(address, packet, host_now())
            if reply is not None:
                try:
                    self._sock.sendto(reply, address)
                except OSError:
                    continue

    def close(self) -> None:
        if self._sock.fileno() >= 0:
            self._loop.forget(self._sock.fileno())
            self._sock.close()
            self._peers.close()
