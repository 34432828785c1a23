"""OPERATOR: texts that a client sends to all displays. Manual, chapter 4.1."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask.commandtable import command
from nml.emc import EMC_OPERATOR_DISPLAY, EMC_OPERATOR_ERROR, EMC_OPERATOR_TEXT

if TYPE_CHECKING:
    from emctask.task import Task


@command(EMC_OPERATOR_ERROR)
def error(task: Task, message: EMC_OPERATOR_ERROR) -> None:
    """Shown as an error."""
    task.operator.error(message.error)


@command(EMC_OPERATOR_TEXT)
def text(task: Task, message: EMC_OPERATOR_TEXT) -> None:
    """Shown as a text."""
    task.operator.text(message.text)


@command(EMC_OPERATOR_DISPLAY)
def display(task: Task, message: EMC_OPERATOR_DISPLAY) -> None:
    """Shown as a display message."""
    task.operator.display(message.display)
