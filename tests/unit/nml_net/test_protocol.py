"""What the server answers to each request, byte by byte; expected bytes were seen on the wire of LinuxCNC 2.9."""

from __future__ import annotations

import struct

import pytest

from nml.net import wire
from nml.net.protocol import LOGIN_ATTEMPTS, OUTPUT_LIMIT, Session
from nml.net.wire import CmsStatus, Request
from tests.support.fake_desk import FakeDesk, FakeView


def words(*numbers: int) -> bytes:
    return b"".join(struct.pack(">I", number & wire.MASK) for number in numbers)


@pytest.fixture
def status() -> FakeView:
    return FakeView(messages=[(0x14B1F, b"\0\0\7\xcf" + bytes(3872))])


@pytest.fixture
def command() -> FakeView:
    return FakeView("emcCommand", queue=True, confirm_write=True)


@pytest.fixture
def session(status: FakeView, command: FakeView) -> Session:
    return Session(FakeDesk(n1=command, n2=status, n3=FakeView("emcError", queue=True)))


def test_the_name_of_a_buffer_fills_forty_bytes(session: Session) -> None:
    reply = session.receive(words(0, 12, 2, 0, 0), 0.0)
    assert reply == words(1, 0) + b"emcStatus".ljust(32, b"\0")


def test_a_peek_brings_the_newest_message_and_its_id(session: Session) -> None:
    session.receive(words(0, 12, 2, 0, 0), 0.0)
    reply = session.receive(words(1, 1, 2, 3, 0), 0.0)
    assert reply[:20] == words(2, 2, 0xF24, 0x14B1F, 0)
    assert len(reply) == 20 + 3876


def test_a_peek_with_the_newest_id_brings_nothing(session: Session) -> None:
    assert session.receive(words(0, 1, 2, 3, 0x14B1F), 0.0) == words(1, 1, 0, 0x14B1F, 1)


def test_a_read_marks_the_message_as_read(session: Session, status: FakeView) -> None:
    assert session.receive(words(0, 1, 2, 1, 0), 0.0)[16:20] == words(1)
    assert status.seen


@pytest.mark.parametrize("access", [0, 2, 4, 0xFFFF_FFFF])
def test_an_unknown_access_of_a_read_gets_status_zero(session: Session, access: int) -> None:
    assert session.receive(words(0, 1, 2, access, 5), 0.0) == words(1, 0, 0, 5, 1)


def test_a_confirmed_write_is_answered_with_the_id_of_the_message(session: Session, command: FakeView) -> None:
    session.receive(words(0, 12, 1, 0, 0), 0.0)
    body = words(0x1F8, 0x18, 0, 3)
    assert session.receive(words(1, 2, 1, 4, 16) + body, 0.0) == words(16, 3, 0)
    assert command.written == [body]


def test_a_write_without_confirmation_gets_no_reply_but_counts_as_a_request(session: Session) -> None:
    assert session.receive(words(0, 2, 2, 4, 4) + b"abcd", 0.0) == b""
    assert session.receive(words(1, 16, 2, 0, 0), 0.0)[:4] == words(2)
    assert session.errors == 0


@pytest.mark.parametrize(
    ("kind", "value"),
    [(Request.CHECK_IF_READ, 1), (Request.MESSAGE_COUNT, 77), (Request.QUEUE_LENGTH, 3), (Request.SPACE, 8072)],
)
def test_small_questions_are_answered_in_twelve_bytes(session: Session, kind: Request, value: int) -> None:
    assert session.receive(words(0, kind, 1, 0, 0), 0.0) == words(1, 0, value)


def test_clear_answers_cleared(session: Session, command: FakeView) -> None:
    command.messages.append((1, b"x"))
    assert session.receive(words(0, 5, 1, 0, 0), 0.0) == words(1, 5)
    assert not command.messages


def test_clean_does_not_end_anything_and_gets_no_reply(session: Session) -> None:
    assert session.receive(words(0, 4, 2, 0, 0) + words(1, 16, 2, 0, 0), 0.0) == words(2, 0, 77)
    assert not session.closed


def test_close_ends_the_connection_without_a_reply(session: Session) -> None:
    assert session.receive(words(0, 6, 2, 0, 0) + words(1, 16, 2, 0, 0), 0.0) == b""
    assert session.closed


