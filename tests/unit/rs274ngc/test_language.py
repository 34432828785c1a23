"""What programs mean: numbers, expressions, parameters, moves, flow."""

import pytest

from nml.errors import InterpError


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("[2 + 3 * 4]", 14.0),
        ("[2 ** 3 ** 2]", 64.0),
        ("[7 mod 3]", 1.0),
        ("[-7 mod 3]", 2.0),
        ("[1 lt 2 and 3 gt 2]", 1.0),
        ("atan[1]/[1]", 45.0),
        ("[fix[-2.5] + fup[2.1]]", 0.0),
        ("round[-2.5]", -3.0),
        ("-[3]", -3.0),
        ("1 2.5", 12.5),
    ],
)
def test_an_expression_has_its_value(run, expression, value):
    assert run(f"g0 x{expression}\nm2\n").named("straight_traverse")[0][1] == pytest.approx(value)


def test_a_parameter_is_set_after_the_line_was_read(run):
    canon = run("#1=3\n#1=5 g0 x#1\ng0 x#1\nm2\n")
    assert [move[1] for move in canon.named("straight_traverse")] == [3.0, 5.0]


def test_a_local_name_ends_with_its_subroutine(run):
    with pytest.raises(InterpError, match="#<inner> not defined"):
        run("o1 sub\n#<inner>=1\no1 endsub\no1 call\ng0 x#<inner>\nm2\n")


def test_motion_is_modal_and_incremental_adds_up(run):
    canon = run("g91 g0 x1\nx1\ny2\nm2\n")
    assert [move[1:3] for move in canon.named("straight_traverse")] == [(1, 0), (2, 0), (2, 2)]


def test_both_arc_formats_name_the_same_arc(run):
    by_centre = run("f100 g2 x1 y1 i1 j0\nm2\n").named("arc_feed")[0]
    by_radius = run("f100 g2 x1 y1 r1\nm2\n").named("arc_feed")[0]
    assert by_centre == pytest.approx(by_radius)


def test_offsets_move_the_coordinates_and_not_the_tool(run):
    canon = run("g21 g0 x10\ng92 x0\ng0 x0\ng10 l2 p1 x5\ng0 y1\nm2\n")
    assert [move[1] for move in canon.named("straight_traverse")] == [10.0, 0.0, -5.0]


@pytest.mark.parametrize("units", ["g20", "g21"])
@pytest.mark.parametrize(
    "offsets", ["g92.1", "g10 l2 p1 x3 y7 r45", "g10 l2 p1 x0 y0 r30\ng92 x3 y7", "g10 l2 p1 x3 y7 r-60\ng43.1 x2 z5"]
)
def test_the_position_without_offsets_has_a_name_and_a_number(run, units, offsets):
    program = f"{units}\n{offsets}\ng53 g0 x1 y2 z3 a4\n(debug,#5021 #5022 #5023 #5024)\n"
    canon = run(f"{program}#<found> = #5022\n(debug,#<_abs_x> #<_abs_y> #<_abs_z> #<_abs_a> #<found>)\nm2\n")
    numbers, names = ([round(float(word), 3) for word in text.split()] for (text,) in canon.named("message"))
    assert (numbers, names) == ([1, 2, 3, 4], [1, 2, 3, 4, 2])


def test_the_tool_offset_in_force_has_numbers_of_its_own(run):
    canon = run("g43.1 x1 z5\n(debug,#5081 #5083)\ng43.2 z2\n(debug,#5081 #5083)\ng49\n(debug,#5081 #5083)\nm2\n")
    assert [[float(word) for word in text.split()] for (text,) in canon.named("message")] == [[1, 5], [1, 7], [0, 0]]


@pytest.mark.parametrize("number", [5021, 5029, 5081, 5089])
def test_what_follows_from_position_and_offsets_cannot_be_set(run, number):
    with pytest.raises(InterpError, match="readonly"):
        run(f"#{number} = 1\nm2\n")


def test_loops_conditions_and_calls_flow(run):
    canon = run(
        "o1 sub\no2 if [#1 gt 1]\ng0 x#1\no2 else\ng0 y#1\no2 endif\no1 return [#1 * 2]\no1 endsub\n"
        "#5=0\no3 while [#5 lt 3]\n#5=[#5+1]\no4 if [#5 eq 2]\no3 continue\no4 endif\no1 call [#5]\no3 endwhile\n"
        "g0 z#<_value>\no6 repeat [2]\n(msg,again)\no6 endrepeat\nm2\n"
    )
    assert [move[1:4] for move in canon.named("straight_traverse")] == [(0, 1, 0), (3, 1, 0), (3, 1, 6)]
    assert canon.named("message") == [("again",), ("again",)]


def test_a_block_is_executed_in_the_order_of_execution(run):
    canon = run("g1 x1 m3 f100 s50 (first) m0\nm2\n")
    assert [name for name, _ in canon.calls][:5] == [
        "comment",
        "set_feed_rate",
        "start_spindle_clockwise",
        "straight_feed",
        "program_stop",
    ]


def test_an_unknown_tool_is_refused(run):
    with pytest.raises(InterpError, match="Requested tool 5 not found"):
        run("t5 m6\nm2\n")


def test_an_analog_output_without_a_value_is_sent_minus_one(run):
    calls = run("m67 e1\nm68 e2\nm67 e0 q3\nm2\n").calls
    assert ("set_motion_output_value", (1, -1.0)) in calls
    assert ("set_aux_output_value", (2, -1.0)) in calls
    assert ("set_motion_output_value", (0, 3.0)) in calls


@pytest.mark.parametrize(
    ("line", "text"),
    [("(abort, at #1)", " at 3.000000"), ("(ABORT,here)", "here"), ("g0 x1 (abort,before moving)", "before moving")],
)
def test_a_program_ends_itself_with_a_message_of_its_own(run, line, text):
    with pytest.raises(InterpError) as error:
        run(f"#1=3\n{line}\nm2\n")
    assert error.value.message == text


def test_a_comment_that_only_begins_like_an_order_is_a_comment(run):
    shown = run("(abort)\n(abort here)\n(pyreload it)\nm2\n").named("comment")
    assert shown == [("abort",), ("abort here",), ("pyreload it",)]
