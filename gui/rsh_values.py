"""Values of the status as linuxcncrsh words them: units, joints, positions, program state."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

import linuxcnc

JOINTS_SHOWN = 6  # joints and axes in a reply that names none
LINEAR_AXES = (True, True, True, False, False, False)  # X Y Z A B C

# Units by their name in replies: per mm, per degree
LINEAR_UNITS = {"INCH": 1 / 25.4, "MM": 1.0, "CM": 0.1}
ANGULAR_UNITS = {"DEG": 1.0, "RAD": math.pi / 180.0, "GRAD": 100.0 / 90.0}
PROGRAM_UNITS = {1: "INCH", 2: "MM", 3: "CM"}

TASK_MODES = {linuxcnc.MODE_MANUAL: "MANUAL", linuxcnc.MODE_AUTO: "AUTO", linuxcnc.MODE_MDI: "MDI"}
PROGRAM_STATES = {
    linuxcnc.INTERP_IDLE: "IDLE",
    linuxcnc.INTERP_READING: "RUNNING",
    linuxcnc.INTERP_WAITING: "RUNNING",
    linuxcnc.INTERP_PAUSED: "PAUSED",
}
JOINT_TYPES = {linuxcnc.LINEAR: "LINEAR", linuxcnc.ANGULAR: "ANGULAR"}
LIMIT_NAMES = ((1, "MINHARD"), (4, "MINSOFT"), (2, "MAXHARD"), (8, "MAXSOFT"))


def unit_name(value: float, names: dict[str, float]) -> str:
    """The name of the unit that is ``value`` per mm or per degree."""
    for name, factor in names.items():
        if math.isclose(value, factor, rel_tol=1e-3):
            return name
    return "CUSTOM"


def on_off(value: object) -> str:
    return "ON" if value else "OFF"


def yes_no(value: object) -> str:
    return "YES" if value else "NO"


def joint_limit(mask: int) -> str:
    return next((name for bit, name in LIMIT_NAMES if mask & bit), "OK")


def spindle_state(spindle: dict[str, float]) -> str:
    """FORWARD, REVERSE, INCREASE, DECREASE or OFF."""
    if spindle["increasing"]:
        return "INCREASE" if spindle["increasing"] > 0 else "DECREASE"
    if not spindle["enabled"]:
        return "OFF"
    return "FORWARD" if spindle["direction"] > 0 else "REVERSE"


def program_codes(status: linuxcnc.stat) -> str:
    """The active G-codes, feed and speed as one line of words."""
    codes = [f"G{code / 10:g}" for code in status.gcodes[1:] if code >= 0]
    return " ".join([*codes, f"F{status.settings[1]:.0f}", f"S{status.settings[2]:.0f}"])


def relative(absolute: Sequence[float], status: linuxcnc.stat) -> list[float]:
    """A machine position in the coordinates of the program."""
    x, y, z, *rest = (
        value - g5x - tool
        for value, g5x, tool in zip(absolute, status.g5x_offset, status.tool_offset, strict=True)
    )
    angle = -math.radians(status.rotation_xy)
    x, y = x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)
    return [value - g92 for value, g92 in zip((x, y, z, *rest), status.g92_offset, strict=True)]


def per_item(items: Iterable[str], index: int | None) -> str | None:
    """All items as one line, or ``index item``; None for an index that does not exist."""
    words = list(items)
    if index is None:
        return " ".join(words)
    return f"{index} {words[index]}" if 0 <= index < len(words) else None


def joints(status: linuxcnc.stat, key: str, word: Callable[[float], str]) -> list[str]:
    return [word(joint[key]) for joint in status.joint[:JOINTS_SHOWN]]
