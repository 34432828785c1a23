"""LinuxCNC's sample of a plasma table cuts with our machine: its screen is a script, its torch some HAL components."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.machine import ROOT, Run, traces, wait_until

SAMPLE = Path("/usr/share/doc/linuxcnc/examples/sample-configs/sim/qtplasmac")

pytestmark = [
    pytest.mark.process,
    pytest.mark.peer,
    pytest.mark.skipif(not SAMPLE.is_dir(), reason="Debian's linuxcnc-uspace is not installed"),
]

SETTINGS = {
    "arc-fail-delay": 3, "arc-max-starts": 3, "arc-ok-high": 250, "arc-ok-low": 60, "arc-voltage-scale": 1,
    "cut-feed-rate": 3000, "cut-height": 1.5, "cut-volts": 100, "float-switch-travel": 1.5, "height-per-volt": 0.1,
    "pid-p-gain": 10, "pierce-delay": 0.1, "pierce-height": 4, "probe-feed-rate": 300, "probe-start-height": 135,
    "restart-delay": 1, "safe-height": 20, "setup-feed-rate": 2400, "thc-delay": 0.1, "thc-enable": 1,
    "thc-feed-rate": 2400, "thc-threshold": 1, "torch-enable": 1, "use-auto-volts": 1,
    "axis-z-max-limit": 15, "axis-z-min-limit": -150,
}  # fmt: skip
SURFACE = -20  # mm
TORCH = f"""
loadrt comp names=material
loadrt mux2 names=torch
addf material servo-thread
addf torch servo-thread
net plasmac:axis-position => material.in0
setp material.in1 {SURFACE}
net sim:float material.out => db_float.in
net plasmac:torch-on => torch.sel
setp torch.in1 100
net sim:arc-voltage-in torch.out => plasmac.arc-voltage-in
loadrt mux2 names=controlled
addf controlled servo-thread
net controlling plasmac.thc-active => controlled.sel
net height plasmac.z-height => controlled.in1
net held controlled.out => controlled.in0
"""
"""Material below the torch, an arc whenever it is on, and the height at which it was controlled last."""
PROGRAM = """G21 G90 G64 P0.1 F3000
M52 P1
G0 X10 Y10
M3 $0 S1
G1 X60
M5 $0
G0 X0 Y0
M2
"""
SCREEN = f"""#!{sys.executable}
import json, os, sys, time
sys.path.insert(0, {str(ROOT)!r})
import hal, linuxcnc, linuxcnc_util
machine = linuxcnc_util.LinuxCNC()
machine.wait_for_linuxcnc_startup(60.0)
stat, command, errors = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
watcher = hal.component("watcher")
watcher.ready()

def until(condition):
    for _ in range(12000):
        stat.poll()
        if condition():
            return
        time.sleep(0.01)
    raise SystemExit("the machine did not get there: " + repr(errors.poll()))

command.state(linuxcnc.STATE_ESTOP_RESET)
command.state(linuxcnc.STATE_ON)
until(lambda: stat.task_state == linuxcnc.STATE_ON)
command.mode(linuxcnc.MODE_MANUAL)
command.teleop_enable(0)
command.home(-1)
until(lambda: all(stat.homed[:4]) and hal.get_value("plasmac.homed"))
command.mode(linuxcnc.MODE_AUTO)
command.wait_complete()
command.program_open(os.path.join(os.path.dirname(__file__), "cut.ngc"))
command.auto(linuxcnc.AUTO_RUN, 1)
until(lambda: hal.get_value("plasmac.pierce-count") == 1)
until(lambda: stat.interp_state == linuxcnc.INTERP_IDLE and hal.get_value("plasmac.state-out") == 0)
until(lambda: stat.inpos and not any(hal.get_value(f"plasmac.{{axis}}-offset-current") for axis in "xyz"))
pins = ("pierce-count", "cut-length", "target-volts", "torch-on", "feed-hold", "z-offset-counts", "stop-type-out")
print("FOUND", json.dumps({{pin: hal.get_value("plasmac." + pin) for pin in pins}}))
print("WHERE", json.dumps([list(stat.actual_position[:3]), hal.get_value("controlled.out")]))
"""


def test_the_sample_plasma_table_probes_pierces_cuts_and_retracts(tmp_path: Path) -> None:
    folder = tmp_path / "qtplasmac"
    subprocess.run(["cp", "--recursive", "--dereference", SAMPLE, folder], check=False, stderr=subprocess.DEVNULL)
    (folder / "cut.ngc").write_text(PROGRAM)
    (folder / "custom.hal").write_text(
        TORCH + "".join(f"setp plasmac.{pin} {value}\n" for pin, value in SETTINGS.items())
    )
    screen = folder / "screen.py"
    screen.write_text(SCREEN)
    screen.chmod(0o755)
    for path in (folder / "qtplasmac_l_metric.ini", folder / "qtplasmac_metric_ini.inc"):
        text = re.sub(r"(?m)^ *DISPLAY *=.*$", f"DISPLAY = {screen}", path.read_text())
        text = re.sub(r"(?ms)^\[FILTER\].*?(?=^\[)", "", text)
        path.write_text(re.sub(r"(?m)^ *POSTGUI_HALFILE.*$", "", text))
    run = Run(folder / "qtplasmac_l_metric.ini", "-r", speed=3.0)
    try:
        code = run.finish(300.0)
    finally:
        run.stop()
    wait_until(lambda: not traces(), "everything is gone")
    shutil.rmtree(folder)
    assert code == 0, run.errors
    found, (position, height) = (json.loads(line.split(" ", 1)[1]) for line in run.output.splitlines() if " " in line)
    assert found["pierce-count"] == 1
    assert found["cut-length"] == pytest.approx(50.0, rel=0.1)
    assert height == pytest.approx(1.5, abs=0.1), "above the material"
    assert (found["torch-on"], found["feed-hold"], found["z-offset-counts"]) == (0, 0, 0)
    assert position == pytest.approx([0.0, 0.0, 0.0], abs=1e-3)
