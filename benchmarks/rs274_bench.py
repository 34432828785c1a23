"""Blocks a second of the stand-alone interpreter on a 3-axis program, ours and Debian's in the same run.

    python benchmarks/rs274_bench.py [lines]
"""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
PEER = Path("/usr/bin/rs274")
RUNS = 3


def program(path: Path, lines: int) -> None:
    """A CAM-like program of short moves."""
    chance = random.Random(1)
    x = y = 0.0
    with open(path, "w") as file:
        file.write("G21 G90 G64 P0.01\nF1000\nG0 X0 Y0 Z5\n")
        for _ in range(lines):
            x, y = x + chance.uniform(-1, 1), y + chance.uniform(-1, 1)
            file.write(f"G1 X{x:.4f} Y{y:.4f} Z{chance.uniform(-1, 0):.4f}\n")
        file.write("M2\n")


def seconds(command: list[str], folder: Path) -> float:
    """Whole process, output to /dev/null, the best of some runs."""
    best = float("inf")
    for _ in range(RUNS):
        begin = time.perf_counter()
        subprocess.run(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        best = min(best, time.perf_counter() - begin)
    return best


def main() -> None:
    lines = int(sys.argv[1]) if len(sys.argv) > 1 else 200_000
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program(folder / "cam.ngc", lines)
        (folder / "test.var").write_text("")
        (folder / "rs274ngc").symlink_to(ROOT / "rs274ngc")
        (folder / "nml").symlink_to(ROOT / "nml")
        ours = seconds([sys.executable, "-m", "rs274ngc", "-g", "cam.ngc"], folder)
        print(f"ours      {ours:6.2f} s  {lines / ours:10.0f} blocks/s")
        if PEER.exists():
            theirs = seconds([str(PEER), "-v", "test.var", "-g", "cam.ngc"], folder)
            print(f"LinuxCNC  {theirs:6.2f} s  {lines / theirs:10.0f} blocks/s")
            print(f"ratio     {ours / theirs:6.2f}")


if __name__ == "__main__":
    main()
