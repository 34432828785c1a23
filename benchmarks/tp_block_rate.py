#!/usr/bin/env python3
"""Blocks a second, sustained: 0.02 mm segments from a file through interpreter, task and motion queue of a machine.

    python benchmarks/tp_block_rate.py [--blocks N] [--feed MM_PER_S]

The machine is fast enough (400 mm/s, 20 m/s2) for the program to need its feed / 0.02 mm blocks a second; a display
polls its status. Shown: blocks a second over the whole run and over its slowest second, the share of the polls at the
full feed, and the least number of moves in the motion queue: 0 is a queue that ran dry.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from itertools import pairwise
from pathlib import Path

import machine

ROOT = Path(__file__).resolve().parent.parent
STEP = 0.02  # mm
RADIUS = 100.0  # mm
LEAD = 0.1  # share of the run at either end that does not count: the machine speeds up, the file ends

DISPLAY = """\
#!{python}
import json, os, sys, time
import linuxcnc
folder = os.path.dirname(os.path.abspath(__file__))
stat, command = linuxcnc.stat(), linuxcnc.command()
def wait(condition, seconds, each=lambda: None):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        stat.poll()
        each()
        if condition():
            return
        time.sleep(0.005)
    raise SystemExit("timeout")
command.state(linuxcnc.STATE_ESTOP_RESET)
wait(lambda: stat.task_state != linuxcnc.STATE_ESTOP, 20)
command.state(linuxcnc.STATE_ON)
wait(lambda: stat.task_state == linuxcnc.STATE_ON, 20)
command.home(-1)
wait(lambda: all(stat.homed[:3]), 30)
command.mode(linuxcnc.MODE_MDI)
command.wait_complete()
command.mdi("G0 X100")
command.wait_complete(30)
wait(lambda: stat.inpos and stat.interp_state == linuxcnc.INTERP_IDLE, 30)
command.mode(linuxcnc.MODE_AUTO)
command.wait_complete()
command.program_open(os.path.join(folder, "blocks.ngc"))
command.wait_complete()
rows = []
command.auto(linuxcnc.AUTO_RUN, 0)
wait(lambda: stat.motion_line > 4, 30)
record = lambda: rows.append((time.monotonic(), stat.motion_line, stat.current_vel, stat.queue))
wait(lambda: stat.interp_state == linuxcnc.INTERP_IDLE and stat.inpos, 600, record)
json.dump(rows, open(os.path.join(folder, "rows.json"), "w"))
"""


def program(blocks: int, feed: float) -> str:
    angles = (k * STEP / RADIUS for k in range(1, blocks + 1))
    points = (f"G1 X{RADIUS * math.cos(angle):.5f} Y{RADIUS * math.sin(angle):.5f}" for angle in angles)
    return "\n".join(["G21 G90 G94", "G64 P0.005 Q0", f"F{60 * feed}", *points, "M2", ""])


def run(blocks: int, feed: float) -> list[tuple[float, int, float, int]]:
    """Rows of time, line, speed and queue length."""
    with tempfile.TemporaryDirectory(prefix="pyemc-blocks-") as name:
        folder = Path(name)
        display = folder / "display.py"
        ini = machine.write(folder, str(display))
        text = ini.read_text()
        for key in ("LINEAR_VELOCITY", "VELOCITY"):
            text = text.replace(f"MAX_{key} = 100", f"MAX_{key} = 400")
        ini.write_text(text.replace("ACCELERATION = 500", "ACCELERATION = 20000"))
        display.write_text(DISPLAY.replace("{python}", sys.executable))
        display.chmod(0o755)
        (folder / "blocks.ngc").write_text(program(blocks, feed))
        environment = os.environ | {
            "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
            "PYEMC_NAMESPACE": f"blocks{os.getpid()}",
            "PYTHONPATH": str(ROOT),
        }
        command = [sys.executable, "-m", "linuxcnc_start", str(ini)]
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, timeout=900, check=False
        )
        rows = folder / "rows.json"
        if not rows.exists():
            sys.exit(done.stdout[-2000:] + done.stderr[-2000:])
        return json.loads(rows.read_text())


def slowest_second(rows: list[tuple[float, int, float, int]]) -> float:
    """Fewest lines that passed in any second."""
    least, first = math.inf, 0
    for now, line, *_ in rows:
        while rows[first + 1][0] <= now - 1.0:
            first += 1
        if rows[first][0] <= now - 1.0:
            least = min(least, (line - rows[first][1]) / (now - rows[first][0]))
    return least


def main() -> int:
    options = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    options.add_argument("--blocks", type=int, default=200_000)
    options.add_argument("--feed", type=float, default=240.0, help="mm/s: needs 50 blocks a second for each mm/s")
    chosen = options.parse_args()
    rows = run(chosen.blocks, chosen.feed)
    seconds = rows[-1][0] - rows[0][0]
    inside = [row for row in rows if LEAD * chosen.blocks < row[1] < (1.0 - LEAD) * chosen.blocks]
    full = sum(row[2] >= 0.999 * chosen.feed for row in inside) / len(inside)
    gap = max(after[0] - before[0] for before, after in pairwise(rows))
    needed = chosen.feed / STEP
    print(f"program: {chosen.blocks} blocks of {STEP} mm, {chosen.feed:g} mm/s: needs {needed:,.0f} blocks/s")
    print(f"whole run: {chosen.blocks / seconds:,.0f} blocks/s; slowest second {slowest_second(inside):,.0f} blocks/s")
    print(f"at full feed: {100 * full:.1f} % of {len(inside)} polls (longest gap between two: {1000 * gap:.0f} ms)")
    print(f"least moves in the motion queue: {min(row[3] for row in inside)}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
