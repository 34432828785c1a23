"""Run from line in a whole machine: nothing moves before the line, everything is in force at it, or it is refused."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import linuxcnc
from tests.support.desk import DONE, ERROR, Desk, at_desk
from tests.support.machine import PATIENCE
from tests.support.recorder import hal_text, recorded

pytestmark = pytest.mark.process

NEAR = 1e-6  # mm

PART = """\
G21 G90 G94 G17 G61
T1 M6 G43
G10 L2 P2 X10 Y20 Z0
G55
M3 S1000
M8
F120
G0 Z5
G0 X0 Y0
G1 Z-1
G1 X20
Y30
M9
M5
G49 G54
M2
"""


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Desk]:
    with at_desk(tmp_path) as desk:
        desk.ready(linuxcnc.MODE_MDI)
        yield desk


def run_from(desk: Desk, line: int, text: str = PART) -> int:
    """Run a program from a line to its end."""
    desk.texts.clear()
    desk.program(text)
    return desk.do(desk.command.auto, linuxcnc.AUTO_RUN, line)


def place(desk: Desk) -> tuple[float, ...]:
    return tuple(round(value, 6) for value in desk.look().position[:3])


def test_the_state_of_the_line_is_in_force_when_it_begins(desk):
    assert desk.mdi("G20 G91 T1 M6") == DONE
    desk.program(PART)
    desk.texts.clear()
    desk.command.auto(linuxcnc.AUTO_RUN, 12)
    desk.until(lambda s: s.motion_line == 12 and s.current_vel > 0 and s.flood == 1, "the line runs")
    status = desk.stat
    assert status.g5x_index == 2
    assert status.g5x_offset[:3] == (10.0, 20.0, 0.0)
    assert status.tool_offset[2] == 1.0
    assert {210, 900, 550, 170}.issubset(status.gcodes)
    assert (status.spindle[0]["direction"], status.spindle[0]["speed"]) == (1, 1000.0)
    assert status.settings[1] == 120.0
    assert desk.command.wait_complete(PATIENCE) == DONE, desk.texts
    text = " ".join(desk.texts)
    assert text.startswith("run from line 12: G21; G90; G55")
    assert "spindle 0 forward S1000 (was off); flood on" in text
    assert place(desk) == (30.0, 50.0, 0.0)


def test_the_tool_goes_up_across_and_down_before_the_line(tmp_path):
    data = tmp_path / "commands.bin"
    with at_desk(tmp_path, hal=hal_text(data)) as desk:
        desk.ready(linuxcnc.MODE_MDI)
        assert desk.mdi("T1 M6") == DONE
        assert desk.mdi("G21 G90 G53 G0 X100 Y100 Z-20") == DONE
        before = len(recorded(data))
        assert run_from(desk, 12) == DONE, desk.texts
        seen = recorded(data)[before:]
    top = 5.0 + 1.0  # the program's highest Z, with the tool's offset
    across = seen[(seen[:, 0] > 30.0 + NEAR) & (seen[:, 0] < 100.0 - NEAR), 2]
    assert len(across) > 100
    assert across == pytest.approx(top, abs=NEAR)


def test_a_start_with_another_tool_is_refused_and_nothing_moves_or_turns(desk):
    assert desk.mdi("T2 M6") == DONE
    before = place(desk)
    offsets = desk.stat.g5x_offset, desk.stat.g5x_index, desk.stat.gcodes[1:], desk.stat.tool_offset
    assert run_from(desk, 12) == ERROR
    assert "for tool 1, but tool 2 is in the spindle" in desk.texts[-1]
    assert "MDI: T1 M6" in desk.texts[-1]
    assert desk.stat.interp_state == linuxcnc.INTERP_IDLE
    assert place(desk) == before
    assert (desk.stat.spindle[0]["direction"], desk.stat.flood) == (0, 0)
    assert desk.do(desk.command.mode, linuxcnc.MODE_MDI) == DONE
    assert desk.mdi("(DEBUG, #5241 #5220)") == DONE
    assert desk.texts[-1].split() == ["0.000000", "1.000000"]
    assert (desk.stat.g5x_offset, desk.stat.g5x_index, desk.stat.gcodes[1:], desk.stat.tool_offset) == offsets


def test_the_line_of_a_tool_change_can_be_the_first_with_any_tool(desk):
    assert desk.mdi("T2 M6") == DONE
    assert run_from(desk, 2) == DONE, desk.texts
    assert desk.stat.tool_in_spindle == 1
    assert place(desk) == (30.0, 50.0, 0.0)


@pytest.mark.parametrize(
    ("line", "text", "reason"),
    [
        (99, "G21\nG0 X1\nM2\n", "never comes to line 99: it ends at line 3"),
        (3, "G21\no1 if [0]\nG0 X5\no1 endif\nM2\n", "in a branch that is not taken"),
        (4, "G21\nG1 X1 Z\nG0 X1\nG0 X2\nM2\n", "part.ngc:2:"),
        (4, "G21 F100\nG38.2 X9\nG0 X1\nG0 X2\nM2\n", "part.ngc:2: the probe's result cannot be known"),
        (4, "G21 F100\nG42.1 D4\nG1 X20\nG1 Y20\nG40\nM2\n", "inside cutter compensation"),
    ],
)
def test_a_line_that_cannot_be_the_first_is_refused_with_one_message(desk, line, text, reason):
    assert run_from(desk, line, text) == ERROR
    assert len(desk.texts) == 1
    assert reason in desk.texts[0]
    assert place(desk) == (0.0, 0.0, 0.0)
    assert run_from(desk, 0, "G21 G90 G0 X3\nM2\n") == DONE, desk.texts
    assert place(desk)[0] == 3.0


def test_loops_and_subroutines_are_entered_at_their_first_pass(desk):
    loop = "G21 G90 G61 F6000\n#1 = 0\no1 repeat [3]\n#1 = [#1 + 1]\nG0 X#1\nG0 Y[#1 * 2]\no1 endrepeat\nM2\n"
    assert run_from(desk, 6, loop) == DONE, desk.texts
    assert place(desk) == (3.0, 6.0, 0.0)
    assert "inside an O-word block, in its first pass" in " ".join(desk.texts)
    sub = "G21 G90 F6000\no7 sub\nG0 X#1\nG0 Y#2\no7 endsub\no7 call [4] [5]\nG0 Z1\nM2\n"
    assert run_from(desk, 4, sub) == DONE, desk.texts
    assert place(desk) == (4.0, 5.0, 1.0)


def test_an_abort_while_the_lines_before_are_read_leaves_everything_as_it_was(desk):
    desk.program("G21\nG10 L2 P1 X77\no1 while [1]\nG92 X5\no1 endwhile\nG0 X5\nM2\n")
    desk.command.auto(linuxcnc.AUTO_RUN, 6)
    desk.until(lambda s: s.interp_state == linuxcnc.INTERP_READING, "the dry run")
    assert desk.do(desk.command.abort) == DONE
    assert desk.do(desk.command.mode, linuxcnc.MODE_MDI) == DONE
    assert desk.mdi("G0 X1") == DONE, desk.texts
    assert place(desk)[0] == 1.0
    assert desk.mdi("(DEBUG, #5221 #5211)") == DONE
    assert desk.texts[-1].split() == ["0.000000", "0.000000"]


def test_what_is_not_repeated_is_named(desk):
    assert run_from(desk, 4, "G21 G90\nM64 P3\nM66 P0 L0\nG0 X2\nM2\n") == DONE
    assert "not repeated: digital output 3" in " ".join(desk.texts)
    assert place(desk)[0] == 2.0
