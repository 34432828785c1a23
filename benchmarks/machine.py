"""The programs of the benchmarks, and the simulated mill that they run on, written into a folder.

The folder is a plain LinuxCNC configuration (``tests.support.plain_mill``): the same files are run by both controllers.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.support import plain_mill

CHANGES = {
    "NML_FILE = {folder}/server.nml\n": "",
    "LINEAR_VELOCITY = 30": "LINEAR_VELOCITY = 100",
    "VELOCITY = 50": "VELOCITY = 100",
    "LIMIT = -200": "LIMIT = -1000",
    "LIMIT = 200": "LIMIT = 1000",
}
"""What the mill of the comparisons has otherwise: here the built-in NML file, and more speed and room."""


def short_circle() -> str:
    """30,000 segments of 0.02 mm on a 100 mm radius at 100 mm/s, tolerance 0.005 mm, no merging."""
    step = 0.02 / 100.0
    points = (f"G1 X{100 * math.cos(i * step):.6f} Y{100 * math.sin(i * step):.6f}" for i in range(1, 30001))
    return "\n".join(["G21 G90 G94 G64 P0.005 Q0", "G0 X100 Y0 Z0", "F6000", *points, "M2", ""])


def wavy_curve() -> str:
    """20,000 points of r = 30 + 5 sin 7t, z = -1 - 0.5 sin 3t at 100 mm/s, tolerance 0.01 mm."""
    lines = ["G21 G90 G94 G64 P0.01", "G0 X30 Y0 Z-1", "F6000"]
    for i in range(1, 20001):
        t = 0.002 * i
        r = 30 + 5 * math.sin(7 * t)
        lines.append(f"G1 X{r * math.cos(t):.5f} Y{r * math.sin(t):.5f} Z{-1 - 0.5 * math.sin(3 * t):.5f}")
    return "\n".join([*lines, "M2", ""])


def zigzag() -> str:
    """100 zigzags of 20 mm with square corners."""
    lines = ["G21 G90 G94 G64 P0.01", "G0 X0 Y0 Z0", "F6000"]
    for i in range(100):
        lines += [f"G1 X{20 * (1 - i % 2)}", f"G1 Y{0.5 * (i + 1):.3f}"]
    return "\n".join([*lines, "M2", ""])


def cam_program(lines: int) -> str:
    """A raster-milled surface of ``lines`` blocks, as a CAM program would write it."""
    out = ["G21 G90 G94 G17 G64 P0.01", "F1000"]
    row = 500
    for i in range(lines - 3):
        y, k = divmod(i, row)
        x = 0.2 * (k if y % 2 == 0 else row - k)
        out.append(f"G1 X{x:.4f} Y{0.2 * y:.4f} Z{math.sin(0.11 * x) * math.cos(0.07 * y) - 2:.4f}")
    return "\n".join([*out, "M2", ""])


PROGRAMS = {"short_circle.ngc": short_circle, "wavy_curve.ngc": wavy_curve, "zigzag.ngc": zigzag}


def write(folder: Path, display: str) -> Path:
    """Write configuration and programs into ``folder``; the INI file's path."""
    for name, make in PROGRAMS.items():
        (folder / name).write_text(make())
    changes = {old.format(folder=folder): new for old, new in CHANGES.items()}
    return plain_mill.write(folder, display, changes)
