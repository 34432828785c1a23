"""TOOL, AUX, COOLANT, LUBE and IO: passed on to io. Manual, chapters 4.8, 4.9 and 4.11 to 4.13."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask import transitions
from emctask.commandtable import MANUAL, always, command, refuse
from nml.emc import (
    EMC_AUX_ESTOP_OFF,
    EMC_AUX_ESTOP_ON,
    EMC_AUX_ESTOP_RESET,
    EMC_AUX_INPUT_WAIT,
    EMC_COOLANT_FLOOD_OFF,
    EMC_COOLANT_FLOOD_ON,
    EMC_COOLANT_MIST_OFF,
    EMC_COOLANT_MIST_ON,
    EMC_IO_ABORT,
    EMC_IO_HALT,
    EMC_IO_INIT,
    EMC_IO_SET_CYCLE_TIME,
    EMC_LUBE_OFF,
    EMC_LUBE_ON,
    EMC_TOOL_ABORT,
    EMC_TOOL_HALT,
    EMC_TOOL_INIT,
    EMC_TOOL_LOAD,
    EMC_TOOL_LOAD_TOOL_TABLE,
    EMC_TOOL_PREPARE,
    EMC_TOOL_SET_NUMBER,
    EMC_TOOL_SET_OFFSET,
    EMC_TOOL_START_CHANGE,
    EMC_TOOL_UNLOAD,
)
from nml.message import Command, Message

if TYPE_CHECKING:
    from emctask.task import Task


@command(EMC_COOLANT_FLOOD_ON, EMC_COOLANT_MIST_ON, EMC_LUBE_ON, on=True)
@command(EMC_COOLANT_FLOOD_OFF, EMC_COOLANT_MIST_OFF, EMC_LUBE_OFF, EMC_TOOL_ABORT, EMC_IO_ABORT)
def forward(task: Task, message: Command) -> None:
    """Io carries it out."""
    task.io.send(message.copy())


@command(
    EMC_TOOL_PREPARE,
    EMC_TOOL_LOAD,
    EMC_TOOL_UNLOAD,
    EMC_TOOL_START_CHANGE,
    EMC_TOOL_SET_NUMBER,
    on=True,
    modes=MANUAL,
)
def tool(task: Task, message: Command) -> None:
    """A tool change by hand; the interpreter takes over the tool afterwards."""
    task.io.send(message.copy())
    task.plan.must_synch = True


@command(EMC_TOOL_LOAD_TOOL_TABLE, EMC_TOOL_SET_OFFSET, idle=True)
def tool_data(task: Task, message: Command) -> None:
    """Read the table anew, or change an entry; the interpreter takes over the new values."""
    task.io.send(message.copy())
    task.plan.must_synch = True
    task.expect(lambda: task.io.done, "io does not finish the change of the tool table", 5.0)


@command(EMC_AUX_ESTOP_ON, urgent=always)
def estop_on(task: Task, message: Message) -> None:
    """E-stop."""
    transitions.to_estop(task)


@command(EMC_AUX_ESTOP_OFF, EMC_AUX_ESTOP_RESET)
def estop_off(task: Task, message: Message) -> None:
    """E-stop reset."""
    transitions.to_estop_reset(task)


@command(EMC_TOOL_INIT, EMC_TOOL_HALT, EMC_IO_INIT, EMC_IO_HALT)
def nothing(task: Task, message: Message) -> None:
    """Io begins and ends with the machine."""


refuse([EMC_IO_SET_CYCLE_TIME], "io's cycle time comes from the INI file")
refuse([EMC_AUX_INPUT_WAIT], "a program waits for an input with M66")
