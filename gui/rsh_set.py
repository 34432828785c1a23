"""The `set` commands of linuxcncrsh: one small function for each, in one table.

A function takes the session and the arguments, and gives the machine or the session its order. It raises `Refused`
where the arguments make no sense; a command of the machine that fails raises ``linuxcnc.error`` by itself.
"""

from __future__ import annotations

import enum
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import linuxcnc
from gui import rsh_values as values
from gui.rsh_words import ALL, Arguments, Refused

if TYPE_CHECKING:
    from gui.rsh_session import Session

Setter = Callable[["Session", Arguments], None]

VOLATILE = -2  # unhomes the joints with VOLATILE_HOME
LIMITS_IN_FORCE = -1  # in place of a joint whose limits are overridden
FULL = 100.0  # percent; the greatest spindle override
HOMING_TIMEOUT, LONGEST_HOMING_TIMEOUT = 10.0, 300.0  # host seconds

MODES = {"MANUAL": linuxcnc.MODE_MANUAL, "AUTO": linuxcnc.MODE_AUTO, "MDI": linuxcnc.MODE_MDI}
RECEIVED_DONE = {"RECEIVED": 0, "DONE": 1}
NONE_AUTO = {"NONE": 0, "AUTO": 1}
SPINDLE = {
    "FORWARD": linuxcnc.SPINDLE_FORWARD,
    "REVERSE": linuxcnc.SPINDLE_REVERSE,
    "INCREASE": linuxcnc.SPINDLE_INCREASE,
    "DECREASE": linuxcnc.SPINDLE_DECREASE,
    "CONSTANT": linuxcnc.SPINDLE_CONSTANT,
    "OFF": linuxcnc.SPINDLE_OFF,
}
TURNS = (linuxcnc.SPINDLE_FORWARD, linuxcnc.SPINDLE_REVERSE)


class Access(enum.IntEnum):
    """What a connection needs for a command; each of them includes those before it."""

    NOTHING = 0
    HELLO = 1
    ENABLED = 2
    MACHINE_ON = 3


@dataclass(frozen=True, slots=True)
class Setting:
    """One `set` command.

    ``order``: the machine carries it out, so the reply may have to wait for its end; ``waits``: it has an end that
    comes by itself.
    """

    act: Setter
    usage: str = ""
    least: int = 0
    access: Access = Access.MACHINE_ON
    order: bool = True
    waits: bool = True


# --- orders to the machine -------------------------------------------------------------------------------------------


def _estop(session: Session, arguments: Arguments) -> None:
    on = bool(arguments.switch())
    if not on:
        session.require_no_order("SET ESTOP OFF")
    session.command.state(linuxcnc.STATE_ESTOP if on else linuxcnc.STATE_ESTOP_RESET)
    session.reach(lambda s: (s.task_state == linuxcnc.STATE_ESTOP) == on, f"SET ESTOP {values.on_off(on)}")


def _machine(session: Session, arguments: Arguments) -> None:
    on = bool(arguments.switch())
    if on:
        session.require_no_order("SET MACHINE ON")
    session.command.state(linuxcnc.STATE_ON if on else linuxcnc.STATE_OFF)
    session.reach(lambda s: (s.task_state == linuxcnc.STATE_ON) == on, f"SET MACHINE {values.on_off(on)}")


def _jog_target(session: Session, arguments: Arguments) -> tuple[int, int]:
    """(joint flag, number) of a joint's number or an axis' letter; each is allowed in its mode of motion only."""
    if arguments.is_number(0):
        target = 1, arguments.joint(0, session.status, least=0)
    else:
        target = 0, arguments.axis_letter(0)
        if not session.status.axis_mask >> target[1] & 1:
            raise Refused(f"Invalid axis '{arguments.words[0]}', not configured")
    if (session.status.motion_mode == linuxcnc.TRAJ_MODE_TELEOP) == bool(target[0]):
        raise Refused
    return target


def _jog(session: Session, arguments: Arguments) -> None:
    session.command.jog(linuxcnc.JOG_CONTINUOUS, *_jog_target(session, arguments), arguments.real(1) / 60.0)


def _jog_incr(session: Session, arguments: Arguments) -> None:
    speed, distance = arguments.real(1) / 60.0, arguments.real(2)
    session.command.jog(linuxcnc.JOG_INCREMENT, *_jog_target(session, arguments), speed, distance)


