"""What clients see of the status: ``linuxcnc.stat`` as a flat map of plain values. Pure: a status in, a map out."""

from __future__ import annotations

import math
from typing import Any

import linuxcnc

PLAIN = (
    "task_state", "task_mode", "interp_state", "exec_state", "motion_mode", "motion_type", "state", "enabled", "inpos",
    "paused", "optional_stop", "block_delete", "feed_hold_enabled", "adaptive_feed_enabled", "feed_override_enabled",
    "probing", "probe_tripped", "position", "actual_position", "dtg", "g5x_offset", "g92_offset", "tool_offset",
    "probed_position", "g5x_index", "rotation_xy", "gcodes", "mcodes", "settings", "program_units", "current_vel",
    "distance_to_go", "delay_left", "feedrate", "rapidrate", "max_velocity", "tool_in_spindle", "pocket_prepped",
    "tool_from_pocket", "file", "motion_line", "current_line", "read_line", "call_level", "command",
    "queued_mdi_commands", "kinematics_type", "input_timeout", "linear_units", "angular_units", "joints",
)  # fmt: skip
FLAGS = ("flood", "mist", "lube", "estop", "task_paused")
LONG = ("din", "dout", "ain", "aout", "misc_error")
OF_JOINTS = {
    "homed": "homed",
    "homing": "homing",
    "joint_enabled": "enabled",
    "joint_fault": "fault",
    "joint_velocity": "velocity",
    "joint_ferror": "ferror_current",
    "joint_position": "output",
    "joint_actual_position": "input",
}
LIMIT_BITS = (("min_hard_limit", 1), ("max_hard_limit", 2), ("min_soft_limit", 4), ("max_soft_limit", 8))
NO_CODE = -1


def read(status: linuxcnc.stat, long: bool = True) -> dict[str, Any]:
    """The map for one status; without ``long`` the long arrays of inputs and outputs are left out."""
    values: dict[str, Any] = {name: _plain(getattr(status, name)) for name in PLAIN}
    values |= {name: bool(getattr(status, name)) for name in FLAGS}
    if long:
        values |= {name: list(getattr(status, name)) for name in LONG}
    joints = status.joint[: status.joints]
    values |= {name: [joint[key] for joint in joints] for name, key in OF_JOINTS.items()}
    values["limit"] = [sum(bit for name, bit in LIMIT_BITS if joint[name]) for joint in joints]
    values["all_homed"] = bool(joints) and all(joint["homed"] for joint in joints)
    values["spindle"] = [dict(spindle) for spindle in status.spindle[: status.spindles]]
    values["gcode_text"] = [
        f"G{code // 10}" + (f".{code % 10}" if code % 10 else "") for code in status.gcodes[1:] if code >= 0
    ]
    values["mcode_text"] = [f"M{code}" for code in status.mcodes[1:] if code != NO_CODE]
    for name, position in (("work_position", status.position), ("work_actual_position", status.actual_position)):
        values[name] = work_position(position, status)
    return values


def work_position(position: tuple[float, ...], status: linuxcnc.stat) -> list[float]:
    """A machine position in the active coordinate system: without tool, G5x and G92 offsets and rotation."""
    g5x, g92, tool = status.g5x_offset, status.g92_offset, status.tool_offset
    work = [place - tool[axis] - g5x[axis] for axis, place in enumerate(position)]
    angle = -math.radians(status.rotation_xy)
    if angle:
        x, y = work[0], work[1]
        work[0] = x * math.cos(angle) - y * math.sin(angle)
        work[1] = x * math.sin(angle) + y * math.cos(angle)
    return [place - g92[axis] for axis, place in enumerate(work)]


def _plain(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value
