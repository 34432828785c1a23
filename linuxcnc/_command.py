"""``linuxcnc.command``: every command that a user interface can give, one method for each.

A method writes one message to emcCommand and returns when task has taken it, as LinuxCNC's does; ``wait_complete``
waits until it is done. Both sleep on the status buffer itself and wake with its next write: no polling, no delay.
"""

from __future__ import annotations

from typing import Any

import nml.emc as emc
from linuxcnc import _constants as const
from linuxcnc._connection import error, open_channel
from linuxcnc._results import Outcome, Result, Results
from nml import clock
from nml.emc import orders
from nml.errors import NmlError
from nml.message import Command

FOREVER = 1e9  # s
RECEIVE_TIMEOUT = 5.0  # host seconds until task must have taken a command
TEXT_LENGTH = 254  # characters of an MDI line, a file name or an operator message

AUTO_COMMANDS: dict[int, type[Command]] = {
    const.AUTO_PAUSE: emc.EMC_TASK_PLAN_PAUSE,
    const.AUTO_RESUME: emc.EMC_TASK_PLAN_RESUME,
    const.AUTO_STEP: emc.EMC_TASK_PLAN_STEP,
    const.AUTO_REVERSE: emc.EMC_TASK_PLAN_REVERSE,
    const.AUTO_FORWARD: emc.EMC_TASK_PLAN_FORWARD,
}
FLOOD_COMMANDS: dict[int, type[Command]] = {
    const.FLOOD_ON: emc.EMC_COOLANT_FLOOD_ON,
    const.FLOOD_OFF: emc.EMC_COOLANT_FLOOD_OFF,
}
MIST_COMMANDS: dict[int, type[Command]] = {
    const.MIST_ON: emc.EMC_COOLANT_MIST_ON,
    const.MIST_OFF: emc.EMC_COOLANT_MIST_OFF,
}
BRAKE_COMMANDS: dict[int, type[Command]] = {
    const.BRAKE_ENGAGE: emc.EMC_SPINDLE_BRAKE_ENGAGE,
    const.BRAKE_RELEASE: emc.EMC_SPINDLE_BRAKE_RELEASE,
}
SPINDLE_STEPS: dict[int, type[Command]] = {
    const.SPINDLE_INCREASE: emc.EMC_SPINDLE_INCREASE,
    const.SPINDLE_DECREASE: emc.EMC_SPINDLE_DECREASE,
    const.SPINDLE_CONSTANT: emc.EMC_SPINDLE_CONSTANT,
}


def _choose(table: dict[int, type[Command]], choice: int, what: str) -> type[Command]:
    try:
        return table[choice]
    except KeyError:
        raise error(f"{what}({choice}): {', '.join(map(str, table))} are allowed") from None


def _text(text: str, what: str) -> str:
    if len(text.encode()) > TEXT_LENGTH:
        raise error(f"{what}: {len(text.encode())} characters, {TEXT_LENGTH} are allowed")
    return text


