"""A three-axis simulated mill and the programs that the benchmarks run on it, written into a folder.

The folder is a plain LinuxCNC configuration (INI, HAL, tool table): the same files are run by both controllers.
"""

from __future__ import annotations

import math
from pathlib import Path

INI = """\
[EMC]
MACHINE = bench
VERSION = 1.1
DEBUG = 0
[DISPLAY]
DISPLAY = {display}
PROGRAM_PREFIX = .
MAX_FEED_OVERRIDE = 1.2
CYCLE_TIME = 0.1
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = bench.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 1.0
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.1
TOOL_TABLE = bench.tbl
[HAL]
HALFILE = bench.hal
[TRAJ]
COORDINATES = X Y Z
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = 100
MAX_LINEAR_VELOCITY = 100
DEFAULT_LINEAR_ACCELERATION = 500
MAX_LINEAR_ACCELERATION = 500
[KINS]
KINEMATICS = trivkins
JOINTS = 3
"""

AXIS = """\
[AXIS_{letter}]
MAX_VELOCITY = 100
MAX_ACCELERATION = 500
MIN_LIMIT = -1000
MAX_LIMIT = 1000
[JOINT_{joint}]
TYPE = LINEAR
MAX_VELOCITY = 100
MAX_ACCELERATION = 500
MIN_LIMIT = -1000
MAX_LIMIT = 1000
FERROR = 1
MIN_FERROR = 0.5
HOME_SEQUENCE = 0
"""

HAL = """\
loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net Xpos joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net Ypos joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net Zpos joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net estop-loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net tool-prep-loop iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net tool-change-loop iocontrol.0.tool-change => iocontrol.0.tool-changed
"""


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
    (folder / "bench.tbl").write_text("T1 P1 D1 Z0\n")
    (folder / "bench.hal").write_text(HAL)
    ini = folder / "bench.ini"
    axes = "".join(AXIS.format(letter=letter, joint=joint) for joint, letter in enumerate("XYZ"))
    ini.write_text(INI.format(display=display) + axes)
    return ini
