"""The subroutine calls that the executing move stands in: the slot buffer ``callStacks``, written by task on changes.

EMC_STAT has their number only. A reader has taken some status, which need not be the newest; so the message holds the
last few stacks, each with the heartbeat of the first status that it belongs to.
"""

from __future__ import annotations

from nml.emc.constants import LINELEN
from nml.message import Status, Struct, char, integer, struct, uint

__all__ = ["EMC_CALL_STACKS", "CallFrame", "CallStack"]

CALLS_BUFFER = "callStacks"
MOST_CALLS = 10
STACKS = 8
NAME_LENGTH = 80


class CallFrame(Struct):
    """One call."""

    subname = char(NAME_LENGTH, cut=True, doc="what is called")
    filename = char(LINELEN, cut=True, doc="file of the call; empty for a typed line")
    line = integer(doc="line of the call")


class CallStack(Struct):
    """The calls from the outermost to the innermost."""

    heartbeat = uint(doc="EMC_TASK_STAT.heartbeat of the first status that it belongs to")
    depth = integer()
    frames = struct(CallFrame, MOST_CALLS)


class EMC_CALL_STACKS(Status, type_id=3013):
    """The last stacks, in a ring; at first all of them are empty ones of heartbeat 0."""

    stacks = struct(CallStack, STACKS)


def stack_at(message: EMC_CALL_STACKS, heartbeat: int) -> CallStack:
    """The stack that belongs to a status: the newest one that is not newer than it."""
    return min(message.stacks, key=lambda stack: (heartbeat - stack.heartbeat) & 0xFFFFFFFF)
