"""The values that other systems are told, with their names, types and units; ``mqtt`` and ``opcua`` publish this list.

Lengths are in the machine's units, which are among the values.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import linuxcnc

Value = bool | int | float | str | list[float] | list[bool]

STATES = {
    linuxcnc.STATE_ESTOP: "estop",
    linuxcnc.STATE_ESTOP_RESET: "off",
    linuxcnc.STATE_OFF: "off",
    linuxcnc.STATE_ON: "on",
}
MODES = {linuxcnc.MODE_MANUAL: "manual", linuxcnc.MODE_AUTO: "auto", linuxcnc.MODE_MDI: "mdi"}
PROGRAM_STATES = {
    linuxcnc.INTERP_IDLE: "idle",
    linuxcnc.INTERP_READING: "running",
    linuxcnc.INTERP_WAITING: "running",
    linuxcnc.INTERP_PAUSED: "paused",
}
MESSAGE_KINDS = {
    linuxcnc.NML_ERROR: "error",
    linuxcnc.OPERATOR_ERROR: "error",
    linuxcnc.NML_TEXT: "text",
    linuxcnc.OPERATOR_TEXT: "text",
    linuxcnc.NML_DISPLAY: "display",
    linuxcnc.OPERATOR_DISPLAY: "display",
}
DIGITS = 6  # of lengths and speeds: noise below that is no news
AXES = "XYZABCUVW"
MM_PER_INCH = 25.4


@dataclass(frozen=True, slots=True)
class Item:
    """One value: its name, what it means, its unit, and where the status has it."""

    name: str
    doc: str
    read: Callable[[linuxcnc.stat], Value]
    unit: str = ""


def _units(status: linuxcnc.stat) -> str:
    return "inch" if abs(status.linear_units * MM_PER_INCH - 1.0) < 1e-3 else "mm"


def _axes(status: linuxcnc.stat) -> str:
    return "".join(letter for bit, letter in enumerate(AXES) if status.axis_mask >> bit & 1)


def _position(pick: Callable[[linuxcnc.stat], tuple[float, ...]]) -> Callable[[linuxcnc.stat], Value]:
    """The positions of the machine's axes, in the order of the value `axes`."""

    def read(status: linuxcnc.stat) -> list[float]:
        return [round(at, DIGITS) for bit, at in enumerate(pick(status)) if status.axis_mask >> bit & 1]

    return read


def _of_spindles(key: str) -> Callable[[linuxcnc.stat], Value]:
    return lambda status: [round(float(one[key]), DIGITS) for one in status.spindle[: status.spindles]]


ITEMS: tuple[Item, ...] = (
    Item("state", "estop, off or on", lambda s: STATES.get(s.task_state, "unknown")),
    Item("mode", "manual, auto or mdi", lambda s: MODES.get(s.task_mode, "unknown")),
    Item("program/state", "idle, running or paused", lambda s: PROGRAM_STATES.get(s.interp_state, "unknown")),
    Item("program/file", "path of the program that is open", lambda s: s.file),
    Item("program/line", "line of the move under way", lambda s: s.motion_line),
    Item("axes", "letters of the axes, in the order of positions", _axes),
    Item("units", "unit of lengths: mm or inch", _units),
    Item("homed", "of each joint", lambda s: [bool(one) for one in s.homed[: s.joints]]),
    Item("position/actual", "of each axis, from feedback", _position(lambda s: s.actual_position), "units"),
    Item("position/commanded", "of each axis", _position(lambda s: s.position), "units"),
    Item("velocity", "along the path", lambda s: round(s.current_vel, DIGITS), "units/s"),
    Item("in_position", "the machine stands where it should", lambda s: bool(s.inpos)),
    Item("override/feed", "of the feed", lambda s: round(s.feedrate * 100.0, 3), "%"),
    Item("override/rapid", "of rapid moves", lambda s: round(s.rapidrate * 100.0, 3), "%"),
    Item("spindle/speed", "of each spindle, below 0 for reverse", _of_spindles("speed"), "rpm"),
    Item("spindle/override", "of each spindle, 1 is 100 %", _of_spindles("override")),
    Item("coolant/flood", "flood is on", lambda s: bool(s.flood)),
    Item("coolant/mist", "mist is on", lambda s: bool(s.mist)),
    Item("tool", "number of the loaded tool, 0 for none", lambda s: max(0, s.tool_in_spindle)),
)


def readings(status: linuxcnc.stat) -> dict[str, Value]:
    """All values of a status by their names."""
    return {item.name: item.read(status) for item in ITEMS}
