"""A partner that fell silent is told from a computer on which everybody stood still."""

from __future__ import annotations

import pytest

from emctask.partner import SignOfLife
from nml import clock


class Partner:
    """A status channel whose writer and whose clock the test moves."""

    def __init__(self) -> None:
        self.now = 100.0
        self.written: float | None = None

    def age(self) -> float | None:
        return None if self.written is None else self.now - self.written


@pytest.fixture
def partner(monkeypatch: pytest.MonkeyPatch) -> Partner:
    one = Partner()
    monkeypatch.setattr(clock, "host_now", lambda: one.now)
    return one


def test_a_partner_that_never_wrote_or_wrote_long_ago_is_not_there(partner: Partner) -> None:
    sign = SignOfLife(partner)
    assert not sign.seen()
    partner.written = 50.0
    assert not sign.seen()
    partner.written = partner.now
    assert sign.seen()


def test_a_partner_is_missed_when_it_writes_nothing_while_task_looks(partner: Partner) -> None:
    sign = SignOfLife(partner)
    partner.written = partner.now
    looks = 0
    while sign.seen():
        partner.now += 0.01
        looks += 1
        assert looks < 100
    assert looks * 0.01 == pytest.approx(0.85, abs=0.02)


def test_a_partner_is_not_blamed_for_a_time_in_which_task_stood_still_too(partner: Partner) -> None:
    sign = SignOfLife(partner)
    partner.written = partner.now
    assert sign.seen()
    partner.now += 30.0
    assert sign.seen()
    partner.now += 0.2
    partner.written = partner.now - 0.1
    assert sign.seen()