def _home(session: Session, arguments: Arguments) -> None:
    session.command.home(arguments.joint(0, session.status))


def _unhome(session: Session, arguments: Arguments) -> None:
    session.command.unhome(arguments.joint(0, session.status, least=VOLATILE))


def _wait_homed(session: Session, arguments: Arguments) -> None:
    status = session.status
    number, timeout = arguments.joint(0, status), arguments.real(1, HOMING_TIMEOUT)
    if number != ALL and not (status.joint[number]["homing"] or status.joint[number]["homed"]):
        raise Refused(f"Joint '{number}' is not homed and not in the process of homing.")
    if not 0.0 <= timeout <= LONGEST_HOMING_TIMEOUT:
        raise Refused(f"Invalid timeout '{arguments.words[1]}', valid range [0.0,{LONGEST_HOMING_TIMEOUT:.1f}]")

    def over(status: linuxcnc.stat) -> bool:
        joints = status.joint[: status.joints] if number == ALL else [status.joint[number]]
        return not any(joint["homing"] for joint in joints) and (number == ALL or bool(joints[0]["homed"]))

    if not session.wait_until(over, timeout):
        which = "One or more joints are" if number == ALL else f"Joint '{number}'"
        raise Refused(f"{which} still not homed after {timeout:.1f} seconds")
    session.wait_heartbeats(1)


def _override_limits(session: Session, arguments: Arguments) -> None:
    session.command.override_limits(0 if arguments.switch() else LIMITS_IN_FORCE)


def _spindle(session: Session, arguments: Arguments) -> None:
    action, numbers = arguments.choice(0, SPINDLE), arguments.spindles(1, session.status)
    speed = abs(session.status.settings[2]) or 1.0
    for number in numbers:
        if action in TURNS:
            session.command.spindle(action, speed, number)
        else:
            session.command.spindle(action, number)


def _spindle_override(session: Session, arguments: Arguments) -> None:
    percent, numbers = arguments.real(0), arguments.spindles(1, session.status)
    if not 0.0 <= percent <= FULL:
        raise Refused(f"invalid: {percent:g} (valid: 0-100)")
    for number in numbers:
        session.command.spindleoverride(percent / 100.0, number)


def _brake(session: Session, arguments: Arguments) -> None:
    engage, numbers = arguments.switch(), arguments.spindles(1, session.status)
    for number in numbers:
        session.command.brake(engage, number)


def _tool_offset(session: Session, arguments: Arguments) -> None:
    """Tool number, length and diameter."""
    number, length, diameter = arguments.integer(0, 0), arguments.real(1), arguments.real(2)
    session.command.tool_offset(number, length, 0.0, diameter, 0.0, 0.0, 0)


def _load_tool_table(session: Session, arguments: Arguments) -> None:
    session.command.load_tool_table(_file(session, arguments))


def _probe(session: Session, arguments: Arguments) -> None:
    x, y, z = (arguments.real(at) for at in range(3))
    session.command.mdi(f"g38.2 x{x:f} y{y:f} z{z:f}")


def _open(session: Session, arguments: Arguments) -> None:
    session.program = _file(session, arguments)
    session.command.program_open(session.program)


def _file(session: Session, arguments: Arguments) -> str:
    """An absolute path, or a name in one of the folders of ``--path`` or the working folder."""
    for folder in [*session.server.folders, Path()]:
        path = folder / arguments.rest
        if path.exists():
            return str(path.absolute())
    raise Refused(f"File '{arguments.rest}' not found")


def _run(session: Session, arguments: Arguments) -> None:
    session.first_line = arguments.integer(0, 0)
    session.command.auto(linuxcnc.AUTO_RUN, session.first_line)


def _pause(session: Session, arguments: Arguments) -> None:
    if session.wait_mode != "RECEIVED":
        raise Refused("Sending 'SET PAUSE' while not in 'WAIT_MODE RECEIVED' will stall forever")
    session.command.auto(linuxcnc.AUTO_PAUSE)


def _resume(session: Session, arguments: Arguments) -> None:
    if session.wait_mode != "DONE":
        session.warn("Sending 'SET RESUME' while not in 'WAIT_MODE DONE' may return before the system resumes")
        raise Refused
    session.command.auto(linuxcnc.AUTO_RESUME)


# --- the session's own settings --------------------------------------------------------------------------------------


