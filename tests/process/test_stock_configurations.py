"""Configurations that were written for LinuxCNC start unchanged; only their display is replaced by a script."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.machine import ROOT, Run, traces

SIM = Path("/usr/share/doc/linuxcnc/examples/sample-configs/sim")

pytestmark = [
    pytest.mark.process,
    pytest.mark.peer,
    pytest.mark.skipif(not SIM.is_dir(), reason="Debian's linuxcnc-uspace is not installed"),
]

# A screen as LinuxCNC's own tests have them: it homes, moves, and leaves with 0 when all is well
SCREEN = f"""#!{sys.executable}
import sys
sys.path.insert(0, {str(ROOT)!r})
import linuxcnc, linuxcnc_util

machine = linuxcnc_util.LinuxCNC()
machine.wait_for_linuxcnc_startup(60.0)
c, s = machine.command, machine.status
c.state(linuxcnc.STATE_ESTOP_RESET)
c.state(linuxcnc.STATE_ON)
c.home(-1)
s.poll()
machine.wait_for_home([1] * s.joints, 60.0)
c.mode(linuxcnc.MODE_MDI)
c.mdi("G90 G0 X0.5")
c.wait_complete(60.0)
s.poll()
sys.exit(0 if abs(s.position[0] - 0.5) < 1e-6 else 7)
"""


STOCK = [
    "axis/axis_mm.ini",
    "axis/axis.ini",
    "axis/lathe.ini",
    "axis/gantry/gantry_mm.ini",
    "axis/twopass/twopass.ini",
]


@pytest.mark.parametrize("ini", STOCK)
def test_a_stock_configuration_starts_homes_and_moves(tmp_path, ini):
    source = SIM / ini
    if not source.is_file():
        pytest.skip(f"{ini} is not among the samples")
    folder = tmp_path / "sim"
    subprocess.run(["cp", "--recursive", "--dereference", SIM, folder], check=False, stderr=subprocess.DEVNULL)
    path = folder / ini
    screen = path.parent / "screen.py"
    screen.write_text(SCREEN)
    screen.chmod(0o755)
    lines = path.read_text().splitlines()
    path.write_text("\n".join("DISPLAY = ./screen.py" if re.match(r" *DISPLAY *=", line) else line for line in lines))
    run = Run(path, "-r", speed=10.0)
    assert run.finish() == 0, run.errors
    assert traces() == []
