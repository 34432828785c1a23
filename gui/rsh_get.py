"""The `get` commands of linuxcncrsh: one small function for each, in one table.

A function takes the session and the words behind the command, and returns the text behind the command's name in the
reply, or None where the words make no sense.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

import linuxcnc
from gui import rsh_values as values

if TYPE_CHECKING:
    from gui.rsh_session import Session

Getter = Callable[["Session", list[str]], str | None]

AXIS_LETTERS = "XYZABC"
POSE_LETTERS = "XYZRPW"  # LinuxCNC's letters for the six offsets


def _index(words: list[str]) -> int | None:
    """The joint or axis number of a command; -1 where the word is no number."""
    if not words:
        return None
    return int(words[0]) if words[0].isdecimal() else -1


def _per_joint(key: str, word: Callable[[float], str]) -> Getter:
    return lambda session, words: values.per_item(values.joints(session.status, key, word), _index(words))


def _per_spindle(word: Callable[[dict[str, float]], str]) -> Getter:
    """All of one spindle, the first where no number is given."""

    def getter(session: Session, words: list[str]) -> str | None:
        index = _index(words) or 0
        return word(session.status.spindle[index]) if 0 <= index < session.status.spindles else None

    return getter


def _positions(pick: Callable[[linuxcnc.stat], tuple[float, ...]], *, in_program: bool) -> Getter:
    """Six coordinates in display units, of the machine or of the program."""

    def getter(session: Session, words: list[str]) -> str | None:
        position = pick(session.status)
        if in_program:
            position = tuple(values.relative(position, session.status))
        scaled = [session.displayed(value, linear) for value, linear in zip(position, values.LINEAR_AXES, strict=False)]
        return values.per_item([f"{value:.6f}" for value in scaled], _index(words))

    return getter


def _joint_positions(session: Session, words: list[str]) -> str | None:
    return values.per_item(values.joints(session.status, "input", "{:.6f}".format), _index(words))


def _joint_units(session: Session, words: list[str]) -> str | None:
    names = [
        values.unit_name(
            joint["units"],
            values.ANGULAR_UNITS if joint["jointType"] == linuxcnc.ANGULAR else values.LINEAR_UNITS,
        )
        for joint in session.status.joint[: values.JOINTS_SHOWN]
    ]
    return values.per_item(names, _index(words))


def _joint_limits(session: Session, words: list[str]) -> str | None:
    limits = session.status.limit[: values.JOINTS_SHOWN]
    return values.per_item([values.joint_limit(mask) for mask in limits], _index(words))


def _pos_offset(session: Session, words: list[str]) -> str | None:
    offsets = [a + b for a, b in zip(session.status.g5x_offset, session.status.g92_offset, strict=True)]
    texts = [f"{session.displayed(v, linear):.6f}" for v, linear in zip(offsets, values.LINEAR_AXES, strict=False)]
    if not words:
        return " ".join(texts)
    letter = words[0].upper()
    return f"{letter} {texts[POSE_LETTERS.index(letter)]}" if letter in POSE_LETTERS else None


def _ini_value(session: Session, words: list[str]) -> str | None:
    if len(words) != 2:
        return None
    variable, section = words
    return linuxcnc.ini(session.status.ini_filename).find(section, variable)


def _percent(pick: Callable[[linuxcnc.stat], float]) -> Getter:
    return lambda session, words: f"{pick(session.status) * 100.0:.0f}"


def _status(word: Callable[[linuxcnc.stat], object]) -> Getter:
    return lambda session, words: str(word(session.status))


def _of_session(word: Callable[[Session], object]) -> Getter:
    return lambda session, words: str(word(session))


GETTERS: dict[str, Getter] = {
    "ABS_ACT_POS": _positions(lambda s: s.actual_position, in_program=False),
    "ABS_CMD_POS": _positions(lambda s: s.position, in_program=False),
    "ANGULAR_UNIT_CONVERSION": _of_session(lambda session: session.angular_conversion),
    "BRAKE": _per_spindle(lambda spindle: values.on_off(spindle["brake"])),
    "COMM_MODE": _of_session(lambda session: session.comm_mode),
    "COMM_PROT": _of_session(lambda session: session.protocol),
    "CONFIG": lambda session, words: "",
    "DEBUG": _status(lambda s: s.debug),
    "DISPLAY_ANGULAR_UNITS": _of_session(lambda session: session.display_angular_units),
    "DISPLAY_LINEAR_UNITS": _of_session(lambda session: session.display_linear_units),
    "ECHO": _of_session(lambda session: values.on_off(session.echo)),
    "ENABLE": _of_session(lambda session: values.on_off(session.enabled)),
    "ERROR": _of_session(lambda session: session.message("error")),
    "ESTOP": _status(lambda s: values.on_off(s.task_state == linuxcnc.STATE_ESTOP)),
    "FEED_OVERRIDE": _percent(lambda s: s.feedrate),
    "FLOOD": _status(lambda s: values.on_off(s.flood)),
    "INI": _ini_value,
    "INIFILE": _status(lambda s: s.ini_filename),
    "JOINT_FAULT": _per_joint("fault", lambda fault: "FAULT" if fault else "OK"),
    "JOINT_HOMED": _per_joint("homed", values.yes_no),
    "JOINT_LIMIT": _joint_limits,
    "JOINT_POS": _joint_positions,
    "JOINT_TYPE": _per_joint("jointType", lambda kind: values.JOINT_TYPES.get(int(kind), "CUSTOM")),
    "JOINT_UNITS": _joint_units,
    "KINEMATICS_TYPE": _status(lambda s: s.kinematics_type),
    "LINEAR_UNIT_CONVERSION": _of_session(lambda session: session.linear_conversion),
    "LUBE": _status(lambda s: values.on_off(s.lube)),
    "LUBE_LEVEL": _status(lambda s: "OK" if s.lube_level else "LOW"),
    "MACHINE": _status(lambda s: values.on_off(s.task_state == linuxcnc.STATE_ON)),
    "MIST": _status(lambda s: values.on_off(s.mist)),
    "MODE": _status(lambda s: values.TASK_MODES.get(s.task_mode, "?")),
    "OPERATOR_DISPLAY": _of_session(lambda session: session.message("display")),
    "OPERATOR_TEXT": _of_session(lambda session: session.message("text")),
    "OPTIONAL_STOP": _status(lambda s: int(s.optional_stop)),
    "OVERRIDE_LIMITS": _status(lambda s: int(any(joint["override_limits"] for joint in s.joint[: s.joints]))),
    "PLAT": lambda session, words: "Linux",
    "POS_OFFSET": _pos_offset,
    "PROBE_TRIPPED": _status(lambda s: int(s.probe_tripped)),
    "PROBE_VALUE": _status(lambda s: s.probe_val),
    "PROGRAM": _status(lambda s: s.file or "NONE"),
    "PROGRAM_ANGULAR_UNITS": lambda session, words: "DEG",
    "PROGRAM_CODES": _status(values.program_codes),
    "PROGRAM_LINE": _status(lambda s: s.motion_line if s.interp_state != linuxcnc.INTERP_IDLE else 0),
    "PROGRAM_LINEAR_UNITS": _status(lambda s: values.PROGRAM_UNITS.get(s.program_units, "NONE")),
    "PROGRAM_STATUS": _status(lambda s: values.PROGRAM_STATES.get(s.interp_state, "IDLE")),
    "PROGRAM_UNITS": _status(lambda s: values.PROGRAM_UNITS.get(s.program_units, "NONE")),
    "REL_ACT_POS": _positions(lambda s: s.actual_position, in_program=True),
    "REL_CMD_POS": _positions(lambda s: s.position, in_program=True),
    "SET_TIMEOUT": _of_session(lambda session: f"{session.timeout:.6f}"),
    "SET_WAIT": _of_session(lambda session: session.set_wait),
    "SPINDLE": _per_spindle(values.spindle_state),
    "SPINDLE_OVERRIDE": _per_spindle(lambda spindle: f"{spindle['override'] * 100.0:.0f}"),
    "TELEOP_ENABLE": _status(lambda s: values.yes_no(s.motion_mode == linuxcnc.TRAJ_MODE_TELEOP)),
    "TIME": lambda session, words: f"{time.time():.6f}",
    "TIMEOUT": _of_session(lambda session: f"{session.timeout:.6f}"),
    "TOOL": _status(lambda s: s.tool_in_spindle),
    "TOOL_OFFSET": _status(lambda s: f"{s.tool_offset[2]:.6f}"),
    "UPDATE": _of_session(lambda session: "AUTO" if session.fresh else "NONE"),
    "USER_ANGULAR_UNITS": _status(lambda s: values.unit_name(s.angular_units, values.ANGULAR_UNITS)),
    "USER_LINEAR_UNITS": _status(lambda s: values.unit_name(s.linear_units, values.LINEAR_UNITS)),
    "VERBOSE": _of_session(lambda session: values.on_off(session.verbose)),
}
