"""The display's worker: what a program would do on a machine, whole or with what is missing said."""

import json
import subprocess
import sys

import numpy as np
import pytest

from rs274ngc.geometry import ROW
from tests.support.machine import MILL

INI = MILL / "mill_mm.ini"


def worker(*arguments):
    """(exit code, output) of one worker."""
    command = [sys.executable, "-P", "-m", "rs274ngc.dryrun", *arguments, "-i", str(INI)]
    done = subprocess.run(command, capture_output=True, timeout=60, check=False)
    return done.returncode, done.stdout


def frames(program, tmp_path, *arguments):
    """(rows, end frame) of a program."""
    path = tmp_path / "a.ngc"
    path.write_text(program)
    rows, rest = [], worker(str(path), *arguments)[1]
    while True:
        line, _, rest = rest.partition(b"\n")
        header = json.loads(line)
        if header["frame"] == "end":
            return np.concatenate(rows), header
        rows.append(np.frombuffer(rest[: header["bytes"]], ROW))
        rest = rest[header["bytes"] :]


def test_a_program_within_the_limits_gets_an_all_clear(tmp_path):
    rows, end = frames("G21 G90 G0 X10\nG1 F100 Y5\nM2\n", tmp_path)
    assert rows["line"].tolist() == [0, 1, 2]
    assert (end["outside"], end["notes"], end["error"]) == ([], [], None)
    assert end["extents"]["all"][1][:2] == [10.0, 5.0]


@pytest.mark.parametrize(
    ("program", "line", "axis"),
    [
        ("G21 G90 G0 X300.01\nM2\n", 1, "X"),
        ("G21 G90 G1 F100 X291\nG3 X291 Y20 I0 J10 (bulges to 301)\nM2\n", 2, "X"),
        ("G21 G90 T5 M6\nG43\nG0 Z60 (42 mm tool)\nM2\n", 3, "Z"),
        ("G21 G90 G10 L2 P1 Y200\nG54 G0 Y101\nM2\n", 2, "Y"),
    ],
)
def test_what_leaves_the_limits_is_named(tmp_path, program, line, axis):
    _, end = frames(program, tmp_path)
    assert {(one["line"], one["axis"]) for one in end["outside"]} == {(line, axis)}


@pytest.mark.parametrize(
    ("program", "text"),
    [
        ("G21 G90 G38.2 Z-5 F100\nM2\n", "probe"),
        ("M66 P0 L3 Q1\nM2\n", "M66"),
        ("G21 G0 X#<_hal[spindle.0.on]>\nM2\n", "_hal"),
    ],
)
def test_what_had_to_be_assumed_is_noted(tmp_path, program, text):
    _, end = frames(program, tmp_path)
    assert text in end["notes"][0]["text"]


def test_an_error_comes_with_its_place_and_the_moves_before_it(tmp_path):
    rows, end = frames("G21 G90 G0 X10\nG1 X20\nM2\n", tmp_path)
    assert len(rows) == 2
    assert end["error"]["line"] == 2


def test_the_machine_begins_where_it_stands(tmp_path):
    rows, _ = frames("G21 G91 G0 X10\nM2\n", tmp_path, "--start=5,6,7")
    assert rows["end"][:, :3].tolist() == [[5, 6, 7], [15, 6, 7]]
    assert rows["kind"][0] == 4


def test_the_state_at_a_line_is_that_before_it(tmp_path):
    path = tmp_path / "a.ngc"
    path.write_text("G21 G90 T2 M6 G43\nG55 G0 Z10\nM3 S500\nG1 F100 X5\nM2\n")
    code, output = worker(str(path), "--state-at", "4")
    state = json.loads(output)
    assert code == 0
    assert (state["tool"], state["speed"], state["position"][2]) == (2, 500.0, 22.5)
    assert {"G55", "M3"} <= {*state["gcodes"], *state["mcodes"]}
    assert json.loads(worker(str(path), "--state-at", "9")[1])["blocked"]


def test_a_wrong_block_of_mdi_is_refused_with_its_column():
    code, output = worker("--mdi", "G1 X5 FX")
    assert code == 1
    assert json.loads(output)["error"]["column"] > 0


def test_a_waiting_worker_takes_its_arguments_from_its_input_and_ends_with_whoever_started_it():
    command = [sys.executable, "-P", "-m", "rs274ngc.dryrun", "--wait"]
    words = json.dumps(["--mdi", "G0 X5", "-i", str(INI)]) + "\n"
    done = subprocess.run(command, input=words.encode(), capture_output=True, timeout=60, check=True)
    assert json.loads(done.stdout)["end"][0] == 5.0
    assert subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=60, check=True).stdout == b""
