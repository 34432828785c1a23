"""What may happen while a program runs: aborts in every kind of wait, edited files, a random changer."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import linuxcnc
from tests.support.desk import DONE, ERROR, Desk, at_desk

pytestmark = pytest.mark.process

NO_CHANGER = "unlinkp iocontrol.0.tool-prepared\nunlinkp iocontrol.0.tool-changed\n"


@pytest.fixture
def setting() -> dict[str, object]:
    """Arguments of ``at_desk`` that a test wants otherwise."""
    return {}


@pytest.fixture
def desk(tmp_path: Path, setting: dict[str, object]) -> Iterator[Desk]:
    with at_desk(tmp_path, **setting) as desk:
        desk.ready(linuxcnc.MODE_AUTO)
        yield desk


def x(desk: Desk) -> float:
    return round(desk.look().position[0], 6)


@pytest.mark.parametrize(
    ("setting", "block", "waits_for"),
    [
        ({}, "G4 P9999", linuxcnc.EXEC_WAITING_FOR_DELAY),
        ({}, "M66 P0 L3 Q9999", linuxcnc.EXEC_WAITING_FOR_DELAY),
        ({"hal": NO_CHANGER}, "T2 M6", linuxcnc.EXEC_WAITING_FOR_MOTION_AND_IO),
    ],
)
def test_an_abort_ends_every_kind_of_wait_and_the_machine_goes_on(desk, block, waits_for):
    desk.program(f"G21 G90 F6000\nG1 X1\n{block}\nG1 X9\nM2\n")
    desk.run()
    desk.until(lambda s: s.exec_state == waits_for and x(desk) == 1.0, "the wait")
    assert desk.do(desk.command.abort) == DONE
    status = desk.stat
    assert (status.interp_state, status.exec_state) == (linuxcnc.INTERP_IDLE, linuxcnc.EXEC_DONE)
    assert status.tool_in_spindle == 0
    desk.program("G21 G90 F6000\nG91 G1 X1\nG90\nM2\n")
    assert desk.do(desk.command.auto, linuxcnc.AUTO_RUN, 0) == DONE, desk.texts
    assert x(desk) == 2.0


@pytest.mark.parametrize(
    "setting", [{"changes": {"RS274NGC.PARAMETER_FILE": "mill_mm.var\nON_ABORT_COMMAND = G53 G0 Z7"}}]
)
def test_the_abort_command_runs_after_an_abort_but_not_after_a_refused_start(desk):
    desk.program("G21 G90 F120\nT1 M6\nG1 X100\nG1 X0\nM2\n")
    assert desk.do(desk.command.mode, linuxcnc.MODE_MDI) == DONE
    assert desk.mdi("T2 M6") == DONE
    assert desk.do(desk.command.mode, linuxcnc.MODE_AUTO) == DONE
    assert desk.do(desk.command.auto, linuxcnc.AUTO_RUN, 4) == ERROR
    assert desk.do(desk.command.abort) == DONE
    assert desk.stat.position[2] == 0.0
    desk.run()
    desk.until(lambda s: s.position[0] > 2.0, "cutting")
    desk.command.abort()
    desk.until(lambda s: s.position[2] == 7.0 and s.interp_state == linuxcnc.INTERP_IDLE, "the abort command")
    assert x(desk) < 99.0


def test_a_program_that_is_edited_or_deleted_runs_on_as_it_was_and_is_read_anew_by_the_next_run(desk):
    path = desk.folder / "part.ngc"
    desk.program("G21 G90 F600\nG1 X1\nM0\nG1 X2\nM0\nG1 X3\nM2\n")
    desk.run()
    desk.until(lambda s: s.interp_state == linuxcnc.INTERP_PAUSED, "M0")
    path.write_text("G21 G90 F600\nG1 X-5\nM2\n")
    desk.command.auto(linuxcnc.AUTO_RESUME)
    desk.until(lambda s: s.interp_state == linuxcnc.INTERP_PAUSED and x(desk) == 2.0, "the second M0")
    path.unlink()
    assert desk.do(desk.command.auto, linuxcnc.AUTO_RESUME) == DONE
    assert x(desk) == 3.0
    assert desk.do(desk.command.auto, linuxcnc.AUTO_RUN, 0) == ERROR
    assert "part.ngc" in desk.texts[-1]
    path.write_text("G21 G90 F6000\nG1 X-5\nM2\n")
    assert desk.do(desk.command.auto, linuxcnc.AUTO_RUN, 0) == DONE, desk.texts
    assert x(desk) == -5.0


@pytest.mark.parametrize(
    "setting",
    [
        {
            "changes": {"EMCIO.TOOL_TABLE": "mill_mm.tbl\nRANDOM_TOOLCHANGER = 1"},
            "tools": "T7 P0 Z7\nT1 P1 Z1\nT0 P2\nT5 P1000 Z5\n",
        }
    ],
)
def test_a_random_changer_swaps_and_knows_where_each_tool_is(desk):
    table = desk.folder / "mill_mm.tbl"
    assert desk.look().tool_in_spindle == 7
    desk.program("T5 M6 G43\nM0\nT0 M6\nM0\nT7 M6\nM2\n")
    desk.run()
    desk.until(lambda s: s.interp_state == linuxcnc.INTERP_PAUSED, "T5")
    assert (desk.stat.tool_in_spindle, desk.stat.tool_offset[2]) == (5, 5.0)
    assert table.read_text() == "T7 P1000 Z7\nT1 P1 Z1\nT0 P2\nT5 P0 Z5\n"
    desk.command.auto(linuxcnc.AUTO_RESUME)
    desk.until(lambda s: s.interp_state == linuxcnc.INTERP_PAUSED and s.tool_in_spindle == 0, "T0")
    assert table.read_text() == "T7 P1000 Z7\nT1 P1 Z1\nT0 P0\nT5 P2 Z5\n"
    assert desk.do(desk.command.auto, linuxcnc.AUTO_RESUME) == DONE, desk.texts
    assert desk.stat.tool_in_spindle == 7
    assert table.read_text() == "T7 P0 Z7\nT1 P1 Z1\nT0 P1000\nT5 P2 Z5\n"
