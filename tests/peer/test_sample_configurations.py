"""Every INI file of LinuxCNC's samples under ``sim/axis`` starts with another display, or says what is missing.

What does not start is in the table below, with what the one message must name; programs that draw are named where a
HAL file waits for one and there is no X server.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.machine import ROOT, Run, traces, wait_until

SIM = Path("/usr/share/doc/linuxcnc/examples/sample-configs/sim")

pytestmark = [
    pytest.mark.process,
    pytest.mark.peer,
    pytest.mark.skipif(not SIM.is_dir(), reason="Debian's linuxcnc-uspace is not installed"),
]

SCREEN = f"""#!{sys.executable}
import sys
sys.path.insert(0, {str(ROOT)!r})
import linuxcnc_util
linuxcnc_util.LinuxCNC().wait_for_linuxcnc_startup(60.0)
"""
WINDOW = r"(gui|vcp|vismach|panelui|delta|max5\w*) exited without becoming ready"
"""A HAL file waits for a program that draws, which takes an X server and libraries of its own."""

MISSING = {
    "classicladder/demo_sim_cl.ini": "classicladder_rt",
    "halui_pyvcp/halui.ini": "pyvcp",
    "orphans/iocontrol-removed/iocontrol-removed.ini": "no buffer 'toolCmd'",
    "panelui-demo/_panelui.ini": r"\[KINS\]JOINTS",
    "panelui-demo/panelui-demo.ini": "panelui",
    "vismach/3axis-tutorial/3axis-tutorial.ini": "exited without becoming ready",
    "vismach/rolfmill/rolfmill.ini": r"\[KINS\]JOINTS",
}
"""INI file below ``sim/axis``: what the message names."""

NEEDS_PENDANT = {"ja_tests/xyzx_mpg/xyzx-xhc-hb04.ini", "xhc-hb04/xhc-hb04-layout1.ini"}
NEEDS_PENDANT |= {"xhc-hb04/xhc-hb04-layout2.ini", "xhc-hb04/xhc-hb04-layout2_mm.ini"}
"""Their HAL files wait for a pendant at the computer for as long as it takes, under LinuxCNC too."""

SAMPLES = sorted(str(path.relative_to(SIM / "axis")) for path in (SIM / "axis").rglob("*.ini"))
FEW = 8
"""One of so many samples is started, besides those of the table, unless PYEMC_LONG_TESTS is in the environment."""


def chosen() -> list[str]:
    """The samples to start."""
    there = [name for name in SAMPLES if name not in NEEDS_PENDANT]
    if "PYEMC_LONG_TESTS" in os.environ:
        return there
    return [name for number, name in enumerate(there) if number % FEW == 0 or name in MISSING]


@pytest.fixture(scope="module")
def samples(tmp_path_factory):
    """A copy in which links are files."""
    folder = tmp_path_factory.mktemp("samples") / "sim"
    subprocess.run(["cp", "--recursive", "--dereference", SIM, folder], check=False, stderr=subprocess.DEVNULL)
    yield folder / "axis"
    shutil.rmtree(folder)


@pytest.mark.parametrize("name", chosen())
def test_a_sample_starts_or_says_what_is_missing(samples, tmp_path, name):
    path = samples / name
    screen = tmp_path / "screen.py"
    screen.write_text(SCREEN)
    screen.chmod(0o755)
    for file in (path, *path.parent.glob("*.inc")):
        text = file.read_text(errors="surrogateescape")
        file.write_text(re.sub(r"(?m)^ *DISPLAY *=.*$", f"DISPLAY = {screen}", text), errors="surrogateescape")
    run = Run(path, "-r", speed=5.0)
    try:
        code = run.finish()
    finally:
        run.stop()
    wait_until(lambda: not traces(), "everything is gone")
    if name in MISSING or code != 0:
        assert code == 1, run.errors
        assert re.search(MISSING.get(name, WINDOW), run.errors), run.errors
