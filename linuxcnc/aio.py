"""asyncio beside ``import linuxcnc``: await orders, iterate over the status, and know what became of each order.

    async with Machine() as machine:
        result = await machine.mdi("G0 X10")
        if not result:
            print(result.outcome, result.messages)
        async for status in machine.statuses():
            print(status.position)

LinuxCNC's interface tells only whether the last command of anybody failed. Here every order has a result of its own,
with the operator messages that task wrote on its behalf (task numbers them with the order's serial number).
"""

from __future__ import annotations

import asyncio
import enum
from collections.abc import AsyncIterator, Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from types import TracebackType
from typing import Any

import nml.emc as emc
from linuxcnc import _constants as const
from linuxcnc._command import command
from linuxcnc._connection import open_channel
from linuxcnc._error import text_of
from linuxcnc._stat import stat
from nml.channel import Channel
from nml.message import Message

FOREVER = 1e9  # s
LOOK = 0.2  # s between looks whether an iteration was given up
ENDS_OTHERS = (emc.EMC_TASK_ABORT_TYPE, emc.EMC_TASK_SET_STATE_TYPE)  # commands that cut short what is under way


class Outcome(enum.Enum):
    """What became of an order."""

    DONE = "done"
    REFUSED = "refused"
    """Task did not begin with it."""
    FAILED = "failed"
    """It began and ended with an error."""
    ABORTED = "aborted"
    """An abort, E-stop or power-off ended it."""


@dataclass(frozen=True, slots=True)
class Result:
    """The end of an order; true if it was done."""

    outcome: Outcome
    serial: int
    messages: tuple[str, ...]

    def __bool__(self) -> bool:
        return self.outcome is Outcome.DONE


class _Orders(command):
    """The command channel, watched more closely: did the order begin, and what took its place?"""

    def __init__(self) -> None:
        super().__init__()
        self._errors: Channel = open_channel("emcError")
        self._began = False
        self._replaced_by = 0

    def _follow(self, status: emc.EMC_STAT) -> None:
        super()._follow(status)
        if self._echo == self.serial and self._result == const.RCS_EXEC:
            self._began = True
        elif self._echo > self.serial and not self._replaced_by:
            self._replaced_by = status.command_type

    def carry_out(self, method: str, *arguments: Any) -> Result:
        """Give one order and wait for its end."""
        self._began, self._replaced_by = False, 0
        getattr(self, method)(*arguments)
        code = self.wait_complete(FOREVER)
        told = [message for message in iter(self._errors.read, None) if _serial_of(message) == self.serial]
        failed = code == const.RCS_ERROR or any(isinstance(message, emc.EMC_OPERATOR_ERROR) for message in told)
        return Result(self._outcome(failed), self.serial, tuple(map(text_of, told)))

    def _outcome(self, failed: bool) -> Outcome:
        """``failed``: the status or a message says so; the status of a short order may be over before it was seen."""
        if failed:
            return Outcome.FAILED if self._began else Outcome.REFUSED
        return Outcome.ABORTED if self._replaced_by in ENDS_OTHERS else Outcome.DONE


def _serial_of(message: Message) -> int:
    """Number of the command that a message belongs to; 0 for none."""
    return int(getattr(message, "id", 0))


class Machine:
    """A running machine. Each method of ``linuxcnc.command`` is here, awaitable, with a `Result`."""

    def __init__(self) -> None:
        self._orders = _Orders()
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="linuxcnc-orders")

    async def __aenter__(self) -> Machine:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._thread.shutdown(wait=False, cancel_futures=True)

    def __getattr__(self, name: str) -> Callable[..., Awaitable[Result]]:
        if name.startswith("_") or not callable(getattr(command, name, None)):
            raise AttributeError(f"{type(self).__name__} has no {name!r}")

        async def give(*arguments: Any) -> Result:
            loop = asyncio.get_running_loop()
            return await loop.run_in_executor(self._thread, self._orders.carry_out, name, *arguments)

        return give

    async def abort(self) -> Result:
        """Stop at once, also while another order of this machine is awaited."""
        return await asyncio.to_thread(_Orders().carry_out, "abort")

    async def statuses(self) -> AsyncIterator[stat]:
        """The status each time it has changed, the newest one if several came meanwhile."""
        status = stat()
        yield status
        while True:
            if await asyncio.to_thread(status.wait, LOOK):
                status.poll()
                yield status

    async def until(self, condition: Callable[[stat], object], timeout: float | None = None) -> stat:
        """Wait until the status fulfils a condition; TimeoutError after ``timeout`` s."""
        async with asyncio.timeout(timeout):
            async for status in self.statuses():
                if condition(status):
                    return status
        raise AssertionError("the iteration has no end")
