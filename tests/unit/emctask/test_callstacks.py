"""The calls behind the executing move: which of the last stacks belongs to a status that a client has."""

from __future__ import annotations

from itertools import islice
from typing import Any, cast

from emctask.callstacks import CallStacks
from emctask.places import Calls
from nml.channel import Channel
from nml.emc import EMC_CALL_STACKS
from nml.emc.calls import STACKS, stack_at

OUTER: Calls = (("outer", "part.ngc", 3),)
INNER: Calls = (*OUTER, ("inner", "outer.ngc", 7))


class Buffer:
    """In place of the channel: counts the messages and keeps the last."""

    def __init__(self) -> None:
        self.count = 0
        self.last = EMC_CALL_STACKS()

    def write(self, message: EMC_CALL_STACKS) -> None:
        self.count += 1
        self.last = cast(EMC_CALL_STACKS, EMC_CALL_STACKS.from_bytes(bytes(message.data)))

    def calls_at(self, heartbeat: int) -> Calls:
        stack = stack_at(self.last, heartbeat)
        return tuple((each.subname, each.filename, each.line) for each in islice(stack.frames, stack.depth))


def written(*stacks: tuple[Calls, int]) -> Buffer:
    buffer: Any = Buffer()
    writer = CallStacks(cast(Channel, buffer))
    for calls, heartbeat in stacks:
        writer.write(calls, heartbeat)
    return buffer


def test_before_the_first_call_there_is_an_empty_stack() -> None:
    assert written().calls_at(17) == ()


def test_a_status_has_the_stack_that_was_in_force_when_it_was_written() -> None:
    buffer = written((OUTER, 5), (INNER, 8), (OUTER, 9), ((), 20))
    assert [buffer.calls_at(heartbeat) for heartbeat in (4, 5, 7, 8, 9, 19, 20, 99)] == [
        (), OUTER, OUTER, INNER, OUTER, OUTER, (), (),
    ]  # fmt: skip


def test_the_oldest_stacks_are_forgotten_and_the_heartbeat_may_begin_again() -> None:
    first = 2**32 - 3
    buffer = written(*(((("sub", "part.ngc", n),), (first + n) % 2**32) for n in range(STACKS + 2)))
    assert [buffer.calls_at((first + n) % 2**32)[0][2] for n in range(2, STACKS + 2)] == list(range(2, STACKS + 2))


def test_the_same_calls_are_written_once() -> None:
    assert written((INNER, 5), (INNER, 6)).count == 2
