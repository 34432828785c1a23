"""The way back from a move's id to its line, and the modes that an abort brings back."""

import pytest

from emctask.places import Block, Modes, Place, Places

CODES = (4, 10, -1, 170, 400, 210, 910, 940, 591, 430, 990, 640, -1, 970, 911, 80, 922)


def test_ids_grow_by_one_and_are_found_until_the_machine_has_passed_them():
    places = Places()
    block = Block("part.ngc")
    first, second = places.new_id(Place(1, block)), places.new_id(Place(2, block))
    assert second == first + 1
    assert places.find(first).line == 1
    assert places.at(second).line == 2
    assert places.find(first) is None
    assert places.find(99) is None


def test_ids_go_on_after_everything_was_forgotten():
    places = Places()
    last = places.new_id(Place(1, Block("")))
    places.forget()
    assert places.find(last) is None
    assert places.new_id(Place(5, Block(""))) == last + 1


def test_modes_come_back_as_one_block_without_motion_or_tool_length():
    modes = Modes(CODES, (), (4.0, 600.0, 1200.0, 0.01, 0.005))
    assert modes.as_block() == "G17 G21 G91 G94 G59.1 G99 G64 G91.1 G8 P0.01 Q0.005 F600 S1200"


@pytest.mark.parametrize(
    ("path", "naive", "words"), [(0.0, 6.0, " Q6"), (0.5, 0.0, " P0.5 Q0"), (0.5, 2.0, " P0.5 Q2"), (0.0, 0.0, "")]
)
def test_tolerances_come_back_as_they_were_given(path, naive, words):
    assert Modes(CODES, (), (0.0, 0.0, 0.0, path, naive)).as_block().endswith(f"G64 G91.1 G8{words}")


def test_inverse_time_brings_no_feed_back_because_every_block_names_its_own():
    codes = tuple(930 if code == 940 else code for code in CODES)
    assert "F" not in Modes(codes, (), (0.0, 5.0, 0.0, 0.0, 0.0)).as_block()
