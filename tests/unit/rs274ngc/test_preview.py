"""The moves of a program as arrays: where they go, what they carry, in pieces, cancelled, in a process of its own."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from nml.inifile import IniFile
from rs274ngc import stats
from rs274ngc.geometry import ARC, FEED, RAPID, ROW
from rs274ngc.preview import load

ROOT = Path(__file__).parents[3]
MM = {"length_units": 1.0}


@pytest.fixture
def program(tmp_path):
    def write(text):
        path = tmp_path / "program.ngc"
        path.write_text(text)
        return path

    return write


def test_an_arc_is_followed_within_the_chord_error(program):
    result = load(program("g21 f100\ng0 x10\ng3 x-10 i-10\nm2\n"), chord_error=0.01)
    arc = result.rows[result.rows["kind"] == ARC]
    assert abs(np.hypot(arc["end"][:, 0], arc["end"][:, 1]) - 10.0).max() < 1e-9
    assert stats.figures(result)["distance_mm"]["arc"] == pytest.approx(31.4159, abs=0.02)
    assert set(arc["line"]) == {3}


def test_rows_say_tool_speed_feed_and_coolant(program):
    rows = load(program("t2 m6\nm4 s500 m8\ng1 x1 f120\nm5 m9\ng0 x2\nm2\n")).rows
    assert rows["kind"].tolist() == [FEED, RAPID]
    assert rows["tool"].tolist() == [2, 2]
    assert rows["speed"].tolist() == [-500.0, 0.0]
    assert rows["coolant"].tolist() == [2, 0]
    assert rows["feed"].tolist() == [120.0, 120.0]


def test_points_are_the_tools_tip_in_machine_millimetres(program):
    text = "g20\ng10 l2 p1 x1 y2 r90\ng54\ng43.1 z5\ng92.1\ng0 x1 y0 z0\ng92 x0 y0\ng0 x1\nm2\n"
    ends = load(program(text)).rows["end"]
    assert ends[0, :3] == pytest.approx([25.4, 76.2, 0.0])
    assert ends[1, :3] == pytest.approx([25.4, 101.6, 0.0])


def test_the_ini_file_names_parameters_tools_and_axes(tmp_path, program):
    (tmp_path / "machine.var").write_text("5161\t0\n5221\t7\n")
    (tmp_path / "tool.tbl").write_text("T5 P1 Z2\n")
    ini = tmp_path / "machine.ini"
    ini.write_text(
        "[TRAJ]\nLINEAR_UNITS=mm\nCOORDINATES=XZ\n[RS274NGC]\nPARAMETER_FILE=machine.var\n[EMCIO]\nTOOL_TABLE=tool.tbl\n"
    )
    result = load(program("g21 t5 m6\ng0 x1\ng0 y1\nm2\n"), IniFile(str(ini)))
    assert result.tools == [5]
    assert result.rows["end"][0, 0] == 8.0
    assert result.error.place.line == 3
    assert (tmp_path / "machine.var").read_text() == "5161\t0\n5221\t7\n"


def test_pieces_add_up_to_the_whole(program):
    path = program("g21 f100\n" + "".join(f"g1 x{k}\n" for k in range(3000)) + "m2\n")
    pieces = []
    result = load(path, on_rows=pieces.append, piece=512)
    assert [len(piece) for piece in pieces] == [512] * 5 + [440]
    assert result.moves == 3000
    assert np.array_equal(np.concatenate(pieces), load(path).rows)


def test_a_program_without_end_can_be_cancelled(program):
    shares = []

    def progress(share):
        shares.append(share)
        return len(shares) == 3

    result = load(program("g21\no1 while [1]\ng0 x1\no1 endwhile\nm2\n"), progress=progress)
    assert result.cancelled
    assert all(0.0 <= share <= 1.0 for share in shares)


def test_progress_grows_to_the_end_of_the_file(program):
    shares = []
    load(program("g21\n" + "g0 x1\n" * 5000 + "m2\n"), progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] > 0.8


def test_an_error_keeps_the_moves_before_it(program):
    result = load(program("g0 x1\ng0 x2\ng1 y1\nm2\n"))
    assert len(result.rows) == 2
    assert (result.error.place.line, result.error.message) == (3, "Cannot do g1 with zero feed rate")


def test_a_process_of_its_own_writes_frames(program):
    path = program("g21 f100\n" + "g1 x1\ng1 x2\n" * 50 + "g2\n")
    command = [sys.executable, "-m", "rs274ngc.preview", str(path), "--piece", "64"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, timeout=60, check=False)
    data, frames, rows = done.stdout, [], []
    while data:
        head, _, data = data.partition(b"\n")
        frames.append(json.loads(head))
        size = frames[-1]["bytes"]
        rows.append(np.frombuffer(data[:size], ROW))
        data = data[size:]
    assert [frame["frame"] for frame in frames] == ["rows", "rows", "end"]
    assert sum(len(piece) for piece in rows) == frames[-1]["moves"] == 100
    assert frames[-1]["error"]["line"] == 102
    assert done.returncode == 1
