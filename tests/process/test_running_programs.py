"""`linuxcnc INI --run FILE`: whole machines run whole programs, and the motors are told what the programs say."""

import re
from pathlib import Path

import numpy as np
import pytest

from tests.support import verify
from tests.support.machine import MILL, PROGRAMS, Run, copy_mill, traces
from tests.support.recorder import hal_text, recorded

pytestmark = pytest.mark.process

SPEED = 10.0
PERIOD = 0.001  # s
VELOCITY = np.array([200.0, 200.0, 100.0])  # mm/s, [JOINT_n]MAX_VELOCITY of the mill
ACCELERATION = np.array([1000.0, 1000.0, 1000.0])  # mm/s^2

NC_FILES = Path("/usr/share/linuxcnc/ncfiles")

SQUARE = np.array([(0, 0, 0), (20, 0, 0), (20, 20, 0), (0, 20, 0), (0, 0, 0), (0, 0, 5)], dtype=float)
SUMMARY = re.compile(
    r"time: +(?P<time>\S+)\ndistance: +(?P<distance>[\d.]+) mm\n"
    r"tool changes: +(?P<changes>\d+)\nworst following error: +(?P<ferror>[\d.]+) mm\n"
)


def straight(points: np.ndarray, feed: int) -> str:
    """A program of straight moves through the points; the first one is where the machine stands."""
    return "\n".join(["G21 G90 G94", *(f"G1 X{x:.4f} Y{y:.4f} Z{z:.4f} F{feed}" for x, y, z in points[1:]), "M2", ""])


def run_recorded(folder: Path, program: str, speed: float = SPEED) -> tuple[Run, np.ndarray]:
    """Run a program on a mill whose motor commands are recorded."""
    data = folder / "commands.bin"
    ini = copy_mill(folder, hal=hal_text(data))
    part = folder / "part.ngc"
    part.write_text(program)
    run = Run(ini, "--run", str(part), speed=speed)
    assert run.finish() == 0, run.errors
    return run, recorded(data)


def test_a_square_is_cut_exactly_and_within_the_limits(tmp_path):
    run, samples = run_recorded(tmp_path, "G61\n" + straight(SQUARE, 6000))
    assert verify.path_error(samples, SQUARE) < 1e-6
    assert verify.visits_in_order(samples, SQUARE, 1e-6)
    assert samples[-1] == pytest.approx(SQUARE[-1], abs=1e-9)
    assert not verify.limits_exceeded(samples, PERIOD, VELOCITY, ACCELERATION)
    summary = SUMMARY.search(run.output)
    assert summary is not None, run.output
    assert float(summary["distance"]) == pytest.approx(85.0, abs=1e-3)
    assert float(summary["ferror"]) < 1e-6
    assert traces() == []


def test_blended_corners_stay_within_the_tolerance(tmp_path):
    _, samples = run_recorded(tmp_path, "G64 P0.1\n" + straight(SQUARE, 6000))
    assert 1e-3 < verify.path_error(samples, SQUARE) <= 0.1 * 1.001
    assert verify.visits_in_order(samples, SQUARE, 0.1 * 2**0.5 * 1.001)  # a corner is cut along its diagonal
    assert samples[-1] == pytest.approx(SQUARE[-1], abs=1e-9)
    assert not verify.limits_exceeded(samples, PERIOD, VELOCITY, ACCELERATION)


def test_a_helix_is_cut_as_a_helix(tmp_path):
    program = "G21 G90 G94 G61\nG1 X10 F3000\nG3 X10 Y0 I-10 J0 Z-5 P2\nG1 X0\nM2\n"
    _, samples = run_recorded(tmp_path, program)
    helix = verify.arc((0.0, 0.0), 10.0, 0.0, 720.0, (0.0, -5.0))
    path = np.vstack([[(0.0, 0.0, 0.0)], helix, [(0.0, 0.0, -5.0)]])
    assert verify.path_error(samples, path) < 1e-4  # the chords of the test's own arc
    assert verify.visits_in_order(samples, path[[0, 1, -2, -1]], 1e-3)
    assert not verify.limits_exceeded(samples, PERIOD, VELOCITY, ACCELERATION)


