"""STCP: every line gets its answer, whatever is in it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nml.net.protocol import LOGIN_ATTEMPTS, OUTPUT_LIMIT
from nml.net.stcp import TextSession
from nml.net.wire import LONGEST_LINE, CmsStatus
from tests.support.fake_desk import FakeDesk, FakeView


def views() -> FakeDesk:
    return FakeDesk(n1=FakeView("emcCommand", queue=True), n2=FakeView(messages=[(7, b"+1999,+1,")]))


@pytest.fixture
def desk() -> FakeDesk:
    return views()


@pytest.fixture
def session(desk: FakeDesk) -> TextSession:
    return TextSession(desk)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("name(2):", "name(2):emcStatus"),
        ("peek(2,0):", "peek(2,7):+1999,+1,"),
        ("peek(2):", "peek(2,7):+1999,+1,"),
        ("peek(2,7):", "peek(2,7):"),
        ("read(2,0):", "read(2,7):+1999,+1,"),
        ("write(1):+504,+24,+0,+3,", "write(1,16):"),
        ("write_if_read(1):+504,", "write_if_read(1,16):"),
        ("message_count(2):", "message_count(2):77"),
        ("queue_length(1):", "queue_length(1):3"),
        ("check_if_read(1):", "check_if_read(1):1"),
        ("space(1):", "space(1):8072"),
        ("clear(1):", "clear(1):"),
        ("login(1):operator secret", "login(1):"),
        ("login(1):operator wrong", "ERR:wrong name or password"),
        ("peek(9):", "ERR:no buffer 9"),
        ("fly(1):", "ERR:no verb 'fly'; 'help' lists them"),
        ("peek 2", "ERR:a line is verb(buffer number): or verb(buffer number,id): with a text after the colon"),
        ("peek(-1):", "ERR:a line is verb(buffer number): or verb(buffer number,id): with a text after the colon"),
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_line_gets_its_answer(session: TextSession, line: str, answer: str, end: str) -> None:
    assert session.receive((line + end).encode(), 0.0).decode() == answer + "\r\n"


def test_a_written_text_reaches_the_buffer_as_it_is(session: TextSession, desk: FakeDesk) -> None:
    session.receive(b"write(1):+509,+280,+0,G0\\032X1\\cY\\\\2,\n", 0.0)
    assert desk.views[1].written == [b"+509,+280,+0,G0\\032X1\\cY\\\\2,"]


def test_a_refusal_names_the_status(session: TextSession, desk: FakeDesk) -> None:
    desk.views[1].answer = (0, CmsStatus.QUEUE_FULL)
    assert session.receive(b"write(1):+504,\n", 0.0) == b"ERR:the queue is full (-7)\r\n"


def test_quit_ends_the_connection(session: TextSession) -> None:
    assert session.receive(b"quit\nname(2):\n", 0.0) == b""
    assert session.closed


def test_guessing_ends_the_connection(session: TextSession) -> None:
    session.receive(b"login(1):operator x\n" * LOGIN_ATTEMPTS, 0.0)
    assert session.closed


def test_a_line_without_end_ends_the_connection(session: TextSession) -> None:
    assert session.receive(b"x" * (LONGEST_LINE + 1), 0.0).startswith(b"ERR:a line has at most")
    assert session.closed


def test_answers_are_made_no_further_ahead_than_the_limit(session: TextSession) -> None:
    out = session.receive(b"help\n" * 10_000, 0.0)
    assert OUTPUT_LIMIT <= len(out) < OUTPUT_LIMIT + 1000
    assert session.incomplete


@given(st.lists(st.binary(max_size=60)), st.integers(1, 7))
def test_any_bytes_in_any_pieces_get_the_same_answers(lines: list[bytes], step: int) -> None:
    traffic = b"\n".join([*lines, b"name(2):"]) + b"\n"
    whole, pieces = (TextSession(views()) for _ in range(2))  # type: ignore[arg-type]
    answer = whole.receive(traffic, 0.0)
    assert answer == b"".join(pieces.receive(traffic[at : at + step], 0.0) for at in range(0, len(traffic), step))
    assert whole.closed or answer.endswith(b"name(2):emcStatus\r\n")
