"""Tells the subroutine calls behind the executing move, on callStacks, before the first status that they belong to."""

from __future__ import annotations

from emctask.places import Calls
from nml.channel import Channel
from nml.emc import EMC_CALL_STACKS
from nml.emc.calls import MOST_CALLS, STACKS


class CallStacks:
    """The only writer of callStacks."""

    def __init__(self, channel: Channel) -> None:
        self._channel = channel
        self._message = EMC_CALL_STACKS()
        self._written: Calls = ()
        self._next = 0
        channel.write(self._message)

    def changed(self, calls: Calls) -> bool:
        """Are these other calls than those written last?"""
        return calls is not self._written and calls != self._written

    def write(self, calls: Calls, heartbeat: int) -> None:
        """The status with this heartbeat stands in these calls."""
        if not self.changed(calls):
            return
        stack = self._message.stacks[self._next]
        stack.heartbeat, stack.depth = heartbeat, min(len(calls), MOST_CALLS)
        for frame, (subname, filename, line) in zip(stack.frames, calls, strict=False):
            frame.subname, frame.filename, frame.line = subname, filename, line
        self._next = (self._next + 1) % STACKS
        self._channel.write(self._message)
        self._written = calls

    def close(self) -> None:
        """Close the channel."""
        self._channel.close()
