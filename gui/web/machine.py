"""The connection to task: status and messages that come, orders that go; threads here, asyncio for everybody else.

One thread follows the status and what task tells of the end of each order, one reads operator messages, and orders go
out through threads of their own, so that nothing that task takes long for delays a stop: ``urgent`` has its own
connection.
"""

from __future__ import annotations

import asyncio
import contextlib
import enum
import os
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import linuxcnc
from gui.web import readout
from gui.web.calls import CallError
from gui.web.messages import KINDS
from linuxcnc._connection import open_channel
from linuxcnc._error import text_of
from nml import clock
from nml.emc import EMC_ORDER_RESULT
from nml.emc.constants import ORDER_OUTCOME
from nml.emc.orders import RESULT_BUFFER
from nml.errors import NmlError
from nml.message import Message

LOOK = 0.25  # s between looks whether the server ends
FAST = 0.004  # s between looks at the status while an order or a jog is under way
BRISK = 0.02  # s between statuses that are passed on meanwhile, and from a status to the one that follows an order
LONG_EVERY = 4  # statuses from one with the long arrays of inputs and outputs to the next
SERIALS_KEPT = 512
SILENT_AFTER = 1.5  # s without a new status
PATIENCE = 600.0  # s that an order may take
HAPPY = (None, ORDER_OUTCOME.DONE)  # ends of orders that nothing went wrong with, so far
SETTLED = 5.0  # s until a state that an order has brought about is seen; a busy computer takes its time


class Lane(enum.Enum):
    """Which connection an order takes; orders of one lane keep their sequence."""

    ORDERS = "orders"
    JOGS = "jogs"
    URGENT = "urgent"


@dataclass(slots=True)
class End:
    """What task has told of an order so far."""

    outcome: ORDER_OUTCOME | None = None
    texts: list[str] = field(default_factory=list)
    """The errors that belong to it."""


