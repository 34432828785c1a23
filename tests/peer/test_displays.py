"""LinuxCNC's graphical displays, unchanged, on machines of ours: they come up, and AXIS previews and runs a program.

They draw on a virtual screen (``Xvfb``); where it or a display's toolkit is not installed, the test is skipped.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

import hal
import linuxcnc
from linuxcnc.systempython import SYSTEM_PYTHON, environment, is_ours
from tests.support.desk import switched_on_and_homed
from tests.support.machine import PATIENCE, Run, running, wait_until

SIM = Path("/usr/share/doc/linuxcnc/examples/sample-configs/sim")

pytestmark = [
    pytest.mark.process,
    pytest.mark.peer,
    pytest.mark.skipif(not SIM.is_dir(), reason="Debian's linuxcnc-uspace is not installed"),
    pytest.mark.skipif(shutil.which("Xvfb") is None, reason="Xvfb is not installed"),
    pytest.mark.skipif(not is_ours(), reason="the system's Python cannot load our modules"),
]

PROGRAM = """\
G21 G90 G64
G0 X0 Y0 Z5
G1 F3000 Z1
G2 X10 Y0 I5 J0
G1 X0 Y0
M2
"""


@pytest.fixture
def screen(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A virtual screen, which the programs of the test draw on."""
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        assert server.stdout is not None
        monkeypatch.setenv("DISPLAY", f":{server.stdout.readline().strip()}")
        monkeypatch.setenv("LIBGL_ALWAYS_SOFTWARE", "1")
        monkeypatch.setenv("GST_PLUGIN_SYSTEM_PATH_1_0", "/nonexistent")  # no sound: JACK would leave shared memory
        yield
    finally:
        server.terminate()
        server.wait()


def sample(folder: Path, name: str) -> Path:
    """A copy of Debian's samples; the INI file of that name."""
    subprocess.run(["cp", "--recursive", "--dereference", SIM, folder / "sim"], check=False, stderr=subprocess.DEVNULL)
    ini = folder / "sim" / name
    (ini.parent / "linuxcnc" / "nc_files").mkdir(parents=True)  # below its HOME, as Touchy wants it
    return ini


def is_up(run: Run, component: str) -> None:
    """Wait until the display has its HAL component ready."""
    wait_until(lambda: run.process.poll() is not None or hal.component_is_ready(component), component, 3 * PATIENCE)
    assert run.process.poll() is None, run.errors


@pytest.mark.parametrize(
    ("ini", "component", "imports"),
    [
        ("gmoccapy/gmoccapy.ini", "gmoccapy", "gi, cairo"),
        ("touchy/touchy.ini", "touchy", "gi"),
        ("qtdragon/qtdragon_xyz/qtdragon_metric.ini", "qtdragon", "PyQt5.Qsci, PyQt5.QtOpenGL, cv2"),
    ],
)
def test_a_display_comes_up(tmp_path, screen, ini, component, imports):
    if subprocess.run([SYSTEM_PYTHON, "-c", f"import {imports}"], stderr=subprocess.DEVNULL, check=False).returncode:
        pytest.skip(f"the system's Python lacks some of {imports}")
    with running(sample(tmp_path, ini)) as run:
        is_up(run, component)
    assert "Traceback" not in run.output + run.errors, run.errors


def test_axis_previews_and_runs_a_program(tmp_path, screen):
    program = tmp_path / "part.ngc"
    program.write_text(PROGRAM)
    variables = os.environ | environment()
    with running(sample(tmp_path, "axis/axis_mm.ini"), speed=5.0) as run:
        is_up(run, "axisui")
        status, command = switched_on_and_homed()
        remote = ["/usr/bin/axis-remote", str(program)]
        wait_until(
            lambda: subprocess.run(remote, env=variables, capture_output=True, check=False).returncode == 0,
            "axis-remote",
        )
        wait_until(lambda: status.poll() or status.file == str(program), "AXIS to load the program")
        command.mode(linuxcnc.MODE_AUTO)
        assert command.wait_complete(PATIENCE) == linuxcnc.RCS_DONE
        command.auto(linuxcnc.AUTO_RUN, 0)
        assert command.wait_complete(PATIENCE) == linuxcnc.RCS_DONE
        wait_until(lambda: status.poll() or status.interp_state == linuxcnc.INTERP_IDLE, "the end of the program")
        assert status.position[:3] == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    assert "Traceback" not in run.output + run.errors, run.errors