def _enable(session: Session, arguments: Arguments) -> None:
    if arguments.words[0] == session.server.enable_password:
        session.enabled = True
    elif arguments.words[0].upper() != "OFF":
        raise Refused
    elif not session.enabled:
        raise Refused("Trying to set enable to off on a non-enabled link")
    else:
        session.enabled = False


def _disable(session: Session, arguments: Arguments) -> None:
    number = arguments.integer(0, session.number)
    found = [one for one in session.server.sessions if one.number == number]
    if not found:
        raise Refused(f"Client '{number}' not available")
    if not found[0].enabled:
        raise Refused(f"Client '{number}' is not enabled")
    session.say("DISABLE SELF" if found[0] is session else f"DISABLE {number} {found[0].client}")
    found[0].enabled = False


def _comm_mode(session: Session, arguments: Arguments) -> None:
    arguments.choice(0, {"ASCII": 0, "BINARY": 1})
    session.comm_mode = arguments.words[0].upper()


def _comm_prot(session: Session, arguments: Arguments) -> None:
    arguments.real(0)
    session.version = arguments.words[0]


def _wait_mode(session: Session, arguments: Arguments) -> None:
    mode = arguments.words[0].upper()
    if mode == "NONE":
        raise Refused("Setting 'SET WAIT_MODE' to 'NONE' has been removed as it may cause commands to be lost.")
    arguments.choice(0, RECEIVED_DONE)
    session.wait_mode = mode


def _wait(session: Session, arguments: Arguments) -> None:
    if arguments.choice(0, RECEIVED_DONE):
        session.wait_done()


def _wait_heartbeat(session: Session, arguments: Arguments) -> None:
    periods = arguments.integer(0, 1)
    if periods < 1:
        raise Refused(f"Invalid periods '{periods}', valid range [1,...)")
    session.wait_heartbeats(periods)


def _timeout(session: Session, arguments: Arguments) -> None:
    session.timeout = arguments.real(0)


def _timestamp(session: Session, arguments: Arguments) -> None:
    session.timestamp = bool(arguments.switch())
    session.readable_time = len(arguments) > 1 and bool(arguments.switch(1))


def _update(session: Session, arguments: Arguments) -> None:
    session.fresh = bool(arguments.choice(0, NONE_AUTO))


def _linear_conversion(session: Session, arguments: Arguments) -> None:
    arguments.choice(0, dict.fromkeys([*values.LINEAR_UNITS, "AUTO", values.CUSTOM], 0))
    session.linear_conversion = arguments.words[0].upper()


def _angular_conversion(session: Session, arguments: Arguments) -> None:
    arguments.choice(0, dict.fromkeys([*values.ANGULAR_UNITS, "AUTO", values.CUSTOM], 0))
    session.angular_conversion = arguments.words[0].upper()


def _echo(session: Session, arguments: Arguments) -> None:
    session.echo = bool(arguments.switch())


def _verbose(session: Session, arguments: Arguments) -> None:
    session.verbose = bool(arguments.switch())


def _ignored(session: Session, arguments: Arguments) -> None:
    """Known, and without effect, as LinuxCNC's."""


# --- the table -------------------------------------------------------------------------------------------------------


def _own(act: Setter, usage: str = "", least: int = 1, access: Access = Access.ENABLED) -> Setting:
    """A setting of the session itself."""
    return Setting(act, usage, least, access, order=False)


def _order(give: Callable[[linuxcnc.command, Arguments], None], usage: str = "", least: int = 0) -> Setting:
    """An order that is one call of the command channel."""
    return Setting(lambda session, arguments: give(session.command, arguments), usage, least)


_JOINT, _SPINDLE, _SWITCH = "[<joint>|-1]", "[<spindle>|-1]", "{on|off}"