class Machine:
    """One running machine, as the server sees it."""

    def __init__(
        self,
        cycle: float,
        on_status: Callable[[dict[str, Any]], None],
        on_message: Callable[[str, str, int], None],
    ) -> None:
        self.values: dict[str, Any] = {}
        self._cycle = cycle
        self._on_status = on_status
        self._on_message = on_message
        self._loop = asyncio.get_running_loop()
        self._status = linuxcnc.stat()
        self._errors = open_channel("emcError")
        self._lanes = {lane: (ThreadPoolExecutor(1, f"web-{lane.value}"), linuxcnc.command()) for lane in Lane}
        for _, command in self._lanes.values():
            command.origin = f"web[{os.getpid()}]"
        self._results = open_channel(RESULT_BUFFER)
        self._ends: dict[int, End] = {}  # of the newest orders, by serial number
        self._waiting: dict[int, asyncio.Future[None]] = {}  # for the end of an order, by serial number
        self._own: deque[int] = deque(maxlen=SERIALS_KEPT)  # serial numbers of orders of ours
        self._closely = False
        self._changed = asyncio.Event()
        self._over = threading.Event()
        self._hurry = threading.Event()
        self._threads = [
            threading.Thread(target=self._follow, name="web-status", daemon=True),
            threading.Thread(target=self._read_messages, name="web-messages", daemon=True),
        ]

    def start(self) -> None:
        """Begin to follow the machine."""
        for thread in self._threads:
            thread.start()

    def stop(self) -> None:
        """End the threads."""
        self._over.set()
        self._hurry.set()
        for executor, _ in self._lanes.values():
            executor.shutdown(wait=False, cancel_futures=True)
        for thread in self._threads:
            thread.join(2 * LOOK)

    # --- status ----------------------------------------------------------------------------------------------------

    def _follow(self) -> None:
        """Thread: pass on each status, at most one a cycle, but one after an order of anybody soon.

        While an order of ours is under way look oftener. Its end is passed on with a status that was read after it, for
        task tells it after the status that shows it.
        """
        status, shown, heard, shown_ends = self._status, float("-inf"), clock.host_now(), (0, 0)
        looks = -1
        while not self._over.is_set():
            try:
                told = self._read_results()
                fresh = status.wait(0.0 if told else LOOK)
                told += self._read_results()
                status.poll()
            except (linuxcnc.error, NmlError) as reason:
                self._tell({"machine": str(reason)}, [])
                self._over.wait(LOOK)
                continue
            now = clock.host_now()
            if not fresh and not told:
                if now - heard > SILENT_AFTER:
                    self._tell({"machine": "task does not answer"}, [])
                continue
            heard = now
            ends = (status.echo_serial_number, status.state)
            soonest = 0.0 if self._hurry.is_set() else BRISK
            if told or now - shown >= (self._period if ends == shown_ends else soonest):
                shown, shown_ends = now, ends
                looks += 1
                self._tell({"machine": "ok", **readout.read(status, looks % LONG_EVERY == 0)}, told)
            self._pause(shown + self._cycle - clock.host_now())

    @property
    def _period(self) -> float:
        """Time between statuses that are passed on."""
        return min(BRISK, self._cycle) if self._hurry.is_set() else self._cycle

    def watch_closely(self, on: bool) -> None:
        """Pass statuses on oftener than the display needs them; a jog does."""
        self._closely = on
        if on:
            self._hurry.set()

    def _pause(self, rest: float) -> None:
        """Sleep until the next status is due; an order under way cuts it short."""
        if self._hurry.is_set():
            self._results.wait(FAST)
        elif rest > 0.0:
            self._hurry.wait(min(rest, BRISK))

    def _read_results(self) -> list[Message]:
        """In the thread: what task has told of orders."""
        told = []
        while (message := self._results.read()) is not None:
            told.append(message)
        return told

    def _tell(self, values: dict[str, Any], told: list[Message]) -> None:
        if not self._over.is_set():
            self._loop.call_soon_threadsafe(self._take, values, told)

    def _take(self, values: dict[str, Any], told: list[Message]) -> None:
        """In the event loop: a status has come, and what task told of orders before it was read."""
        self.values |= values
        for message in told:
            self._note(message)
        self._on_status(values)
        self._changed.set()
        self._changed.clear()
        if not self._waiting and not self._closely:
            self._hurry.clear()

    def _note(self, message: Message) -> None:
        """Keep what task told of an order; at its end go on with whoever waits for it."""
        if isinstance(message, EMC_ORDER_RESULT):
            self._end_of(message.serial).outcome = ORDER_OUTCOME(message.outcome)
            waiting = self._waiting.pop(message.serial, None)
            if waiting is not None and not waiting.done():
                waiting.set_result(None)
        elif KINDS.get(message.TYPE_ID) == "error":
            self._end_of(int(getattr(message, "id", 0))).texts.append(text_of(message))

    def _end_of(self, serial: int) -> End:
        while len(self._ends) > SERIALS_KEPT:
            del self._ends[next(iter(self._ends))]
        return self._ends.setdefault(serial, End())

    async def reach(self, condition: Callable[[dict[str, Any]], object], timeout: float = SETTLED) -> bool:
        """Wait until the status map fulfils a condition; false after ``timeout`` s."""
        try:
            async with asyncio.timeout(timeout):
                while not condition(self.values):
                    await self._changed.wait()
        except TimeoutError:
            return False
        return True

    # --- messages --------------------------------------------------------------------------------------------------

    def _read_messages(self) -> None:
        """Thread: pass on what task and io have to say."""
        while not self._over.is_set():
            self._errors.wait(LOOK)
            while not self._over.is_set() and (message := self._errors.read()) is not None:
                kind = KINDS.get(message.TYPE_ID, "text")
                number = int(getattr(message, "id", 0))
                self._loop.call_soon_threadsafe(self._on_message, kind, text_of(message), number)

    # --- orders ----------------------------------------------------------------------------------------------------

    async def send(self, name: str, *arguments: Any, lane: Lane = Lane.ORDERS) -> int:
        """Give an order, a method of ``linuxcnc.command``; its serial number once task has taken it."""
        executor, command = self._lanes[lane]

        def give() -> int:
            getattr(command, name)(*arguments)
            self._own.append(command.serial)
            return int(command.serial)

        try:
            return await self._loop.run_in_executor(executor, give)
        except linuxcnc.error as reason:
            raise CallError("machine", "{reason}", reason=str(reason), messages=[str(reason)]) from None

    async def order(self, name: str, *arguments: Any, lane: Lane = Lane.ORDERS) -> int:
        """Give an order and wait for its end; CallError with the machine's words where it fails."""
        return await self.finished(await self.send(name, *arguments, lane=lane))

    async def begin(self, name: str, *arguments: Any) -> None:
        """Give an order that starts the program; CallError with the machine's words where it is refused."""
        serial = await self.send(name, *arguments)
        end = self._end_of(serial)
        await self.reach(
            lambda values: end.outcome is not None or values["interp_state"] != linuxcnc.INTERP_IDLE, PATIENCE
        )
        if end.outcome is not None:
            _judge(end)

    async def finished(self, serial: int) -> int:
        """Wait for the end of an order that was given; CallError with the machine's words where it fails."""
        end = self._end_of(serial)
        if end.outcome is None:
            waiting = self._waiting[serial] = self._loop.create_future()
            self._hurry.set()
            try:
                async with asyncio.timeout(PATIENCE):
                    await waiting
            except TimeoutError:
                raise CallError("machine", "the machine has not finished it yet", messages=[]) from None
            finally:
                self._waiting.pop(serial, None)
        _judge(end)
        return serial

    async def adjust(self, name: str, *arguments: Any, lane: Lane = Lane.ORDERS) -> None:
        """Give an order that acts at once, also while a program runs; nobody waits long for its end."""
        serial = await self.send(name, *arguments, lane=lane)
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(SETTLED):
                await self.finished(serial)

    def only_ours(self, first: int, last: int) -> bool:
        """Whether every order from one serial number to another came from this server and none of them failed."""
        own = set(self._own)
        unhappy = {serial for serial, end in self._ends.items() if end.texts or end.outcome not in HAPPY}
        return all(serial in own and serial not in unhappy for serial in range(first, last + 1))

    def give_up(self) -> None:
        """An abort: whoever waits for the end of an order is told that there is none."""
        for waiting in self._waiting.values():
            if not waiting.done():
                waiting.set_exception(CallError("aborted", "aborted"))
        self._waiting.clear()

    async def mode(self, mode: int) -> None:
        """Be in a mode."""
        if self.values.get("task_mode") != mode:
            await self.order("mode", mode)
            await self.reach(lambda values: values["task_mode"] == mode)


def _judge(end: End) -> None:
    """CallError for an order that was not done."""
    if end.outcome is ORDER_OUTCOME.ABORTED:
        raise CallError("aborted", "aborted")
    if end.outcome is not ORDER_OUTCOME.DONE:
        said = "; ".join(end.texts)
        text = "{reason}" if said else "the machine refused it"
        raise CallError("machine", text, reason=said, messages=end.texts)
