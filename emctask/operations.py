"""What a program can queue: each operation with what it waits for and what it does, for ``emctask.sequencer``.

Who waits for what follows LinuxCNC: spindle, coolant and outputs that are 'at once' act when the moves before them are
done; tools and dwells wait for motion and io; moves, synchronised outputs and modal settings of motion flow through.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from emctask.interplist import Exec, Operation
from nml.emc.emcmot import MotCommand

if TYPE_CHECKING:
    from emctask.sequencer import Sequencer

Run = Callable[["Sequencer", Any], None]

DONE = Exec.DONE
MOTION = Exec.WAITING_FOR_MOTION
IO = Exec.WAITING_FOR_IO
MOTION_AND_IO = Exec.WAITING_FOR_MOTION_AND_IO


def operation(before: Exec = DONE, after: Exec = DONE, moves: bool = False) -> Callable[[Run], Operation]:
    """Make an Operation of a function."""

    def make(run: Run) -> Operation:
        return Operation(run.__name__, run, before, after, moves)

    return make


# --- Motion


@operation(moves=True)
def move(machine: Sequencer, packed: bytes) -> None:
    """A straight move or an arc, packed with ``emctask.motion.MOVE``."""
    machine.motion.send_move(packed, line=machine.current_line, wait_for_spindle_at_speed=machine.take_spindle_wait())


@operation(before=MOTION_AND_IO, after=MOTION, moves=True)
def probe(machine: Sequencer, payload: tuple[bytes, int]) -> None:
    """(packed move, probe type)."""
    machine.motion.send(MotCommand.CLEAR_PROBE_FLAGS)
    machine.motion.send_move(payload[0], line=machine.current_line, probe_type=payload[1])


@operation(before=MOTION_AND_IO, after=MOTION, moves=True)
def home(machine: Sequencer, joint: int) -> None:
    """G28.2: a joint, or all of them (-1)."""
    machine.home(joint)


@operation(before=MOTION, after=MOTION, moves=True)
def rigid_tap(machine: Sequencer, payload: tuple[bytes, float]) -> None:
    """(packed move, scale of the way back)."""
    machine.motion.send_move(payload[0], line=machine.current_line, scale=payload[1])


@operation()
def motion_command(machine: Sequencer, payload: tuple[MotCommand, dict[str, Any]]) -> None:
    """A modal setting of motion that acts in the order of the moves."""
    machine.motion.send(payload[0], **payload[1])


@operation(before=MOTION)
def motion_command_at_rest(machine: Sequencer, payload: tuple[MotCommand, dict[str, Any]]) -> None:
    """A command to motion that acts when the moves before it are done."""
    machine.motion.send(payload[0], **payload[1])


@operation(before=MOTION)
def spindle_on(machine: Sequencer, payload: tuple[int, dict[str, Any]]) -> None:
    """(spindle, fields of SPINDLE_ON): the next feed waits until it is at speed."""
    spindle, fields = payload
    machine.motion.send(MotCommand.SPINDLE_ON, spindle=spindle, **fields)
    if fields["wait_for_spindle_at_speed"]:
        machine.spindle_wait = True


@operation(before=MOTION)
def orient(machine: Sequencer, payload: tuple[int, float, int]) -> None:
    """(spindle, degrees, direction)."""
    spindle, orientation, mode = payload
    machine.motion.send(MotCommand.SPINDLE_ORIENT, spindle=spindle, orientation=orientation, mode=mode)


@operation(before=MOTION, after=Exec.WAITING_FOR_SPINDLE_ORIENTED)
def wait_oriented(machine: Sequencer, payload: tuple[int, float]) -> None:
    """(spindle, s)."""
    machine.wait_oriented(*payload)


# --- Task


@operation(before=MOTION_AND_IO, after=Exec.WAITING_FOR_DELAY)
def dwell(machine: Sequencer, seconds: float) -> None:
    """Stand still for a time."""
    machine.wait_time(seconds)


@operation(before=MOTION_AND_IO, after=Exec.WAITING_FOR_DELAY)
def wait_input(machine: Sequencer, payload: tuple[int, int, int, float]) -> None:
    """(index, type, wait type, s): M66."""
    machine.wait_input(*payload)


@operation(before=MOTION_AND_IO, after=Exec.WAITING_FOR_SYSTEM_CMD)
def user_command(machine: Sequencer, payload: tuple[int, float, float]) -> None:
    """(number, P, Q): run M100 to M199."""
    machine.run_user_command(*payload)


@operation(before=MOTION_AND_IO)
def program_stop(machine: Sequencer, payload: None) -> None:
    """M0, M60: pause until the operator resumes."""
    machine.hooks.pause_here()


@operation(before=MOTION_AND_IO)
def optional_stop(machine: Sequencer, payload: None) -> None:
    """M1: pause if the optional stop is on now."""
    if machine.hooks.optional_stop:
        machine.hooks.pause_here()


@operation(before=MOTION_AND_IO)
def program_end(machine: Sequencer, payload: None) -> None:
    """M2, M30: nothing more to do than to have finished everything before."""


@operation()
def operator_text(machine: Sequencer, text: str) -> None:
    """(MSG, ...): shown when the program comes to it."""
    machine.hooks.show_text(text)


@operation()
def set_status(machine: Sequencer, payload: tuple[str, Any]) -> None:
    """Fields of EMC_TASK_STAT that become true here: offsets, rotation."""
    machine.hooks.offsets[payload[0]] = payload[1]


@operation()
def tool_offset(machine: Sequencer, offset: tuple[float, ...]) -> None:
    """G43, G49: task shows it, motion exports it."""
    machine.hooks.offsets["toolOffset"] = offset
    machine.motion.send(MotCommand.SET_OFFSET, tool_offset=offset)


# --- Io


@operation(before=IO)
def io_command(machine: Sequencer, command: Any) -> None:
    """Sent without waiting for motion: tool preparation, tool data."""
    machine.io.send(command)


@operation(before=MOTION_AND_IO)
def io_command_at_rest(machine: Sequencer, command: Any) -> None:
    """Sent when the moves before it are done: coolant."""
    machine.io.send(command)


@operation(before=MOTION_AND_IO, after=MOTION_AND_IO)
def io_command_complete(machine: Sequencer, command: Any) -> None:
    """Sent at rest, and nothing goes on before io has finished: tool change."""
    machine.io.send(command)
