"""The shared move arithmetic (rs274ngc.moves): limits of the axes, units, joining of short lines, arcs."""

import math

import pytest

from rs274ngc.canon import (
    CANON_CONTINUOUS,
    CANON_EXACT_STOP,
    CANON_UNITS_INCHES,
    CANON_UNITS_MM,
)
from rs274ngc.moves import BLEND, FEED, STOP, TRAVERSE, MoveCanon

ORIGIN = (0.0,) * 6


class Recorder(MoveCanon):
    """Collects what comes out."""

    def __init__(self, *args: float) -> None:
        super().__init__(*args)
        self.lines: list[tuple] = []
        self.arcs: list[tuple] = []

    def line(self, *move):
        self.lines.append(move)

    def arc(self, *move):
        self.arcs.append(move)


@pytest.fixture
def canon() -> Recorder:
    canon = Recorder()
    canon.set_limits([10, 20, 30] + [90] * 3 + [5] * 3, [100, 200, 300] + [900] * 3 + [50] * 3, 0x1FF)
    canon.set_motion_control_mode(CANON_EXACT_STOP, 0.0)
    canon.set_feed_rate(6000.0)
    return canon


def feed(canon: Recorder, x=0.0, y=0.0, z=0.0, a=0.0, u=0.0, line=1) -> None:
    canon.straight_feed(line, x, y, z, a, 0.0, 0.0, u, 0.0, 0.0)


def test_a_rapid_runs_as_fast_as_the_slowest_axis_allows(canon):
    canon.straight_traverse(7, 10.0, 10.0, 0.0, *ORIGIN)
    line, kind, *rest = canon.lines[0]
    end, (vel, ini_maxvel, acc) = rest[:9], rest[9:]
    assert (line, kind) == (7, TRAVERSE)
    assert end == [10.0, 10.0] + [0.0] * 7
    assert vel == ini_maxvel == pytest.approx(10 * math.sqrt(2))  # X needs 1 s for 10 mm
    assert acc == pytest.approx(100 * math.sqrt(2))


def test_a_feed_counts_along_xyz_and_never_exceeds_an_axis(canon):
    canon.set_feed_rate(300.0)
    feed(canon, x=30.0, y=40.0, a=450.0)
    assert canon.lines[0][11] == 5.0
    assert canon.lines[0][12] == pytest.approx(50.0 / 5.0)  # A: 450 degrees at 90 a second


def test_a_rotary_move_is_fed_in_degrees(canon):
    canon.set_feed_rate(600.0)
    feed(canon, a=90.0)
    assert canon.lines[0][11] == 10.0


def test_inches_become_machine_units_for_lengths_but_not_for_angles():
    canon = Recorder()
    canon.use_length_units(CANON_UNITS_INCHES)
    canon.set_feed_rate(60.0)
    feed(canon, x=2.0, a=45.0)
    assert canon.lines[0][2] == pytest.approx(50.8)
    assert canon.lines[0][5] == 45.0
    assert canon.lines[0][11] == pytest.approx(25.4)


def test_a_move_to_where_the_machine_is_makes_nothing(canon):
    feed(canon)
    assert canon.lines == []


def test_motion_modes_become_end_conditions(canon):
    assert canon.term_cond == STOP
    canon.use_length_units(CANON_UNITS_MM)
    canon.set_motion_control_mode(CANON_CONTINUOUS, 0.01)
    assert (canon.term_cond, canon.tolerance) == (BLEND, 0.01)


def test_short_lines_within_the_tolerance_become_one_that_carries_the_last_line_number(canon):
    canon.set_motion_control_mode(CANON_CONTINUOUS, 0.01)
    canon.set_naivecam_tolerance(0.01)
    for i in range(1, 11):
        feed(canon, x=i * 0.1, y=0.00001 if i % 2 else 0.0, line=i)
    canon.flush()
    assert [move[0] for move in canon.lines] == [10]
    assert canon.lines[0][2:4] == (1.0, 0.0)


def test_joining_and_blending_together_stay_within_the_path_tolerance():
    class Tolerances(Recorder):
        def line(self, *move):
            self.lines.append((move[2], self.tolerance))

    canon = Tolerances()
    canon.set_feed_rate(1000.0)
    canon.set_motion_control_mode(CANON_CONTINUOUS, 0.02)
    canon.set_naivecam_tolerance(0.02)
    for x, y in ((1.0, 0.00003), (2.0, 0.0), (3.0, 0.0002), (4.0, 0.0)):  # 0.0002: above its share of the tolerance
        feed(canon, x=x, y=y)
    canon.flush()
    assert [x for x, _ in canon.lines] == [2.0, 3.0, 4.0]
    assert [tolerance for _, tolerance in canon.lines] == pytest.approx([0.01996, 0.02, 0.02])


def test_a_corner_ends_the_joining(canon):
    canon.set_motion_control_mode(CANON_CONTINUOUS, 0.01)
    canon.set_naivecam_tolerance(0.01)
    feed(canon, x=1.0, line=1)
    feed(canon, x=2.0, line=2)
    feed(canon, x=2.0, y=1.0, line=3)
    canon.flush()
    assert [move[0] for move in canon.lines] == [2, 3]
    assert [move[1] for move in canon.lines] == [FEED, FEED]


def test_a_reversal_is_never_joined_away(canon):
    canon.set_motion_control_mode(CANON_CONTINUOUS, 0.01)
    canon.set_naivecam_tolerance(0.5)
    for x in (0.3, 0.1, 0.4):
        feed(canon, x=x)
    canon.flush()
    assert [move[2] for move in canon.lines] == [0.3, 0.1, 0.4]


def test_an_arc_keeps_its_centre_its_turns_and_the_limits_of_its_plane(canon):
    canon.set_end((10.0,) + (0.0,) * 8)
    canon.arc_feed(3, 10.0, 0.0, 0.0, 0.0, -2, 0.0, *ORIGIN)
    move = canon.arcs[0]
    assert move[1:3] == (10.0, 0.0)
    assert move[10:16] == (0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    assert move[16] == -2
    assert move[17:] == pytest.approx((10.0, 10.0, 100.0))  # X is the slower axis of the plane


def test_a_helix_is_held_back_by_the_axis_of_the_helix(canon):
    canon.set_limits([1e3, 1e3, 1.0] + [90] * 6, [1e4] * 9, 0x1FF)
    canon.set_end((10.0,) + (0.0,) * 8)
    canon.arc_feed(3, 10.0, 0.0, 0.0, 0.0, 1, 5.0, *ORIGIN)
    path = math.hypot(2 * math.pi * 10.0, 5.0)
    assert canon.arcs[0][17] == pytest.approx(path / 5.0)


def test_a_flat_arc_joins_with_lines_when_the_tolerance_allows_it(canon):
    canon.set_motion_control_mode(CANON_CONTINUOUS, 0.01)
    canon.set_naivecam_tolerance(0.01)
    feed(canon, x=10.0)
    radius = 20000.0
    canon.arc_feed(2, 11.0, 1.0 / (2 * radius), 10.0, radius, 1, 0.0, *ORIGIN)
    canon.flush()
    assert canon.arcs == []
    assert canon.lines[-1][2] == 11.0
