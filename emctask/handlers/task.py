"""TASK and the controller as a whole: state, mode, abort, debug. Manual, chapters 4.7 and 4.14."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask import transitions
from emctask.commandtable import always, command, refuse
from nml.emc import (
    EMC_ABORT,
    EMC_EXEC_PLUGIN_CALL,
    EMC_HALT,
    EMC_INIT,
    EMC_IO_PLUGIN_CALL,
    EMC_NULL,
    EMC_SET_DEBUG,
    EMC_SYSTEM_CMD,
    EMC_TASK_ABORT,
    EMC_TASK_HALT,
    EMC_TASK_INIT,
    EMC_TASK_SET_MODE,
    EMC_TASK_SET_STATE,
)
from nml.emc.constants import EMC_IO_ABORT_REASON_ENUM as Reason
from nml.emc.constants import EMC_TASK_STATE_ENUM as State
from nml.message import Message

if TYPE_CHECKING:
    from emctask.task import Task


@command(EMC_NULL, EMC_INIT, EMC_TASK_INIT)
def nothing(task: Task, message: Message) -> None:
    """Task is initialised before it takes its first command."""


@command(EMC_HALT, EMC_TASK_HALT, urgent=always)
def halt(task: Task, message: Message) -> None:
    """Stop the machine and end task."""
    task.runner.abort(Reason.TASK_ABORT)
    task.running = False


@command(EMC_TASK_ABORT, EMC_ABORT, urgent=always)
def abort(task: Task, message: Message) -> None:
    """Stop motion, program, MDI, spindle and coolant."""
    task.runner.abort(Reason.TASK_ABORT)


def stops_the_machine(message: EMC_TASK_SET_STATE) -> bool:
    """An order to stop the machine does not wait for anything."""
    return message.state in (State.ESTOP, State.OFF)


@command(EMC_TASK_SET_STATE, urgent=stops_the_machine)
def set_state(task: Task, message: EMC_TASK_SET_STATE) -> None:
    """E-stop, E-stop reset, off, on."""
    transitions.set_state(task, message.state)


@command(EMC_TASK_SET_MODE)
def set_mode(task: Task, message: EMC_TASK_SET_MODE) -> None:
    """Manual, auto, MDI."""
    transitions.set_mode(task, message.mode)


@command(EMC_SET_DEBUG)
def set_debug(task: Task, message: EMC_SET_DEBUG) -> None:
    """Choose what is logged, here and in io."""
    task.debug = message.debug
    task.io.send(EMC_SET_DEBUG(debug=message.debug))


refuse([EMC_SYSTEM_CMD], "programs run other programs by user M-codes, M100 to M199")
refuse([EMC_EXEC_PLUGIN_CALL, EMC_IO_PLUGIN_CALL], "this controller has no plug-ins in task or io")
