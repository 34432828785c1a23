"""Requests and replies in packets that may get lost: UDP, and the frames of a serial line.

A request is ``wire.PACKET_REQUEST``, then what would follow the five words on TCP; a reply is ``wire.PACKET_REPLY``,
then the reply as on TCP (nothing more where TCP sends none). A client repeats its request until the reply with that
serial comes; the server answers a repeated request with the reply that it gave before, so that a command is never taken
twice. ``packet_links`` has the client's end, ``server`` the loop.
"""

from __future__ import annotations

import os
import select
import socket
from collections import OrderedDict
from collections.abc import Callable

from nml.clock import host_now
from nml.net import wire
from nml.net.protocol import Session
from nml.net.serial_line import Unframer, frame, open_line
from nml.net.served import Desk
from nml.net.streams import Loop
from nml.net.wire import CmsStatus, Request

PEERS = 256
"""Clients that the server remembers; the one that was quiet for longest is forgotten."""
_ONE_REPLY_EACH = (Request.SUBSCRIBE, Request.BLOCKING_READ)
_CHUNK = 4096
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

    def __init__(self, make_desk: Callable[[str], Desk], largest: int = wire.LARGEST_UDP) -> None:
        self._make_desk = make_desk
        self._largest = largest
        self._peers: OrderedDict[tuple[str, int], Peer] = OrderedDict()

    def answer(self, address: str, packet: bytes, now: float) -> bytes | None:
        """The reply to a packet; None for one that is no request, or an old one."""
        if len(packet) < wire.PACKET_REQUEST.size:
            return None
        kind, number, serial, word3, word4, token, checksum = wire.PACKET_REQUEST.unpack_from(packet)
        rest = packet[wire.PACKET_REQUEST.size :]
        expected = word4 if kind == Request.WRITE else wire.EXTRA_BYTES.get(kind, 0)
        if len(rest) != expected:
            return None
        peer = self._peer(address, token)
        if peer.serial == serial:
            return peer.reply
        if peer.serial is not None and (serial - peer.serial) & wire.MASK >= 1 << 31:
            return None
        peer.serial = serial
        native = peer.desk.agree(checksum)
        peer.reply = wire.PACKET_REPLY.pack(serial, native) + self._reply(peer, kind, number, word3, word4, rest, now)
        return peer.reply

    def _reply(self, peer: Peer, kind: int, number: int, word3: int, word4: int, rest: bytes, now: float) -> bytes:
        if kind in _ONE_REPLY_EACH:
            return wire.READ_REPLY.pack(0, CmsStatus.NO_IMPLEMENTATION_ERROR, 0, word4, 1)
        request = wire.REQUEST.pack(peer.count, kind, number, word3, word4) + rest
        peer.count = (peer.count + 1) & wire.MASK
        reply = peer.session.receive(request, now)
        if len(reply) > self._largest - wire.PACKET_REPLY.size:
            return wire.READ_REPLY.pack(peer.count, CmsStatus.INSUFFICIENT_SPACE_ERROR, 0, word4, 1)
        return reply

    def _peer(self, address: str, token: int) -> Peer:
        key = (address, token)
        peer = self._peers.get(key)
        if peer is not None and not peer.session.closed:
            self._peers.move_to_end(key)
            return peer
        if peer is not None:
            self._peers.pop(key).desk.close()
        if len(self._peers) >= PEERS:
            self._peers.popitem(last=False)[1].desk.close()
        peer = self._peers[key] = Peer(self._make_desk(address))
        return peer

    def close(self) -> None:
        """Forget all clients."""
        for peer in self._peers.values():
            peer.desk.close()
        self._peers.clear()


class UdpPort:
    """The server's UDP socket."""

    def __init__(self, address: tuple[str, int], loop: Loop, make_desk: Callable[[str], Desk]) -> None:
        self._loop = loop
        self._peers = Peers(make_desk)
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
                packet, address = self._sock.recvfrom(wire.LARGEST_UDP)
            except OSError:
                return
            reply = self._peers.answer(f"{address[0]}:{address[1]}", packet, host_now())
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


class SerialPort:
    """The server's end of a serial line."""

    def __init__(self, device: str, baud: int, loop: Loop, make_desk: Callable[[str], Desk]) -> None:
        self._loop = loop
        self._peers = Peers(make_desk, wire.LARGEST_FRAME)
        self._device = device
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
                    reply = self._peers.answer(self._device, packet, host_now())
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
