"""The `get` commands of linuxcncrsh: one small function for each, in one table.

A function takes the session and the arguments, and returns what stands behind the command's name in the reply, or
several such texts for a reply of several lines. It raises `Refused` where the arguments make no sense.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import linuxcnc
from gui import rsh_values as values
from gui.rsh_words import ALL, AXES, Arguments, Refused

if TYPE_CHECKING:
    from gui.rsh_session import Session

Getter = Callable[["Session", Arguments], "str | list[str]"]

LINEAR_AXES = (0, 1, 2, 6, 7, 8)


@dataclass(frozen=True, slots=True)
class Question:
    """One `get` command. ``said``: the name in the reply, where it is another one."""

    answer: Getter
    usage: str = ""
    least: int = 0
    said: str = ""


def _axis(session: Session, arguments: Arguments) -> int:
    """The axis that is asked for; ALL where none is named."""
    if not len(arguments) or arguments.is_number(0):
        axis = arguments.integer(0, ALL)
        if not ALL <= axis < len(AXES):
            raise Refused(f"Invalid axis '{axis}', valid range [-1,{len(AXES) - 1}]")
        return axis
    axis = arguments.axis_letter(0)
    if not session.status.axis_mask >> axis & 1:
        session.warn(f"Axis '{arguments.words[0]}', not configured")
    return axis


def _of_axes(pick: Callable[[Session], Sequence[float]]) -> Question:
    """Nine numbers, or that of one axis."""

    def answer(session: Session, arguments: Arguments) -> str:
        axis = _axis(session, arguments)
        numbers = pick(session)
        if axis == ALL:
            return " ".join(f"{number:f}" for number in numbers)
        return f"{AXES[axis]} {numbers[axis]:f}"

    return Question(answer, "[<axis>|-1]")


def _of_joints(word: Callable[[dict[str, Any]], str]) -> Question:
    """One word for each joint of the machine, or that of one joint."""

    def answer(session: Session, arguments: Arguments) -> str:
        number = arguments.joint(0, session.status)
        joints = session.status.joint
        if number == ALL:
            return " ".join(word(joint) for joint in joints[: session.status.joints])
        return f"{number} {word(joints[number])}"

    return Question(answer, "[<joint>|-1]")


def _of_spindles(word: Callable[[dict[str, Any]], str], default: int = 0) -> Question:
    """One line for each spindle."""

    def answer(session: Session, arguments: Arguments) -> list[str]:
        numbers = arguments.spindles(0, session.status, default)
        spindles = session.status.spindle
        return [f"{number} {word(spindles[number])}" for number in numbers]

    return Question(answer, "[<spindle>|-1]")


def _of_status(word: Callable[[linuxcnc.stat], object]) -> Question:
    return Question(lambda session, arguments: str(word(session.status)))


def _of_session(word: Callable[[Session], object]) -> Question:
    return Question(lambda session, arguments: str(word(session)))


def _limit_mask(joint: dict[str, Any]) -> int:
    keys = ("min_hard_limit", "max_hard_limit", "min_soft_limit", "max_soft_limit")
    return sum(bool(joint[key]) << bit for bit, key in enumerate(keys))


def _joint_units(joint: dict[str, Any]) -> str:
    names = values.JOINT_UNITS.get(joint["jointType"])
    return values.unit_name(joint["units"], names) if names else values.CUSTOM


def _pos_offset(session: Session) -> list[float]:
    status = session.status
    offsets = [a + b for a, b in zip(status.g5x_offset, status.g92_offset, strict=True)]
    return [session.displayed(offset) if axis in LINEAR_AXES else offset for axis, offset in enumerate(offsets)]


def _ini_value(session: Session, arguments: Arguments) -> str:
    variable, section = arguments.words[:2]
    value = session.ini(section, variable)
    if value is None:
        raise Refused(f"INI file entry '[{section}]{variable}' not found")
    return f"[{section}]{variable}={value}"


def _protocol(session: Session, arguments: Arguments) -> str:
    session.warn("GET COMM_PROT has been deprecated. It has no function.")
    return session.version


def _clients(session: Session, arguments: Arguments) -> list[str]:
    words = ((" LINKED", "linked"), (" ENABLED", "enabled"))
    return [
        f"{one.number} '{one.client}'" + "".join(word for word, name in words if getattr(one, name))
        for one in session.server.sessions
    ]


def _timestamp(session: Session) -> str:
    return f"{values.on_off(session.timestamp)} {values.on_off(session.readable_time)}"


GETTERS: dict[str, Question] = {
    "ABS_ACT_POS": _of_axes(lambda session: session.status.actual_position),
    "ABS_CMD_POS": _of_axes(lambda session: session.status.position),
    "ANGULAR_UNIT_CONVERSION": _of_session(lambda session: session.angular_conversion),
    "AXIS_VELOCITY": _of_axes(lambda session: [axis["velocity"] for axis in session.status.axis]),
    "BRAKE": _of_spindles(lambda spindle: values.on_off(spindle["brake"])),
    "CLIENTS": Question(_clients),
    "COMM_MODE": _of_session(lambda session: session.comm_mode),
    "COMM_PROT": Question(_protocol),
    "CONFIG": Question(lambda session, arguments: ""),
    "DEBUG": _of_status(lambda s: f"0x{s.debug & 0xFFFFFFFF:08x}"),
    "DISPLAY_ANGULAR_UNITS": _of_session(lambda session: session.display_angular_units),
    "DISPLAY_LINEAR_UNITS": _of_session(lambda session: session.display_linear_units),
    "ECHO": _of_session(lambda session: values.on_off(session.echo)),
    "ENABLE": _of_session(lambda session: values.on_off(session.enabled)),
    "ERROR": _of_session(lambda session: session.message("error")),
    "ESTOP": _of_status(lambda s: values.on_off(s.task_state == linuxcnc.STATE_ESTOP)),
    "FEED_OVERRIDE": _of_status(lambda s: f"{s.feedrate * 100.0:f}"),
    "FLOOD": _of_status(lambda s: values.on_off(s.flood)),
    "INI": Question(_ini_value, "<var> <section>", least=2),
    "INIFILE": _of_status(lambda s: s.ini_filename),
    "JOINT_FAULT": _of_joints(lambda joint: "FAULT" if joint["fault"] else "OK"),
    "JOINT_HOMED": _of_joints(lambda joint: values.yes_no(joint["homed"])),
    "JOINT_LIMIT": _of_joints(lambda joint: values.joint_limit(_limit_mask(joint))),
    "JOINT_POS": _of_joints(lambda joint: f"{joint['input']:f}"),
    "JOINT_TYPE": _of_joints(lambda joint: values.JOINT_TYPES.get(joint["jointType"], values.CUSTOM)),
    "JOINT_UNITS": _of_joints(_joint_units),
    "JOINT_VELOCITY": _of_joints(lambda joint: f"{joint['velocity']:f}"),
    "KINEMATICS_TYPE": _of_status(lambda s: s.kinematics_type),
    "LINEAR_UNIT_CONVERSION": _of_session(lambda session: session.linear_conversion),
    "LUBE": _of_status(lambda s: values.on_off(s.lube)),
    "LUBE_LEVEL": _of_status(lambda s: "OK" if s.lube_level else "LOW"),
    "MACHINE": _of_status(lambda s: values.on_off(s.task_state == linuxcnc.STATE_ON)),
    "MIST": _of_status(lambda s: values.on_off(s.mist)),
    "MODE": _of_status(lambda s: values.TASK_MODES.get(s.task_mode, "?")),
    "OPEN": _of_session(lambda session: session.program or "NONE"),
    "OPERATOR_DISPLAY": _of_session(lambda session: session.message("display")),
    "OPERATOR_TEXT": _of_session(lambda session: session.message("text")),
    "OPTIONAL_STOP": _of_status(lambda s: values.on_off(s.optional_stop)),
    "OVERRIDE_LIMITS": _of_status(lambda s: values.on_off(s.joint[0]["override_limits"])),
    "PLAT": Question(lambda session, arguments: "Linux"),
    "POS_OFFSET": _of_axes(_pos_offset),
    "PROBE_TRIPPED": _of_status(lambda s: values.yes_no(s.probe_tripped)),
    "PROBE_VALUE": _of_status(lambda s: s.probe_val),
    "PROGRAM": _of_status(lambda s: s.file or "NONE"),
    "PROGRAM_ANGULAR_UNITS": Question(lambda session, arguments: "DEG"),
    "PROGRAM_CODES": _of_status(values.program_codes),
    "PROGRAM_LINE": _of_session(lambda session: values.program_line(session.status, session.first_line)),
    "PROGRAM_LINEAR_UNITS": Question(
        lambda session, arguments: values.PROGRAM_UNITS.get(session.status.program_units, values.CUSTOM),
        said="PROGRAM_UNITS",
    ),
    "PROGRAM_STATUS": _of_status(lambda s: values.PROGRAM_STATES.get(s.interp_state, "IDLE")),
    "PROGRAM_UNITS": _of_status(lambda s: values.PROGRAM_UNITS.get(s.program_units, values.CUSTOM)),
    "REL_ACT_POS": _of_axes(lambda session: values.from_offsets(session.status.actual_position, session.status)),
    "REL_CMD_POS": _of_axes(lambda session: values.from_offsets(session.status.position, session.status)),
    "SET_TIMEOUT": _of_session(lambda session: f"{session.timeout:f}"),
    "SET_WAIT": _of_session(lambda session: session.wait_mode),
    "SPINDLE": _of_spindles(values.spindle_state),
    "SPINDLE_OVERRIDE": _of_spindles(lambda spindle: f"{spindle['override'] * 100.0:g}", default=ALL),
    "TELEOP_ENABLE": _of_status(lambda s: values.on_off(s.motion_mode == linuxcnc.TRAJ_MODE_TELEOP)),
    "TIME": Question(lambda session, arguments: f"{time.time():f}"),
    "TIMEOUT": _of_session(lambda session: f"{session.timeout:f}"),
    "TIMESTAMP": _of_session(_timestamp),
    "TOOL": _of_status(lambda s: s.tool_in_spindle),
    "TOOL_OFFSET": _of_status(lambda s: f"{s.tool_offset[2]:f}"),
    "UPDATE": _of_session(lambda session: "AUTO" if session.fresh else "NONE"),
    "USER_ANGULAR_UNITS": _of_status(lambda s: values.unit_name(s.angular_units, values.ANGULAR_UNITS)),
    "USER_LINEAR_UNITS": _of_status(lambda s: values.unit_name(s.linear_units, values.LINEAR_UNITS)),
    "VERBOSE": _of_session(lambda session: values.on_off(session.verbose)),
    "WAIT_MODE": _of_session(lambda session: session.wait_mode),
}

# Commands of `set` that `get` passes over without a word
UNANSWERED = ("PROBE", "PROBE_CLEAR", "WAIT", "WAIT_HEARTBEAT")
