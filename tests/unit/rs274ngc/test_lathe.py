"""The lathe cycles: the profile's geometry by itself, and G70 to G72 in programs."""

import pytest

from nml.errors import InterpError
from rs274ngc.profile import Arc, Frame, Line, ProfileError, Roughing, at_distance, passes, rounded

PROFILE = "o100 sub\ng0 x8 z0\ng1 x2 z-2\ng1 x6 z-4\ng1 x4 z-6\ng1 x9 z-8\no100 endsub\n"
LATHE = "g21 g18 f400\ng0 x10 z1\n" + PROFILE


def feeds(canon):
    """X and Z of the feeds and arcs, in order."""
    ends = []
    for name, call in canon.calls:
        if name == "straight_feed":
            ends.append((round(call[1], 4), round(call[3], 4)))
        elif name == "arc_feed":
            ends.append((round(call[2], 4), round(call[1], 4)))
    return ends


def test_roughing_cuts_level_by_level_and_ends_along_the_profile(run):
    cut = feeds(run(LATHE + "g71 q100 d0 i4 r.3\nm2\n"))
    assert cut == [
        (10, -8), (6, -0.6667), (6, -4), (6, -0.6667), (2, -2), (6, -4), (6, -4), (6, -6.8), (6, -4), (4, -6), (9, -8),
        (10, -8),
    ]  # fmt: skip


def test_the_cycle_without_pockets_goes_over_them(run):
    cut = feeds(run(LATHE + "g71.1 q100 d0 i4 r.3\nm2\n"))
    assert cut[-4:] == [(6, -4), (6, -6.8), (9, -8), (10, -8)]


def test_the_second_cycle_only_cuts_later_pockets(run):
    cut = feeds(run(LATHE + "g71.2 q100 d0 i4 r.3\nm2\n"))
    assert cut == [(2, -2), (6, -4), (6, -4), (6, -6.8), (6, -4), (4, -6), (9, -8), (10, -8)]


def test_facing_exchanges_the_axes(run):
    profile = "o100 sub\ng0 x0 z-5\ng1 x5 z-3\ng1 x9 z0\no100 endsub\n"
    canon = run("g21 g18 f400\ng0 x-3 z1\n" + profile + "g72 q100 d0 i2 r.3\nm2\n")
    assert feeds(canon) == [(9, 1), (7.6667, -1), (5, -3), (5, -3), (9, 0), (9, 1)]


def test_finishing_approaches_the_profile_in_passes(run):
    canon = run("g21 g18 f400\ng0 x20 z1\no1 sub\ng0 x4 z0\ng1 x4 z-9\no1 endsub\ng70 q1 d3 e1 p2\nm2\n")
    assert feeds(canon) == [(6, -9), (5, -9)]
    assert passes(3.0, 1.0, 2) == [2.0, 1.0]


def test_words_of_the_profile_make_increments_fillets_and_chamfers(run):
    profile = "o1 sub\ng0 x4 z0\ng1 u3 a.5\nw-4 c1\nu2\no1 endsub\n"
    assert feeds(run("g21 g18 f400\ng0 x20 z2\n" + profile + "g70 q1\nm2\n")) == [
        (6.5, 0), (7, -0.5), (7, -3), (8, -4), (9, -4),
    ]  # fmt: skip


def test_a_profile_sees_parameters_and_where_it_has_come_to(run):
    profile = "o1 sub\ng0 x4 z0\no2 repeat [2]\ng1 x[#<_x>+1] z[#5422-2]\no2 endrepeat\no1 endsub\n"
    assert feeds(run("g21 g18 f400\ng0 x20 z2\n" + profile + "g70 q1\nm2\n")) == [(5, -2), (6, -4)]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("g71", "G7x.x  requires a Q word"),
        ("g17 g71 q100", r"G71.0 can only be used in XZ plane \(G18\)"),
        ("g41.1 d1\ng72.1 q100", "G72.1 cannot be used with cutter compensation enabled"),
        ("g71 q100 i0", "G7X error: I must be greater than zero."),
        ("g71 q100 i0.000001", "Too many passes in G71 or G72"),
        ("g71 q7", "seeking o-word: o<7>"),
    ],
)
def test_a_wrong_cycle_is_refused(run, line, message):
    with pytest.raises(InterpError, match=message):
        run(LATHE + line + "\nm2\n")


def test_a_profile_that_goes_back_is_refused_at_the_cycle(run):
    with pytest.raises(InterpError, match="Not monotonic") as refused:
        run("g21 g18 f400\ng0 x10 z1\no1 sub\ng0 x4 z0\ng1 x5 z-3\ng1 x6 z-1\no1 endsub\ng71 q1\nm2\n")
    assert refused.value.place.line == 8


def test_arcs_are_cut_at_their_levels():
    dip = Arc(0 + 5j, 10 + 5j, 5 + 5j, True)
    ends = [move.end for move in Roughing(2.0, 0.5).moves(-1 + 6j, [dip])]
    assert 5 + 1j not in ends
    assert any(abs(end - (1 + 2j)) < 1e-9 for end in ends)
    assert any(abs(end - (9 + 2j)) < 1e-9 for end in ends)


def test_a_distance_rounds_outer_corners_and_shortens_inner_ones():
    roof = [Line(0 + 0j, 5 + 5j), Line(5 + 5j, 10 + 0j)]
    outside = at_distance(roof, 1.0)
    assert [type(piece) for piece in outside] == [Line, Arc, Line]
    assert abs(outside[1].start - outside[1].centre) == pytest.approx(1.0)
    inside = at_distance(roof, -1.0)
    assert [type(piece) for piece in inside] == [Line, Line]
    assert inside[0].end == pytest.approx(5 + (5 - 2**0.5) * 1j)


def test_an_arc_smaller_than_the_distance_is_refused():
    with pytest.raises(ProfileError, match="smaller"):
        Arc(0 + 0j, 1 + 1j, 1 + 0j, False).side(-1.5)


def test_a_fillet_touches_both_pieces():
    first, arc, last = rounded(Line(0 + 0j, 5 + 0j), Line(5 + 0j, 5 + 5j), 1.0, False)
    assert (first.end, last.start) == (pytest.approx(4 + 0j), pytest.approx(5 + 1j))
    assert abs(arc.centre - (4 + 1j)) < 1e-9


@pytest.mark.parametrize("frame", [Frame(facing, a, b) for facing in (False, True) for a in (1, -1) for b in (1, -1)])
def test_every_frame_turns_points_there_and_back(frame):
    assert frame.outward(frame.inward(3.0, 7.0)) == (3.0, 7.0)
