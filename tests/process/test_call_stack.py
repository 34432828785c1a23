"""``stat.call_stack`` on a whole machine: the calls around the executing move, not those that are being read."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import linuxcnc
from tests.support.desk import DONE, at_desk

pytestmark = pytest.mark.process

MAIN = "G21 G90\nG0 X0 Y0\no<outer> call\nG0 X0 Y0\nM2\n"
OUTER = "o<outer> sub\nG1 X20 F1200\no<inner> call\nG1 X0\no<outer> endsub\n"
INNER = "o<inner> sub\nG1 Y30 F600\nG1 Y0\no<inner> endsub\n"


def test_the_stack_is_that_of_the_executing_move_in_the_same_status(tmp_path: Path) -> None:
    (tmp_path / "outer.ngc").write_text(OUTER)
    (tmp_path / "inner.ngc").write_text(INNER)
    with at_desk(tmp_path, changes={"RS274NGC.SUBROUTINE_PATH": str(tmp_path)}) as desk:
        desk.ready(linuxcnc.MODE_AUTO)
        desk.program(MAIN)
        seen: list[tuple[tuple[str, str, int], ...]] = []

        def over(stat: linuxcnc.stat) -> bool:
            calls = tuple(
                (each["subname"], os.path.basename(each["filename"]), each["line"]) for each in stat.call_stack
            )
            assert len(calls) == stat.call_level
            if calls and stat.read_line == MAIN.count("\n"):
                seen.append(calls)
            return stat.interp_state == linuxcnc.INTERP_IDLE and bool(seen)

        desk.run()
        desk.until(over, "the program's end")
        assert (("outer", "part.ngc", 3), ("inner", "outer.ngc", 3)) in seen
        assert desk.stat.call_stack == ()
        assert desk.do(desk.command.mode, linuxcnc.MODE_MDI) == DONE
        desk.command.mdi("o<inner> call")
        desk.until(lambda s: s.call_stack == ({"subname": "inner", "filename": "", "line": 0},), "the typed call")
        assert desk.do(desk.command.abort) == DONE
        desk.until(lambda s: s.call_stack == (), "the end of the typed call")
