"""The `set` commands of linuxcncrsh: one small function for each, in one table.

A function takes the session and the words behind the command, and gives the machine or the session its order. It raises
`Refused` where the words make no sense; a command of the machine that fails raises ``linuxcnc.error`` by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import linuxcnc
from gui import rsh_values as values

if TYPE_CHECKING:
    from gui.rsh_session import Session

Setter = Callable[["Session", list[str]], None]

AXES = "XYZABCUVW"
PROTOCOL = 1.1


class Refused(Exception):
    """The command is not understood or not allowed now."""


def _word(words: list[str], position: int = 0) -> str:
    try:
        return words[position]
    except IndexError:
        raise Refused from None


def _real(words: list[str], position: int = 0, default: float | None = None) -> float:
    if default is not None and len(words) <= position:
        return default
    try:
        value = float(_word(words, position))
    except ValueError:
        raise Refused from None
    if not math.isfinite(value):
        raise Refused
    return value


def _integer(words: list[str], position: int = 0, default: int | None = None) -> int:
    if default is not None and len(words) <= position:
        return default
    try:
        return int(_word(words, position))
    except ValueError:
        raise Refused from None


def _choice(words: list[str], choices: dict[str, int]) -> int:
    try:
        return choices[_word(words).upper()]
    except KeyError:
        raise Refused from None


ON_OFF = {"OFF": 0, "ON": 1}
ESTOP = {"OFF": linuxcnc.STATE_ESTOP_RESET, "ON": linuxcnc.STATE_ESTOP}
MACHINE = {"OFF": linuxcnc.STATE_OFF, "ON": linuxcnc.STATE_ON}
MODES = {"MANUAL": linuxcnc.MODE_MANUAL, "AUTO": linuxcnc.MODE_AUTO, "MDI": linuxcnc.MODE_MDI}
SPINDLE_STEPS = {
    "OFF": linuxcnc.SPINDLE_OFF,
    "INCREASE": linuxcnc.SPINDLE_INCREASE,
    "DECREASE": linuxcnc.SPINDLE_DECREASE,
    "CONSTANT": linuxcnc.SPINDLE_CONSTANT,
}
SPINDLE_TURNS = {"FORWARD": linuxcnc.SPINDLE_FORWARD, "REVERSE": linuxcnc.SPINDLE_REVERSE}
SPINDLE_DEFAULT_SPEED = 1.0  # rpm of `set spindle forward`, as LinuxCNC's; M3 S.. gives a real one


def _command(give: Callable[[linuxcnc.command, list[str]], None]) -> Setter:
    """A setter that gives one order to the machine and waits as `set_wait` says."""

    def setter(session: Session, words: list[str]) -> None:
        give(session.command, words)
        session.wait_as_set()

    return setter


def _jog_target(words: list[str]) -> tuple[int, int]:
    """(joint flag, index) of a joint number or an axis letter."""
    word = _word(words).upper()
    if word.isdecimal() and int(word) < linuxcnc.MAX_JOINTS:
        return 1, int(word)
    if len(word) == 1 and word in AXES:
        return 0, AXES.index(word)
    raise Refused


def _jog_stop(command: linuxcnc.command, words: list[str]) -> None:
    command.jog(linuxcnc.JOG_STOP, *_jog_target(words))


def _jog(command: linuxcnc.command, words: list[str]) -> None:
    command.jog(linuxcnc.JOG_CONTINUOUS, *_jog_target(words), _real(words, 1) / 60.0)


def _jog_incr(command: linuxcnc.command, words: list[str]) -> None:
    command.jog(linuxcnc.JOG_INCREMENT, *_jog_target(words), _real(words, 1) / 60.0, _real(words, 2))


def _override_limits(command: linuxcnc.command, words: list[str]) -> None:
    if _choice(words, ON_OFF):
        command.override_limits()


def _spindle(command: linuxcnc.command, words: list[str]) -> None:
    name = _word(words).upper()
    number = _integer(words, 1, 0)
    if name in SPINDLE_TURNS:
        command.spindle(SPINDLE_TURNS[name], SPINDLE_DEFAULT_SPEED, number)
    else:
        command.spindle(_choice(words, SPINDLE_STEPS), number)


def _tool_offset(command: linuxcnc.command, words: list[str]) -> None:
    """Tool number, length and diameter."""
    command.tool_offset(_integer(words), _real(words, 1), 0.0, _real(words, 2, 0.0), 0.0, 0.0, 0)


def _probe(command: linuxcnc.command, words: list[str]) -> None:
    command.mdi(f"G38.2 X{_real(words):.6f} Y{_real(words, 1):.6f} Z{_real(words, 2):.6f}")


def _open(command: linuxcnc.command, words: list[str]) -> None:
    command.program_open(" ".join(words) or _word(words))


def _mdi(command: linuxcnc.command, words: list[str]) -> None:
    command.mdi(" ".join(words) or _word(words))


# --- the session's own settings --------------------------------------------------------------------------------------


def _enable(session: Session, words: list[str]) -> None:
    if _word(words).upper() == "OFF":
        session.enabled = False
    elif words[0] == session.server.enable_password:
        session.enabled = True
    else:
        session.enabled = False
        raise Refused


def _comm_mode(session: Session, words: list[str]) -> None:
    mode = _word(words).upper()
    if mode not in ("ASCII", "BINARY"):
        raise Refused
    session.comm_mode = mode


def _protocol(session: Session, words: list[str]) -> None:
    if _real(words) > PROTOCOL:
        raise Refused
    session.protocol = words[0]


def _set_wait(session: Session, words: list[str]) -> None:
    mode = _word(words).upper()
    if mode not in ("RECEIVED", "DONE"):
        raise Refused
    session.set_wait = mode


def _wait(session: Session, words: list[str]) -> None:
    mode = _word(words).upper()
    if mode == "DONE":
        session.wait_done()
    elif mode != "RECEIVED":
        raise Refused


def _timeout(session: Session, words: list[str]) -> None:
    session.timeout = _real(words)


def _update(session: Session, words: list[str]) -> None:
    session.fresh = bool(_choice(words, {"NONE": 0, "OFF": 0, "AUTO": 1, "ON": 1}))


def _linear_conversion(session: Session, words: list[str]) -> None:
    unit = _word(words).upper()
    if unit not in (*values.LINEAR_UNITS, "AUTO"):
        raise Refused
    session.linear_conversion = unit


def _angular_conversion(session: Session, words: list[str]) -> None:
    unit = _word(words).upper()
    if unit not in (*values.ANGULAR_UNITS, "AUTO"):
        raise Refused
    session.angular_conversion = unit


def _echo(session: Session, words: list[str]) -> None:
    session.echo = bool(_choice(words, ON_OFF))


def _verbose(session: Session, words: list[str]) -> None:
    session.verbose = bool(_choice(words, ON_OFF))


# What a connection may set without having control
FREE: dict[str, Setter] = {
    "COMM_MODE": _comm_mode,
    "COMM_PROT": _protocol,
    "ECHO": _echo,
    "ENABLE": _enable,
    "VERBOSE": _verbose,
}

SETTERS: dict[str, Setter] = FREE | {
    "ABORT": _command(lambda c, words: c.abort()),
    "ANGULAR_UNIT_CONVERSION": _angular_conversion,
    "BRAKE": _command(lambda c, words: c.brake(_choice(words, ON_OFF), _integer(words, 1, 0))),
    "CONFIG": lambda session, words: None,
    "DEBUG": _command(lambda c, words: c.debug(_integer(words))),
    "ESTOP": _command(lambda c, words: c.state(_choice(words, ESTOP))),
    "FEED_OVERRIDE": _command(lambda c, words: c.feedrate(_real(words) / 100.0)),
    "FLOOD": _command(lambda c, words: c.flood(_choice(words, ON_OFF))),
    "HOME": _command(lambda c, words: c.home(_integer(words))),
    "INIFILE": lambda session, words: None,
    "JOG": _command(_jog),
    "JOG_INCR": _command(_jog_incr),
    "JOG_STOP": _command(_jog_stop),
    "LINEAR_UNIT_CONVERSION": _linear_conversion,
    "LOAD_TOOL_TABLE": _command(lambda c, words: c.load_tool_table(_word(words))),
    "MACHINE": _command(lambda c, words: c.state(_choice(words, MACHINE))),
    "MDI": _command(_mdi),
    "MIST": _command(lambda c, words: c.mist(_choice(words, ON_OFF))),
    "MODE": _command(lambda c, words: c.mode(_choice(words, MODES))),
    "OPEN": _command(_open),
    "OPTIONAL_STOP": _command(lambda c, words: c.set_optional_stop(_integer(words, 0, 0))),
    "OVERRIDE_LIMITS": _command(_override_limits),
    "PAUSE": _command(lambda c, words: c.auto(linuxcnc.AUTO_PAUSE)),
    "PROBE": _command(_probe),
    "PROBE_CLEAR": lambda session, words: None,
    "RESUME": _command(lambda c, words: c.auto(linuxcnc.AUTO_RESUME)),
    "RUN": _command(lambda c, words: c.auto(linuxcnc.AUTO_RUN, _integer(words, 0, 0))),
    "SET_TIMEOUT": _timeout,
    "SET_WAIT": _set_wait,
    "SPINDLE": _command(_spindle),
    "SPINDLE_OVERRIDE": _command(lambda c, words: c.spindleoverride(_real(words) / 100.0, _integer(words, 1, 0))),
    "STEP": _command(lambda c, words: c.auto(linuxcnc.AUTO_STEP)),
    "TASK_PLAN_INIT": _command(lambda c, words: c.reset_interpreter()),
    "TELEOP_ENABLE": _command(lambda c, words: c.teleop_enable(_choice(words or ["ON"], ON_OFF))),
    "TIMEOUT": _timeout,
    "TOOL_OFFSET": _command(_tool_offset),
    "UPDATE": _update,
    "WAIT": _wait,
}