SETTERS: dict[str, Setting] = {
    "ABORT": Setting(lambda session, arguments: session.command.abort(), order=False),
    "ANGULAR_UNIT_CONVERSION": _own(_angular_conversion, "{deg|rad|grad|auto}", access=Access.MACHINE_ON),
    "BRAKE": Setting(_brake, f"{_SWITCH} {_SPINDLE}", 1),
    "COMM_MODE": _own(_comm_mode, "{ascii|binary}", access=Access.HELLO),
    "COMM_PROT": _own(_comm_prot, "<version>", access=Access.HELLO),
    "CONFIG": _own(_ignored, least=0),
    "DEBUG": Setting(lambda session, arguments: session.command.debug(arguments.integer(0, 0)), "<value>", 1,
                     Access.ENABLED),
    "DISABLE": _own(_disable, "[<client>]", 0, Access.HELLO),
    "ECHO": _own(_echo, _SWITCH, access=Access.NOTHING),
    "ENABLE": _own(_enable, "<password>|off", access=Access.HELLO),
    "ESTOP": _own(_estop, _SWITCH),
    "FEED_OVERRIDE": _order(lambda c, a: c.feedrate(max(0.0, a.real(0) / 100.0)), "<percent>", 1),
    "FLOOD": _order(lambda c, a: c.flood(a.switch()), _SWITCH, 1),
    "HOME": Setting(_home, _JOINT),
    "INI": _own(_ignored, least=0, access=Access.HELLO),
    "INIFILE": _own(_ignored, least=0, access=Access.HELLO),
    "JOG": Setting(_jog, "<joint>|<axis> <speed>", 2, waits=False),
    "JOG_INCR": Setting(_jog_incr, "<joint>|<axis> <speed> <distance>", 3, waits=False),
    "JOG_STOP": Setting(lambda session, a: session.command.jog(linuxcnc.JOG_STOP, *_jog_target(session, a)),
                        "<joint>|<axis>", 1),
    "JOINT_HOME": Setting(_home, _JOINT),
    "JOINT_UNHOME": Setting(_unhome, "[<joint>|-1|-2]"),
    "JOINT_WAIT_HOMED": _own(_wait_homed, f"{_JOINT} [<timeout>]", 0, Access.MACHINE_ON),
    "LINEAR_UNIT_CONVERSION": _own(_linear_conversion, "{inch|mm|cm|auto}", access=Access.MACHINE_ON),
    "LOAD_TOOL_TABLE": Setting(_load_tool_table, "<filename>", 1),
    "LUBE": _order(lambda c, a: c.lube(a.switch()), _SWITCH, 1),
    "MACHINE": _own(_machine, _SWITCH),
    "MDI": _order(lambda c, a: c.mdi(a.rest), "<block>", 1),
    "MIST": _order(lambda c, a: c.mist(a.switch()), _SWITCH, 1),
    "MODE": _order(lambda c, a: c.mode(a.choice(0, MODES)), "{manual|auto|mdi}", 1),
    "OPEN": Setting(_open, "<filename>", 1),
    "OPTIONAL_STOP": _order(lambda c, a: c.set_optional_stop(a.switch()), _SWITCH, 1),
    "OVERRIDE_LIMITS": Setting(_override_limits, _SWITCH, 1),
    "PAUSE": Setting(_pause),
    "PROBE": Setting(_probe, "<x> <y> <z>", 3),
    "PROBE_CLEAR": _order(lambda c, a: c.clear_probe_tripped()),
    "RESUME": Setting(_resume),
    "RUN": Setting(_run, "[<startline>]"),
    "SET_TIMEOUT": _own(_timeout, "<seconds>"),
    "SET_WAIT": _own(_wait_mode, "{received|done}"),
    "SPINDLE": Setting(_spindle, f"{{forward|reverse|increase|decrease|constant|off}} {_SPINDLE}", 1),
    "SPINDLE_OVERRIDE": Setting(_spindle_override, f"<percent> {_SPINDLE}", 1),
    "STEP": _order(lambda c, a: c.auto(linuxcnc.AUTO_STEP)),
    "TASK_PLAN_INIT": _order(lambda c, a: c.reset_interpreter()),
    "TELEOP_ENABLE": _order(lambda c, a: c.teleop_enable(a.switch()), _SWITCH, 1),
    "TIMEOUT": _own(_timeout, "<seconds>"),
    "TIMESTAMP": _own(_timestamp, f"{_SWITCH} [{_SWITCH}]", access=Access.NOTHING),
    "TOOL_OFFSET": Setting(_tool_offset, "<tool> <length> <diameter>", 3),
    "UPDATE": _own(_update, "{none|auto}"),
    "UPDATE_STATUS": _own(lambda session, arguments: session.renew(), least=0),
    "VERBOSE": _own(_verbose, _SWITCH, access=Access.HELLO),
    "WAIT": _own(_wait, "{received|done}"),
    "WAIT_HEARTBEAT": _own(_wait_heartbeat, "[<periods>]", 0, Access.MACHINE_ON),
    "WAIT_MODE": _own(_wait_mode, "{received|done}"),
}