class command:
    """Connection to the command channel."""

    serial = 0
    """Serial number of the command given last."""
    origin: str
    """Who gives the commands, as other clients see it; this program and its process number unless set otherwise."""

    def __init__(self) -> None:
        self.origin = orders.program_name()
        self._commands = open_channel("emcCommand")
        self._notes = None if self._commands.remote else open_channel(orders.NOTE_BUFFER)
        self._status = open_channel("emcStatus")
        self._results = Results(self._status)
        self._echo = 0
        self._result = const.RCS_DONE

    # --- sending and waiting ---------------------------------------------------------------------------------------

    def _send(self, message: type[Command], **fields: Any) -> None:
        """Write a message and wait until task has taken it."""
        try:
            order = message(**fields)
            self._results.mark()
            self.serial = self._commands.write(order)
            if self._notes is not None:
                self._notes.write(orders.note(order, self.serial, self.origin))
            received = self._wait_for(received=True, timeout=RECEIVE_TIMEOUT)
        except NmlError as reason:
            raise error(f"{message.__name__}: {reason}") from reason
        if not received:
            raise error(f"{message.__name__}: task did not take it within {RECEIVE_TIMEOUT:g} s")

    def _wait_for(self, *, received: bool, timeout: float) -> bool:
        """Follow the status until the last command is received or, else, done; false after ``timeout`` host seconds."""
        deadline = clock.host_now() + timeout
        while True:
            status = self._status.peek()
            if isinstance(status, emc.EMC_STAT):
                self._echo, self._result = status.echo_serial_number, status.status
            ahead = self._echo - self.serial
            if ahead > 0 or (ahead == 0 and (received or self._result != const.RCS_EXEC)):
                return True
            left = deadline - clock.host_now()
            if left <= 0.0 or not self._status.wait(left):
                return False

    def wait_complete(self, timeout: float = 5.0) -> int:
        """Wait for the end of the last command: RCS_DONE, RCS_ERROR, or -1 after ``timeout`` s."""
        try:
            over = self._wait_for(received=False, timeout=timeout)
        except NmlError as reason:
            raise error(f"wait_complete: {reason}") from reason
        if not over:
            return -1
        return self._result if self._echo == self.serial else const.RCS_DONE

    def result(self, timeout: float = FOREVER) -> Result | None:
        """What became of the last command, whatever other clients did meanwhile; None if it is not over in time.

        A LinuxCNC that is reached over a network tells no results: there it is done or failed, as ``wait_complete``.
        """
        if (result := self._results.wait(self.serial, timeout)) is not None or self._results.told:
            return result
        code = self.wait_complete(timeout)
        if code == -1:
            return None
        return Result(Outcome.DONE if code == const.RCS_DONE else Outcome.FAILED, self.serial, ())

    # --- machine ---------------------------------------------------------------------------------------------------

    def state(self, state: int) -> None:
        """Set the machine's state: STATE_ESTOP, STATE_ESTOP_RESET, STATE_ON or STATE_OFF."""
        self._send(emc.EMC_TASK_SET_STATE, state=state)

    def mode(self, mode: int) -> None:
        """Set the mode: MODE_MANUAL, MODE_MDI or MODE_AUTO."""
        self._send(emc.EMC_TASK_SET_MODE, mode=mode)

    def abort(self) -> None:
        """Stop motion and program."""
        self._send(emc.EMC_TASK_ABORT)

    def debug(self, flags: int) -> None:
        """Set the debug flags, DEBUG_*."""
        self._send(emc.EMC_SET_DEBUG, debug=flags)

    # --- programs --------------------------------------------------------------------------------------------------

    def program_open(self, filename: str) -> None:
        """Load a program."""
        self._send(emc.EMC_TASK_PLAN_OPEN, file=_text(filename, "program_open"))

    def auto(self, action: int, line: int = 0) -> None:
        """Run from ``line`` (AUTO_RUN), or AUTO_PAUSE, AUTO_RESUME, AUTO_STEP, AUTO_REVERSE, AUTO_FORWARD."""
        if action == const.AUTO_RUN:
            self._send(emc.EMC_TASK_PLAN_RUN, line=line)
        else:
            self._send(_choose(AUTO_COMMANDS, action, "auto"))

    def mdi(self, block: str) -> None:
        """Execute one line of G-code."""
        self._send(emc.EMC_TASK_PLAN_EXECUTE, command=_text(block, "mdi"))

    def reset_interpreter(self) -> None:
        """Bring the interpreter back to its initial state."""
        self._send(emc.EMC_TASK_PLAN_INIT)

    def task_plan_synch(self) -> None:
        """Synchronise the interpreter with the machine and write the parameter file."""
        self._send(emc.EMC_TASK_PLAN_SYNCH)

    def set_optional_stop(self, on: int) -> None:
        """M1 stops, or does not."""
        self._send(emc.EMC_TASK_PLAN_SET_OPTIONAL_STOP, state=bool(on))

    def set_block_delete(self, on: int) -> None:
        """Lines that begin with '/' are skipped, or are not."""
        self._send(emc.EMC_TASK_PLAN_SET_BLOCK_DELETE, state=bool(on))

    # --- joints and axes -------------------------------------------------------------------------------------------

    def home(self, joint: int) -> None:
        """Home a joint; -1: all of them in their sequence."""
        self._send(emc.EMC_JOINT_HOME, joint=joint)

    def unhome(self, joint: int) -> None:
        """Forget the home of a joint; -1: of all, -2: of the volatile ones."""
        self._send(emc.EMC_JOINT_UNHOME, joint=joint)

    def jog(self, action: int, joint_flag: int, index: int, velocity: float = 0.0, distance: float = 0.0) -> None:
        """Jog joint or axis ``index`` (``joint_flag`` true: joint).

        JOG_STOP; JOG_CONTINUOUS with a velocity in machine units per s, whose sign is the direction; JOG_INCREMENT with
        a velocity and a distance in machine units.
        """
        which = {"joint_or_axis": index, "jjogmode": int(bool(joint_flag))}
        if action == const.JOG_STOP:
            self._send(emc.EMC_JOG_STOP, **which)
        elif action == const.JOG_CONTINUOUS:
            self._send(emc.EMC_JOG_CONT, vel=velocity, **which)
        elif action == const.JOG_INCREMENT:
            self._send(emc.EMC_JOG_INCR, vel=velocity, incr=distance, **which)
        else:
            raise error(f"jog({action}): JOG_STOP, JOG_CONTINUOUS or JOG_INCREMENT are allowed")

    def override_limits(self, joint: int = 0) -> None:
        """Allow jogging off a hard limit until the next jog ends; -1 (LinuxCNC's has no argument): not any more."""
        self._send(emc.EMC_JOINT_OVERRIDE_LIMITS, joint=joint)

    def set_min_limit(self, joint: int, limit: float) -> None:
        """Set the lower soft limit of a joint."""
        self._send(emc.EMC_JOINT_SET_MIN_POSITION_LIMIT, joint=joint, limit=limit)

    def set_max_limit(self, joint: int, limit: float) -> None:
        """Set the upper soft limit of a joint."""
        self._send(emc.EMC_JOINT_SET_MAX_POSITION_LIMIT, joint=joint, limit=limit)

    def teleop_enable(self, on: int) -> None:
        """Jog axes (on) or joints (off)."""
        self._send(emc.EMC_TRAJ_SET_TELEOP_ENABLE, enable=int(bool(on)))

    def traj_mode(self, mode: int) -> None:
        """Set the mode of motion: TRAJ_MODE_FREE, TRAJ_MODE_COORD or TRAJ_MODE_TELEOP."""
        self._send(emc.EMC_TRAJ_SET_MODE, mode=mode)

    def clear_probe_tripped(self) -> None:
        """Forget that the probe has tripped; LinuxCNC's module has no method for it, linuxcncrsh needs one."""
        self._send(emc.EMC_TRAJ_CLEAR_PROBE_TRIPPED_FLAG)

    # --- overrides -------------------------------------------------------------------------------------------------

    def feedrate(self, scale: float) -> None:
        """Feed override, 1.0 = 100 %."""
        self._send(emc.EMC_TRAJ_SET_SCALE, scale=scale)

    def rapidrate(self, scale: float) -> None:
        """Rapid override, 1.0 = 100 %."""
        self._send(emc.EMC_TRAJ_SET_RAPID_SCALE, scale=scale)

    def spindleoverride(self, scale: float, spindle: int = 0) -> None:
        """Spindle override, 1.0 = 100 %."""
        self._send(emc.EMC_TRAJ_SET_SPINDLE_SCALE, scale=scale, spindle=spindle)

    def maxvel(self, velocity: float) -> None:
        """Largest path velocity in machine units per s."""
        self._send(emc.EMC_TRAJ_SET_MAX_VELOCITY, velocity=velocity)

    def set_feed_override(self, on: int) -> None:
        """The feed override acts, or does not (M50)."""
        self._send(emc.EMC_TRAJ_SET_FO_ENABLE, mode=int(bool(on)))

    def set_spindle_override(self, on: int, spindle: int = 0) -> None:
        """The spindle override acts, or does not (M51)."""
        self._send(emc.EMC_TRAJ_SET_SO_ENABLE, mode=int(bool(on)), spindle=spindle)

    def set_feed_hold(self, on: int) -> None:
        """Feed hold acts, or does not (M53)."""
        self._send(emc.EMC_TRAJ_SET_FH_ENABLE, mode=int(bool(on)))

    def set_adaptive_feed(self, on: int) -> None:
        """Adaptive feed acts, or does not (M52)."""
        self._send(emc.EMC_MOTION_ADAPTIVE, status=int(bool(on)))

    # --- spindle, coolant, tools, outputs --------------------------------------------------------------------------

    def spindle(self, direction: int, *args: float) -> None:
        """Turn a spindle.

        ``spindle(SPINDLE_FORWARD | SPINDLE_REVERSE, speed_rpm=0, spindle=0, wait_for_speed=0)``;
        ``spindle(SPINDLE_OFF | SPINDLE_INCREASE | SPINDLE_DECREASE | SPINDLE_CONSTANT, spindle=0)``.
        """
        if direction in (const.SPINDLE_FORWARD, const.SPINDLE_REVERSE):
            speed, number, wait = (*args, *(0.0, 0, 0)[len(args) :])[:3]
            self._send(
                emc.EMC_SPINDLE_ON, spindle=int(number), speed=direction * speed, wait_for_spindle_at_speed=int(wait)
            )
        elif direction == const.SPINDLE_OFF:
            self._send(emc.EMC_SPINDLE_OFF, spindle=int(args[0]) if args else 0)
        else:
            step = _choose(SPINDLE_STEPS, direction, "spindle")
            self._send(step, spindle=int(args[0]) if args else 0)

    def brake(self, action: int, spindle: int = 0) -> None:
        """BRAKE_ENGAGE or BRAKE_RELEASE the brake of a spindle."""
        self._send(_choose(BRAKE_COMMANDS, action, "brake"), spindle=spindle)

    def flood(self, on: int) -> None:
        """FLOOD_ON or FLOOD_OFF."""
        self._send(_choose(FLOOD_COMMANDS, on, "flood"))

    def mist(self, on: int) -> None:
        """MIST_ON or MIST_OFF."""
        self._send(_choose(MIST_COMMANDS, on, "mist"))

    def lube(self, on: int) -> None:
        """Lubrication on or off; LinuxCNC's module has no method for it, halui needs one."""
        self._send(emc.EMC_LUBE_ON if on else emc.EMC_LUBE_OFF)

    def load_tool_table(self, filename: str = "") -> None:
        """Read the tool table again; empty: the file of the INI."""
        self._send(emc.EMC_TOOL_LOAD_TOOL_TABLE, file=_text(filename, "load_tool_table"))

    def tool_offset(
        self, toolno: int, z_offset: float, x_offset: float, diameter: float, frontangle: float, backangle: float,
        orientation: int,
    ) -> None:
        """Write one entry of the tool table."""
        offset = (x_offset, 0.0, z_offset, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        self._send(
            emc.EMC_TOOL_SET_OFFSET,
            toolno=toolno,
            offset=offset,
            diameter=diameter,
            frontangle=frontangle,
            backangle=backangle,
            orientation=orientation,
        )

    def set_digital_output(self, index: int, value: int) -> None:
        """Set motion.digital-out-NN at once."""
        level = int(bool(value))
        self._send(emc.EMC_MOTION_SET_DOUT, index=index, start=level, end=level, now=1)

    def set_analog_output(self, index: int, value: float) -> None:
        """Set motion.analog-out-NN at once."""
        self._send(emc.EMC_MOTION_SET_AOUT, index=index, start=value, end=value, now=1)

    # --- messages --------------------------------------------------------------------------------------------------

    def error_msg(self, text: str) -> None:
        """Send an error message to all operators."""
        self._send(emc.EMC_OPERATOR_ERROR, error=_text(text, "error_msg"))

    def text_msg(self, text: str) -> None:
        """Send a text message to all operators."""
        self._send(emc.EMC_OPERATOR_TEXT, text=_text(text, "text_msg"))

    def display_msg(self, text: str) -> None:
        """Send a display message to all operators."""
        self._send(emc.EMC_OPERATOR_DISPLAY, display=_text(text, "display_msg"))
