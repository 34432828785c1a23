"""asyncio beside ``import linuxcnc``: await orders, iterate over the status, and know what became of each order.

    async with Machine() as machine:
        result = await machine.mdi("G0 X10")
        if not result:
            print(result.outcome, result.messages)
        async for status in machine.statuses():
            print(status.position)

LinuxCNC's interface tells only whether the last command of anybody failed. Here every order has a result of its own,
with the operator messages that task wrote on its behalf, and on no other client's.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from types import TracebackType
from typing import Any

from linuxcnc._command import command
from linuxcnc._results import Outcome, Result
from linuxcnc._stat import stat

__all__ = ["Machine", "Outcome", "Result"]

LOOK = 0.2  # s between looks whether an iteration was given up


class _Orders(command):
    """The command channel, from a thread."""

    def carry_out(self, method: str, *arguments: Any) -> Result:
        """Give one order and wait for its end."""
        getattr(self, method)(*arguments)
        result = self.result()
        assert result is not None, "it is waited for without end"
        return result


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
