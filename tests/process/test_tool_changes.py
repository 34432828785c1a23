"""Where and how a whole machine changes tools: [EMCIO]TOOL_CHANGE_*, and the changer of iov2 with a fault."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import linuxcnc
from tests.support.desk import DONE, ERROR, Desk
from tests.support.machine import ROOT, copy_mill, running, wait_until

pytestmark = pytest.mark.process

NC = "G21 G90 G0 X1 Y2 Z-3"


def halcmd(*words: str) -> str:
    command = [sys.executable, "-m", "hal.halcmd", *words]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def mill(folder: Path, *entries: str) -> Path:
    """The simulated mill with more entries in its section EMCIO."""
    ini = copy_mill(folder)
    ini.write_text(ini.read_text().replace("[EMCIO]\n", "[EMCIO]\n" + "".join(f"{entry}\n" for entry in entries)))
    (folder / "mill_mm.tbl").write_text("T1 P1 D3 Z1\nT2 P2 D6 Z-12.5\n")
    return ini


@pytest.mark.parametrize(
    ("entries", "place"),
    [
        ((), (1, 2, -3)),
        (("TOOL_CHANGE_POSITION = 11 12 -1",), (11, 12, -1)),
        (("TOOL_CHANGE_QUILL_UP = 1",), (1, 2, 0)),
        (("TOOL_CHANGE_AT_G30 = 1",), (4, 5, -2)),
    ],
    ids=["where it stands", "position", "quill up", "G30"],
)
def test_a_tool_is_changed_where_the_ini_file_says(
    tmp_path: Path, entries: tuple[str, ...], place: tuple[float, ...]
) -> None:
    with running(mill(tmp_path, *entries), speed=5.0) as run:
        run.port()
        desk = Desk(tmp_path)
        desk.ready(linuxcnc.MODE_MDI)
        for line in ("G21 G90 G0 X4 Y5 Z-2", "G30.1", NC):
            assert desk.mdi(line) == DONE, desk.texts
        assert desk.mdi("T2 M6") == DONE, desk.texts
        assert desk.stat.tool_in_spindle == 2
        assert desk.stat.position[:3] == pytest.approx(place)


def test_a_changer_of_iov2_that_reports_a_fault_ends_the_change_until_it_is_cleared(tmp_path: Path) -> None:
    ini = copy_mill(tmp_path, changes={"EMCIO.EMCIO": "iov2"}, hal="unlinkp iocontrol.0.tool-changed\n")
    with running(ini) as run:
        run.port()
        desk = Desk(tmp_path)
        desk.ready(linuxcnc.MODE_MDI)
        desk.command.mdi("T2 M6")
        wait_until(lambda: halcmd("getp", "iocontrol.0.tool-change") == "TRUE", "the request to the changer")
        halcmd("setp", "iocontrol.0.toolchanger-reason", "-2")
        halcmd("setp", "iocontrol.0.toolchanger-fault", "1")
        assert desk.command.wait_complete(30.0) == ERROR
        desk.until(lambda _: any("fault -2" in text for text in desk.texts), "the reason")
        assert halcmd("getp", "iocontrol.0.tool-change") == "FALSE"
        assert halcmd("getp", "iocontrol.0.toolchanger-faulted") == "TRUE"
        assert desk.stat.tool_in_spindle == 0
        assert desk.mdi("T2 M6") == ERROR
        desk.until(lambda _: any("clear it first" in text for text in desk.texts), "the refusal")
        halcmd("setp", "iocontrol.0.toolchanger-fault", "0")
        halcmd("setp", "iocontrol.0.toolchanger-clear-fault", "1")
        wait_until(lambda: halcmd("getp", "iocontrol.0.toolchanger-faulted") == "FALSE", "the end of the fault")
        desk.command.mdi("T2 M6")
        wait_until(lambda: halcmd("getp", "iocontrol.0.tool-change") == "TRUE", "the next request")
        halcmd("setp", "iocontrol.0.tool-changed", "1")
        assert desk.command.wait_complete(30.0) == DONE
        assert desk.look().tool_in_spindle == 2