@pytest.mark.parametrize("kind", [0, 10, 13, 19, 100, 0xFFFF_FFFF])
def test_unknown_requests_get_no_reply_and_the_next_one_works(session: Session, kind: int) -> None:
    assert session.receive(words(0, kind, 2, 0, 0), 0.0) == b""
    assert session.receive(words(1, 16, 2, 0, 0), 0.0) == words(2, 0, 77)
    assert session.errors == 1


@pytest.mark.parametrize(
    ("kind", "extra", "expected"),
    [
        (1, 0, words(1, -15, 0, 0, 0)),
        (3, 0, words(1, -15, 0)),
        (5, 0, words(1, -15)),
        (7, 16, words(1, -15, 0, 0, 0)),
        (8, 32, words(1, 0)),
        (9, 0, words(1, 0)),
        (11, 4, words(1, -15, 0, 0, 0)),
        (12, 0, words(1, -15) + bytes(32)),
        (14, 68, b""),
        (15, 0, words(1, -15) + bytes(16)),
        (16, 0, words(1, -15, 0)),
        (18, 0, words(1, -15, 0)),
    ],
)
def test_requests_for_an_unknown_buffer_get_an_error_of_the_usual_length(
    session: Session, kind: int, extra: int, expected: bytes
) -> None:
    assert session.receive(words(0, kind, 99, 0, 0) + bytes(extra), 0.0) == expected
    assert session.receive(words(1, 16, 1, 0, 0), 0.0) == words(2, 0, 77)


def test_a_write_to_an_unknown_buffer_is_passed_over(session: Session) -> None:
    assert session.receive(words(0, 2, 99, 4, 100) + bytes(60), 0.0) == b""
    assert session.receive(bytes(40) + words(1, 16, 1, 0, 0), 0.0) == words(2, 0, 77)


def test_a_body_that_is_too_long_is_passed_over_and_refused(session: Session, command: FakeView) -> None:
    assert session.receive(words(0, 2, 1, 4, 4097), 0.0) == words(0, -13, 0)
    for _ in range(4097):
        assert session.receive(b"x", 0.0) == b""
    assert session.receive(words(1, 16, 1, 0, 0), 0.0) == words(2, 0, 77)
    assert not command.written


def test_a_wrong_serial_is_answered_in_its_own_count_and_never_ends_the_connection(session: Session) -> None:
    for turn in range(200):
        assert session.receive(words(turn * 7 + 3, 16, 2, 0, 0), 0.0) == words(turn * 7 + 4, 0, 77)
    assert session.errors == 200


def test_serial_numbers_wrap_around(session: Session) -> None:
    assert session.receive(words(0xFFFF_FFFF, 16, 2, 0, 0), 0.0) == words(0, 0, 77)
    assert session.receive(words(0, 16, 2, 0, 0), 0.0) == words(1, 0, 77)
    assert session.errors == 1


def test_keys_are_eight_random_characters_twice(session: Session) -> None:
    first = session.receive(words(0, 7, 1, 0, 0) + b"operator".ljust(16, b"\0"), 0.0)
    second = session.receive(words(1, 7, 1, 0, 0) + bytes(16), 0.0)
    assert len(first) == 20
    assert first[4:].isalnum()
    assert first[4:] != second[4:]


def test_keys_serve_one_login_only(session: Session, command: FakeView) -> None:
    keys = session.receive(words(0, 7, 1, 0, 0) + bytes(16), 0.0)[4:]
    login = b"operator".ljust(16, b"\0") + b"secret".ljust(16, b"\0")
    assert session.receive(words(1, 8, 1, 0, 0) + login, 0.0) == words(2, 1)
    assert command.challenge == keys
    session.receive(words(2, 8, 1, 0, 0) + login, 0.0)
    assert command.challenge == b""


def test_guessing_passwords_ends_the_connection(session: Session) -> None:
    login = b"operator".ljust(16, b"\0") + b"wrong".ljust(16, b"\0")
    for turn in range(LOGIN_ATTEMPTS):
        assert not session.closed
        assert session.receive(words(turn, 8, 1, 0, 0) + login, 0.0) == words(turn + 1, 0)
    assert session.closed


