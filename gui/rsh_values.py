"""Values of the status as linuxcncrsh words them: units, positions, program state."""

from __future__ import annotations

import math
from collections.abc import Sequence

import linuxcnc

# Units by their name in replies: per mm, per degree
LINEAR_UNITS = {"INCH": 1 / 25.4, "MM": 1.0, "CM": 0.1}
ANGULAR_UNITS = {"DEG": 1.0, "RAD": math.pi / 180.0, "GRAD": 100.0 / 90.0}
PROGRAM_UNITS = {1: "INCH", 2: "MM", 3: "CM"}
CUSTOM = "CUSTOM"

TASK_MODES = {linuxcnc.MODE_MANUAL: "MANUAL", linuxcnc.MODE_AUTO: "AUTO", linuxcnc.MODE_MDI: "MDI"}
PROGRAM_STATES = {
    linuxcnc.INTERP_IDLE: "IDLE",
    linuxcnc.INTERP_READING: "RUNNING",
    linuxcnc.INTERP_WAITING: "RUNNING",
    linuxcnc.INTERP_PAUSED: "PAUSED",
}
JOINT_TYPES = {linuxcnc.LINEAR: "LINEAR", linuxcnc.ANGULAR: "ANGULAR"}
JOINT_UNITS = {linuxcnc.LINEAR: LINEAR_UNITS, linuxcnc.ANGULAR: ANGULAR_UNITS}
LIMIT_NAMES = ((1, "MINHARD"), (4, "MINSOFT"), (8, "MAXSOFT"), (2, "MAXHARD"))


def unit_name(value: float, names: dict[str, float]) -> str:
    """The name of the unit that is ``value`` per mm or per degree."""
    for name, factor in names.items():
        if math.isclose(value, factor, rel_tol=1e-3):
            return name
    return CUSTOM


def on_off(value: object) -> str:
    return "ON" if value else "OFF"


def yes_no(value: object) -> str:
    return "YES" if value else "NO"


def joint_limit(mask: int) -> str:
    return next((name for bit, name in LIMIT_NAMES if mask & bit), "OK")


def spindle_state(spindle: dict[str, float]) -> str:
    """INCREASE, DECREASE, FORWARD, REVERSE or OFF."""
    if spindle["increasing"]:
        return "INCREASE" if spindle["increasing"] > 0 else "DECREASE"
    direction = spindle["direction"]
    return "FORWARD" if direction > 0 else "REVERSE" if direction < 0 else "OFF"


def program_codes(status: linuxcnc.stat) -> str:
    """The active G-codes, feed and speed as one line of words."""
    codes = [f"G{code / 10:g}" for code in status.gcodes[1:] if code >= 0]
    return " ".join([*codes, f"F{status.settings[1]:.0f}", f"S{abs(status.settings[2]):.0f}"])


def program_line(status: linuxcnc.stat, first: int) -> int:
    """The line that a program is at; ``first``: the line that it was started from, below 0 for a check."""
    if first < 0 or status.read_line < first:
        return status.read_line
    if status.current_line <= 0:
        return 0
    return status.motion_line if 0 < status.motion_line < status.current_line else status.current_line


def from_offsets(position: Sequence[float], status: linuxcnc.stat) -> list[float]:
    """A machine position seen from the origin of the coordinate system, the tool's length included."""
    return [at - g5x - g92 for at, g5x, g92 in zip(position, status.g5x_offset, status.g92_offset, strict=True)]


def in_program(absolute: Sequence[float], status: linuxcnc.stat) -> list[float]:
    """A machine position in the coordinates of the program: without offsets, tool and rotation."""
    x, y, z, *rest = (
        value - g5x - tool
        for value, g5x, tool in zip(absolute, status.g5x_offset, status.tool_offset, strict=True)
    )
    angle = -math.radians(status.rotation_xy)
    x, y = x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)
    return [value - g92 for value, g92 in zip((x, y, z, *rest), status.g92_offset, strict=True)]
