"""The forecast's time of a program is the time that the whole machine's motors move, in servo periods."""

from pathlib import Path

import numpy as np
import pytest

from emcmot.forecast import forecast
from emcmot.forecast_machine import Machine
from nml.inifile import IniFile
from rs274ngc import tooltable
from tests.support.machine import PROGRAMS, Run, copy_mill, traces
from tests.support.recorder import hal_text, recorded

pytestmark = pytest.mark.process

SAMPLES = Path("/usr/share/linuxcnc/ncfiles")
SPEED = 20.0
JERK = 20_000.0  # mm/s^3


def moving_periods(positions: np.ndarray) -> int:
    """Servo periods in which some axis was told to go elsewhere."""
    return int(np.count_nonzero(np.any(np.diff(positions[:, :3], axis=0) != 0.0, axis=1)))


def forecast_of(ini_file: Path, program: Path):
    ini = IniFile(ini_file)
    table = ini.path("EMCIO", "TOOL_TABLE", None)
    assert table is not None
    return forecast(ini, program, Machine.from_ini(ini), tooltable.load(table), trace=True)


def limit_jerk(ini: Path) -> None:
    """Let a machine limit the jerk of its axes."""
    ini.write_text(ini.read_text().replace("[TRAJ]\n", f"[TRAJ]\nPLANNER_TYPE = 1\nMAX_LINEAR_JERK = {JERK}\n"))


def largest_jerk(positions: np.ndarray, period: float) -> float:
    return float(np.abs(np.diff(positions[:, :3], 3, axis=0)).max()) / period**3


def compare(ini: Path, data: Path, program: Path) -> None:
    """Run a program on the machine of `ini`, which records into `data`; its motion takes what the forecast says."""
    expected = forecast_of(ini, program)
    run = Run(ini, "--run", str(program), speed=SPEED)
    assert run.finish() == 0, run.errors
    motion = sum(seconds for _, _, seconds, _ in expected.sections)
    moved = moving_periods(recorded(data))
    assert moved == pytest.approx(moving_periods(expected.trace.positions), rel=0.01)
    assert moved * expected.trace.period == pytest.approx(motion, rel=0.01)
    assert traces() == []


@pytest.mark.parametrize(("name", "jerk"), [("arcs_helices", False), ("drilling", False), ("drilling", True)])
def test_the_machine_moves_for_as_long_as_the_forecast_says(tmp_path, name, jerk):
    data = tmp_path / "commands.bin"
    ini = copy_mill(tmp_path, hal=hal_text(data))
    if jerk:
        limit_jerk(ini)
    compare(ini, data, PROGRAMS / f"{name}.ngc")
    assert (largest_jerk(recorded(data), 0.001) <= JERK * 1.001) == jerk


def test_the_forecast_of_short_moves_under_limited_jerk_is_the_machines_time(tmp_path):
    data, program = tmp_path / "commands.bin", tmp_path / "curve.ngc"
    t = 0.002 * np.arange(1, 4001)
    radius = 30 + 5 * np.sin(7 * t)
    points = np.column_stack([radius * np.cos(t) + 50, radius * np.sin(t) + 50])
    program.write_text("G21 G90 G64 P0.01\nG1 F2400\n" + "".join(f"X{x:.3f} Y{y:.3f}\n" for x, y in points) + "M2\n")
    ini = copy_mill(tmp_path, hal=hal_text(data))
    limit_jerk(ini)
    compare(ini, data, program)
    assert largest_jerk(recorded(data), 0.001) <= JERK * 1.001


@pytest.mark.skipif(not SAMPLES.is_dir(), reason="Debian's LinuxCNC is not installed")
@pytest.mark.parametrize("name", ["3D_Chips", "3dtest", "comp", "polar"])
def test_the_forecast_of_linuxcncs_samples_is_the_machines_time(tmp_path, name):
    data = tmp_path / "commands.bin"
    compare(copy_mill(tmp_path, hal=hal_text(data)), data, SAMPLES / f"{name}.ngc")
