"""Packets: each request is done once, however often it comes, and nothing else gets an answer."""

from __future__ import annotations

import struct

import pytest

from nml.net import wire
from nml.net.packet_ports import PEERS, Peers
from nml.net.wire import Access, CmsStatus, Request
from tests.support.fake_desk import FakeDesk, FakeView


class FakeShelf:
    """Gives every client the same buffers."""

    def __init__(self) -> None:
        self.command = FakeView("emcCommand", queue=True, confirm_write=True)
        self.status = FakeView(messages=[(7, b"abcd")])
        self.open = 0

    def desk(self, origin: str) -> FakeDesk:
        self.open += 1
        desk = FakeDesk(n1=self.command, n2=self.status)
        desk.close = self._closed  # type: ignore[attr-defined]
        return desk

    def _closed(self) -> None:
        self.open -= 1


@pytest.fixture
def shelf() -> FakeShelf:
    return FakeShelf()


@pytest.fixture
def peers(shelf: FakeShelf) -> Peers:
    return Peers(shelf.desk, largest=200)  # type: ignore[arg-type]


def packet(
    kind: int, number: int, serial: int, word3: int = 0, word4: int = 0, rest: bytes = b"", token: int = 1
) -> bytes:
    return wire.PACKET_REQUEST.pack(kind, number, serial, word3, word4, token, 0) + rest


def test_a_reply_has_the_serial_of_its_request(peers: Peers) -> None:
    reply = peers.answer("a", packet(Request.READ, 2, 900, Access.PEEK), 0.0)
    assert reply == struct.pack(">II", 900, 0) + wire.READ_REPLY.pack(1, 2, 4, 7, 0) + b"abcd"


def test_a_repeated_write_is_answered_again_and_done_once(peers: Peers, shelf: FakeShelf) -> None:
    request = packet(Request.WRITE, 1, 5, Access.WRITE, 4, b"body")
    replies = [peers.answer("a", request, 0.0) for _ in range(5)]
    assert len(set(replies)) == 1
    assert shelf.command.written == [b"body"]


def test_two_clients_on_one_address_are_told_apart(peers: Peers, shelf: FakeShelf) -> None:
    for token in (1, 2):
        peers.answer("a", packet(Request.WRITE, 1, 5, Access.WRITE, 1, bytes([token]), token), 0.0)
    assert shelf.command.written == [b"\1", b"\2"]


def test_an_old_request_that_comes_late_is_dropped(peers: Peers, shelf: FakeShelf) -> None:
    peers.answer("a", packet(Request.WRITE, 1, 6, Access.WRITE, 1, b"b"), 0.0)
    assert peers.answer("a", packet(Request.WRITE, 1, 5, Access.WRITE, 1, b"a"), 0.0) is None
    assert shelf.command.written == [b"b"]


def test_serial_numbers_wrap_around(peers: Peers) -> None:
    for serial in (0xFFFF_FFFE, 0xFFFF_FFFF, 0, 1):
        assert peers.answer("a", packet(Request.MESSAGE_COUNT, 2, serial), 0.0) is not None


@pytest.mark.parametrize(
    "bad",
    [
        b"",
        b"x" * 27,
        packet(Request.READ, 2, 1) + b"more",
        packet(Request.WRITE, 1, 1, 4, 10, b"short"),
        packet(Request.WRITE, 1, 1, 4, 0xFFFF_FFFF, b"long"),
        packet(Request.LOGIN, 1, 1),
    ],
)
def test_what_is_no_request_gets_no_answer(peers: Peers, shelf: FakeShelf, bad: bytes) -> None:
    assert peers.answer("a", bad, 0.0) is None
    assert not shelf.command.written


@pytest.mark.parametrize("kind", [Request.SUBSCRIBE, Request.BLOCKING_READ])
def test_what_would_need_several_replies_is_refused(peers: Peers, kind: Request) -> None:
    rest = bytes(wire.EXTRA_BYTES.get(kind, 0))
    reply = peers.answer("a", packet(kind, 2, 1, 1, 100, rest), 0.0)
    assert reply is not None
    assert wire.READ_REPLY.unpack(reply[8:])[1] == CmsStatus.NO_IMPLEMENTATION_ERROR


def test_a_message_that_fits_no_packet_is_refused(peers: Peers, shelf: FakeShelf) -> None:
    shelf.status.messages = [(8, bytes(500))]
    reply = peers.answer("a", packet(Request.READ, 2, 1, Access.PEEK), 0.0)
    assert reply is not None
    assert wire.READ_REPLY.unpack(reply[8:])[1] == CmsStatus.INSUFFICIENT_SPACE_ERROR


def test_clients_are_remembered_up_to_a_number(peers: Peers, shelf: FakeShelf) -> None:
    for token in range(3 * PEERS):
        peers.answer("a", packet(Request.MESSAGE_COUNT, 2, 1, token=token), 0.0)
    assert shelf.open == PEERS
    peers.close()
    assert shelf.open == 0
