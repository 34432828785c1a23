"""How the machine stands, handed to dry runs and the forecast as words of a command line."""

from __future__ import annotations

from typing import Any

from gui.web import present

STANDING: dict[str, Any] = {
    "position": [1.0, 2.5] + [0.0] * 7,
    "tool_in_spindle": 3,
    "tool_offset": [0.0] * 9,
    "gcode_text": ["G1", "G17", "G21", "G64", "G90", "G94", "G54", "G40"],
    "settings": [0.0, 600.0, 0.0, 0.01, 0.0],
    "program_units": 2,
    "block_delete": False,
}


def test_codes_feed_and_tolerances_are_carried_and_then_the_motion():
    assert present.modes(STANDING) == ["G17 G21 G64 G90 G94 G54 P0.01 Q0 F600", "G1"]


def test_a_feed_per_line_is_not_carried_and_a_speed_is():
    codes = {"gcode_text": ["G93", "G80"], "settings": [0.0, 2.0, 500.0, 0.0, 0.0]}
    assert present.modes(STANDING | codes) == ["G93 S500", "G80"]


def test_the_feed_motion_that_a_program_leaves_is_carried_without_a_feed():
    values = STANDING | {"settings": [0.0, 0.0, 0.0, 0.0, 0.0]}
    assert present.modes(values) == ["G17 G21 G64 G90 G94 G54", "G1 F1", "F0"]


def test_a_tool_offset_is_brought_about_in_program_units():
    offset = [0.0, 0.0, 25.4] + [0.0] * 6
    assert present.tool_offset(STANDING | {"tool_offset": offset, "program_units": 1}, 1.0) == "G20 G43.1 Z1.000000"
    assert present.tool_offset(STANDING | {"tool_offset": offset}, 1.0) == "G21 G43.1 Z25.400000"


def test_everything_becomes_words_of_a_command_line():
    words = present.arguments(STANDING | {"block_delete": True}, 1.0)
    assert words == [
        "--start=1,2.5,0,0,0,0,0,0,0", "--tool=3", "--begin=G17 G21 G64 G90 G94 G54 P0.01 Q0 F600", "--begin=G1",
        "--block-delete",
    ]  # fmt: skip


def test_before_the_first_status_nothing_is_known():
    assert present.arguments({}, 1.0) == []