@pytest.mark.parametrize("name", ["arcs_helices", "drilling"])
def test_our_own_programs_run_within_the_limits(tmp_path, name):
    _, samples = run_recorded(tmp_path, (PROGRAMS / f"{name}.ngc").read_text(), speed=40.0)
    assert len(samples) > 1000
    assert not verify.limits_exceeded(samples, PERIOD, VELOCITY, ACCELERATION)


@pytest.mark.parametrize(
    ("program", "units"),
    [
        (PROGRAMS / "contour_pockets.ngc", "mm"),
        (PROGRAMS / "surface.ngc", "mm"),
        (NC_FILES / "3D_Chips.ngc", "mm"),
        (NC_FILES / "spiral.ngc", "mm"),
        (NC_FILES / "flowsnake.ngc", "mm"),
        (NC_FILES / "cds.ngc", "inch"),
    ],
    ids=lambda value: getattr(value, "stem", value),
)
def test_a_whole_part_is_run_to_its_end(tmp_path, program, units):
    if not program.is_file():
        pytest.skip("Debian's linuxcnc-uspace is not installed")
    run = Run(copy_mill(tmp_path, units=units), "--run", str(program), speed=200.0)
    assert run.finish() == 0, run.errors
    assert "worst following error:" in run.output
    assert traces() == []


def test_the_tools_of_a_job_are_counted(tmp_path):
    ini = copy_mill(tmp_path)
    run = Run(ini, "--run", str(PROGRAMS / "drilling.ngc"), speed=50.0)
    assert run.finish() == 0, run.errors
    summary = SUMMARY.search(run.output)
    assert summary is not None
    assert summary["changes"] == "4"


def test_the_surface_program_is_what_its_generator_writes(tmp_path):
    import subprocess
    import sys

    subprocess.run([sys.executable, str(PROGRAMS / "surface.py"), str(tmp_path / "s.ngc")], check=True)
    text = (PROGRAMS / "surface.ngc").read_text()
    assert (tmp_path / "s.ngc").read_text() == text
    assert text.count("\nG1 X") >= 20_000


def test_a_surface_of_short_moves_is_followed_within_the_tolerance(tmp_path):
    lines = (PROGRAMS / "surface.ngc").read_text().splitlines()
    part = [line for line in lines if not line.startswith("G1 X")][:9] + [
        line for line in lines if line.startswith("G1 X")
    ][:800]
    _, samples = run_recorded(tmp_path, "\n".join([*part, "M2", ""]), speed=20.0)
    numbers = [tuple(map(float, re.findall(r"-?\d+\.\d+", line))) for line in part if line.startswith("G1 X")]
    path = np.array(numbers)
    first = int(np.linalg.norm(samples - path[0], axis=1).argmin())
    assert verify.path_error(samples[first:], path) <= 0.01 * 1.01
    assert samples[-1] == pytest.approx(path[-1], abs=1e-9)
    assert not verify.limits_exceeded(samples, PERIOD, VELOCITY, ACCELERATION)


def test_two_speeds_give_the_same_commands(tmp_path):
    first, second = tmp_path / "a", tmp_path / "b"
    first.mkdir()
    second.mkdir()
    _, slow = run_recorded(first, "G64 P0.05\n" + straight(SQUARE, 6000), speed=5.0)
    _, fast = run_recorded(second, "G64 P0.05\n" + straight(SQUARE, 6000), speed=20.0)
    moving = [samples[np.linalg.norm(np.diff(samples, axis=0), axis=1).nonzero()[0]] for samples in (slow, fast)]
    assert len(moving[0]) == len(moving[1])
    assert np.abs(moving[0] - moving[1]).max() < 1e-9


def test_the_configurations_of_the_checkout_name_existing_files():
    for ini in MILL.glob("*.ini"):
        for name in re.findall(r"^(?:HALFILE|TOOL_TABLE) *= *(\S+)", ini.read_text(), re.MULTILINE):
            assert (MILL / name).is_file()