def test_diagnostics_of_a_buffer_without_them_get_twenty_four_bytes(session: Session, command: FakeView) -> None:
    info = wire.DIAG_INFO.pack(b"xemc", b"host", 4711, 1, struct.pack("<d", 2.0), struct.pack("<I", 0x11223344))
    assert session.receive(words(0, 14, 1, 0, 0) + info, 0.0) == b""
    assert command.introduced == info
    assert session.receive(words(1, 15, 1, 0, 0), 0.0) == words(2, -15) + bytes(16)


def test_a_blocking_read_without_a_semaphore_is_refused_at_once(session: Session) -> None:
    for timeout, expected in ((-1, -16), (500, -16), (0, 1)):
        serial = session.requests
        reply = session.receive(words(serial, 11, 3, 1, 0, timeout), 0.0)
        assert reply == words(serial + 1, expected, 0, 0, 1)


def test_a_blocking_read_is_answered_when_a_message_comes(session: Session, command: FakeView) -> None:
    command.can_block = True
    assert session.receive(words(0, 11, 1, 1, 0, 500) + words(1, 16, 1, 0, 0), 10.0) == b""
    assert session.due <= 10.5
    assert session.tick(10.1) == b""
    command.messages.append((5, b"abcd"))
    assert session.tick(10.2) == words(1, 2, 4, 5, 1) + b"abcd" + words(2, 0, 77)


def test_a_blocking_read_ends_with_its_timeout(session: Session, command: FakeView) -> None:
    command.can_block = True
    session.receive(words(0, 11, 1, 1, 9, 500), 10.0)
    assert session.tick(10.499) == b""
    assert session.tick(10.5) == words(1, CmsStatus.TIMED_OUT, 0, 9, 1)
    assert session.due == float("inf")


def test_a_client_that_goes_on_during_a_blocking_read_is_held_up(session: Session, command: FakeView) -> None:
    command.can_block = True
    session.receive(words(0, 11, 1, 1, 0, -1), 0.0)
    session.receive(bytes(OUTPUT_LIMIT + 1), 0.0)
    assert session.congested


def test_a_subscription_pushes_each_message_once_and_counts_serials(session: Session, status: FakeView) -> None:
    assert session.receive(words(0, 9, 2, 1, 100), 0.0) == words(1, 1)
    assert session.due == pytest.approx(0.1)
    assert session.tick(0.05) == b""
    assert session.tick(0.1)[:20] == words(2, 2, 3876, 0x14B1F, 1)
    assert session.tick(0.2) == b""
    status.messages.append((0x14B20, b"new!"))
    assert session.tick(0.35) == words(3, 2, 4, 0x14B20, 1) + b"new!"
    assert session.receive(words(3, 16, 2, 0, 0), 0.4) == words(4, 0, 77)
    assert session.errors == 0


def test_a_subscription_ends_and_the_connection_goes_on(session: Session) -> None:
    session.receive(words(0, 9, 2, 3, 0), 0.0)
    assert session.receive(words(1, 9, 2, 2, 0), 0.0) == words(2, 1)
    assert session.due == float("inf")
    assert session.tick(5.0) == b""
    assert session.receive(words(2, 16, 2, 0, 0), 0.0) == words(3, 0, 77)


def test_replies_are_made_no_further_ahead_than_the_limit(session: Session) -> None:
    request = b"".join(words(turn, 1, 2, 3, 0) for turn in range(1000))
    out = session.receive(request, 0.0)
    assert OUTPUT_LIMIT <= len(out) < OUTPUT_LIMIT + 3896
    replies = len(out)
    while out := session.proceed(0.0):
        replies += len(out)
    assert replies == 1000 * 3896
    assert not session.incomplete


def test_a_client_of_ours_learns_that_both_ends_agree(session: Session) -> None:
    reply = session.receive(words(0, 12, 2, wire.EXTENDED_MAGIC, 12345), 0.0)
    assert reply == words(1, 0) + b"emcStatus".ljust(28, b"\0") + wire.EXTENDED_MARK
    other = session.receive(words(1, 12, 2, wire.EXTENDED_MAGIC, 999), 0.0)
    assert other == words(2, 0) + b"emcStatus".ljust(32, b"\0")
