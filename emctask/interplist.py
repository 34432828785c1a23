"""The list between interpreter and execution: what canon queues, in program order, and what each entry waits for.

An entry is ``(operation, payload, line, block)``; each block that is read has a Block of its own, so that the passes of
a loop over one line are told apart. An Operation says what must be finished before it may begin (``before``) and
what must be finished before the next entry may begin (``after``): this table, not the code around it, makes
a probe or a tool change wait. Moves pass without waiting for anything but room in the planner.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from emctask.places import Block

if TYPE_CHECKING:
    from emctask.sequencer import Sequencer


class Exec(IntEnum):
    """What execution waits for: EMC_TASK_EXEC_ENUM."""

    ERROR = 1
    DONE = 2
    WAITING_FOR_MOTION = 3
    WAITING_FOR_MOTION_QUEUE = 4
    WAITING_FOR_IO = 5
    WAITING_FOR_MOTION_AND_IO = 7
    WAITING_FOR_DELAY = 8
    WAITING_FOR_SYSTEM_CMD = 9
    WAITING_FOR_SPINDLE_ORIENTED = 10


class ExecutionError(Exception):
    """An entry failed; the text is for the operator, and the program is aborted."""


@dataclass(frozen=True, slots=True, eq=False)
class Operation:
    """A kind of entry."""

    name: str
    run: Callable[[Sequencer, Any], None]
    before: Exec = Exec.DONE
    after: Exec = Exec.DONE
    moves: bool = False
    """Does it move the machine? The line of the last one that does is the current line."""


Entry = tuple[Operation, Any, int, Block]

MAX_LENGTH = 1000
"""Entries that reading ahead may collect before it waits for execution."""


class InterpList(deque[Entry]):
    """A plain deque with the names of its uses."""

    @property
    def full(self) -> bool:
        """Should reading ahead pause?"""
        return len(self) >= MAX_LENGTH
