"""The servo cycle beside LinuxCNC's: how long motion-controller runs, as a histogram, idle and while a program cuts.

    python -m benchmarks.servo_against_linuxcnc [--seconds 5]

The same three-axis machine runs on Debian's LinuxCNC and on ours, one after the other; HAL's sampler keeps the time of
each servo period on both. LinuxCNC counts CPU clocks; the length of its servo period in clocks gives their frequency.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import uuid
from itertools import pairwise
from pathlib import Path

from nml import namespace
from tests.support import stock_machine

EDGES = (2, 4, 6, 8, 10, 12, 15, 20, 30, 50, 100)  # us
SAMPLER = """\
HALCMD = loadrt sampler cfg=su depth=60000
HALCMD = net motion-time motion-controller.time sampler.0.pin.0
HALCMD = net servo-clocks motion.servo.last-period sampler.0.pin.1
HALCMD = addf sampler.0 servo-thread
[TRAJ]
"""
SCRIPT = """
s, c = linuxcnc.stat(), linuxcnc.command()
def do(call, *args):
    call(*args)
    c.wait_complete(10)
def sample():
    subprocess.run(["halcmd", "setp", "sampler.0.enable", "1"])
    text = subprocess.run(["halsampler", "-n", str(PERIODS)], capture_output=True, text=True, timeout=120).stdout
    subprocess.run(["halcmd", "setp", "sampler.0.enable", "0"])
    return [[int(word) for word in row.split()] for row in text.splitlines() if "overrun" not in row]
with open("cut.ngc", "w") as part:
    part.write("G21 G90 G64 P0.02 F2400\\n")
    for n in range(60000):
        part.write(f"G1 X{n % 97 * 0.05:.3f} Y{n % 61 * 0.07:.3f} Z{n % 13 * -0.02:.3f}\\n")
    part.write("M2\\n")
do(c.state, linuxcnc.STATE_ESTOP_RESET)
do(c.state, linuxcnc.STATE_ON)
do(c.home, -1)
time.sleep(1)
idle = sample()
do(c.mode, linuxcnc.MODE_AUTO)
c.program_open(os.path.abspath("cut.ngc"))
c.wait_complete(10)
c.auto(linuxcnc.AUTO_RUN, 0)
time.sleep(1)
cutting = sample()
do(c.abort)
out += [idle, cutting]
"""


def microseconds(rows: list[list[int]], clocks: bool) -> list[float]:
    """What each period took; ``clocks``: the rows count CPU clocks, else ns."""
    per_us = sum(row[1] for row in rows) / len(rows) / 1000.0 if clocks else 1000.0
    return sorted(row[0] / per_us for row in rows)


def histogram(figures: list[float]) -> list[str]:
    """How many of a thousand periods are below each edge and above the one before."""
    below = [sum(figure < edge for figure in figures) for edge in EDGES] + [len(figures)]
    counts = [below[0], *(after - before for before, after in pairwise(below))]
    return [f"{1000.0 * count / len(figures):.1f}" for count in counts]


def row(name: str, figures: list[float]) -> str:
    spread = [sum(figures) / len(figures), figures[len(figures) // 2], figures[-len(figures) // 1000], figures[-1]]
    return f"| {name} | {' | '.join(f'{value:.1f}' for value in spread)} | {' | '.join(histogram(figures))} |"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=5.0, help="how long each histogram is collected")
    script = SCRIPT.replace("PERIODS", str(int(parser.parse_args().seconds * 1000)))
    os.environ["PATH"] = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    os.environ[namespace.VARIABLE] = f"servo-{uuid.uuid4().hex[:6]}"
    changes = {"[TRAJ]\n": SAMPLER}
    machines = []
    with tempfile.TemporaryDirectory(dir="/var/tmp") as folder:
        machines.append(("pyemc", stock_machine.ours(Path(folder), script, changes=changes), False))
    if stock_machine.reason_to_skip() is None:
        machines.append(("LinuxCNC", stock_machine.display(script, changes=changes), True))
    print(f"| us | average | median | 99.9 % | worst | {' | '.join(f'< {edge}' for edge in EDGES)} | more |")
    print("|---" * (len(EDGES) + 6) + "|")
    for name, rows, clocks in machines:
        for how, sampled in zip(("idle", "cutting"), rows, strict=True):
            print(row(f"{name}, {how}", microseconds(sampled, clocks)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
