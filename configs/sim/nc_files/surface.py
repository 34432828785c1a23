#!/usr/bin/env python3
"""Write surface.ngc: a ball-nose finishing pass over a rippled surface, in more than 20,000 short moves.

The surface is a product of two sines under a dome, cut along X in a zigzag over 80 x 60 mm. Neighbouring points are
about 0.3 mm apart, so that the program exercises look-ahead, blending and the rate of blocks, as CAM output does.
Usage: surface.py [FILE]
"""

import math
import sys
from pathlib import Path

LENGTH, WIDTH = 80.0, 60.0  # mm, X and Y
STEP, ROW = 0.3, 0.75  # mm between points of a row and between rows
RIPPLE, DOME = 2.0, 6.0  # mm, heights
FEED = 3000  # mm/min
CLEARANCE = 5.0  # mm above the part


def height(x: float, y: float) -> float:
    """Z of the surface in mm; the highest point is at most 0."""
    ripple = RIPPLE * math.sin(x / 6.0) * math.cos(y / 7.0)
    dome = DOME * math.cos(math.pi * x / (2.2 * LENGTH)) * math.cos(math.pi * y / (2.2 * WIDTH))
    return ripple + dome - RIPPLE - DOME


def blocks() -> list[str]:
    """The program, one string for each block."""
    lines = [
        "(A rippled dome, 80 x 60 mm, written by surface.py; zero is the middle of the stock's top)",
        "G21 G17 G40 G49 G80 G90 G94 G54",
        "G64 P0.01",
        "T1 M6 G43",
        "S8000 M3",
        "M8",
    ]
    columns, rows = round(LENGTH / STEP), round(WIDTH / ROW)
    for row in range(rows + 1):
        y = row * ROW - WIDTH / 2
        xs = [column * STEP - LENGTH / 2 for column in range(columns + 1)]
        if row % 2:
            xs.reverse()
        if row == 0:
            lines += [f"G0 Z{CLEARANCE:.3f}", f"G0 X{xs[0]:.3f} Y{y:.3f}"]
            lines += [f"G1 Z{height(xs[0], y):.4f} F600", f"F{FEED}"]
        lines += [f"G1 X{x:.3f} Y{y:.3f} Z{height(x, y):.4f}" for x in xs]
    return [*lines, f"G0 Z{CLEARANCE:.3f}", "M9", "M5", "M2"]


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("surface.ngc")
    target.write_text("\n".join(blocks()) + "\n")
