"""Whatever arrives at the server, in whatever pieces: same replies, no exception, bounded memory."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from nml.net import wire
from nml.net.protocol import OUTPUT_LIMIT, Session
from tests.support.fake_desk import FakeDesk, FakeView

WORD = st.one_of(st.integers(0, 20), st.integers(0, wire.MASK), st.sampled_from([0x7FFF_FFFF, 0x8000_0000, wire.MASK]))
REQUEST = st.builds(
    lambda words, extra: wire.REQUEST.pack(*words) + extra,
    st.tuples(WORD, st.integers(0, 20), st.integers(0, 4), WORD, WORD),
    st.binary(max_size=80),
)
TRAFFIC = st.lists(st.one_of(REQUEST, st.binary(max_size=60)), max_size=12).map(b"".join)


def session() -> Session:
    views = FakeDesk(
        n1=FakeView("emcCommand", queue=True, confirm_write=True, can_block=True, messages=[(1, b"abcd")] * 3),
        n2=FakeView(messages=[(7, b"s" * 3876)]),
        n3=FakeView("emcError", queue=True),
    )
    views.agree = lambda checksum: False  # type: ignore[method-assign]
    return Session(views)


def replies(pieces: list[bytes]) -> list[bytes]:
    """What the session answers, without the random keys."""
    one = session()
    out = [one.receive(piece, 0.0) for piece in pieces]
    while not one.closed and (more := one.proceed(0.0)):
        out.append(more)
    return out


@given(TRAFFIC)
@settings(max_examples=100, deadline=None)
def test_no_traffic_makes_a_session_raise_or_hold_more_than_a_request(traffic: bytes) -> None:
    one = session()
    for start in range(0, len(traffic), 64):
        out = one.receive(traffic[start : start + 64], 0.0)
        assert len(out) < OUTPUT_LIMIT + 3896
        one.tick(1.0)
    assert len(one._inbox) <= len(traffic)


@given(st.lists(REQUEST, max_size=8), st.integers(1, 50))
@settings(max_examples=60, deadline=None)
def test_replies_do_not_depend_on_how_the_bytes_arrive(requests: list[bytes], step: int) -> None:
    traffic = b"".join(requests)
    whole = b"".join(replies([traffic]))
    pieces = b"".join(replies([traffic[at : at + step] for at in range(0, len(traffic), step)]))
    assert len(whole) == len(pieces)
