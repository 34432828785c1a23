"""The connection to task: status and messages that come, orders that go; threads here, asyncio for everybody else.

One thread follows the status and tells when an order is over, one reads operator messages, and orders go out through
threads of their own, so that nothing that task takes long for delays a stop: ``urgent`` has its own connection.
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
from dataclasses import dataclass
from typing import Any

import linuxcnc
from gui.web import readout
from gui.web.calls import CallError
from gui.web.messages import KINDS
from linuxcnc._connection import open_channel
from linuxcnc._error import text_of
from nml import clock

LOOK = 0.25  # s between looks whether the server ends
FAST = 0.004  # s between looks at the status while an order or a jog is under way
BRISK = 0.02  # s between statuses that are passed on meanwhile, and from a status to the one that follows an order
LONG_EVERY = 4  # statuses from one with the long arrays of inputs and outputs to the next
SERIALS_KEPT = 512
SILENT_AFTER = 1.5  # s without a new status
PATIENCE = 600.0  # s that an order may take
FIRST_WORD = 1.0  # s in which the first message of an order that has failed arrives, also on a busy computer
LAST_WORDS = 0.06  # s in which the others arrive
SETTLED = 5.0  # s until a state that an order has brought about is seen; a busy computer takes its time


class Lane(enum.Enum):
    """Which connection an order takes; orders of one lane keep their sequence."""

    ORDERS = "orders"
    JOGS = "jogs"
    URGENT = "urgent"


@dataclass(slots=True)
class Waiting:
    """An order that was given and is not over."""

    future: asyncio.Future[int]
    serial: int


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
        self._waiting: list[Waiting] = []
        self._texts: dict[int, list[str]] = {}
        self._own: deque[int] = deque(maxlen=SERIALS_KEPT)  # serial numbers of orders of ours
        self._closely = False
        self._changed = asyncio.Event()
        self._heard = asyncio.Event()
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

        While an order of ours is under way look oftener.
        """
        status, shown, heard, told = self._status, float("-inf"), clock.host_now(), (0, 0)
        looks = -1
        while not self._over.is_set():
            try:
                fresh = status.wait(LOOK)
                status.poll()
            except linuxcnc.error as reason:
                self._tell({"machine": str(reason)}, None)
                self._over.wait(LOOK)
                continue
            now = clock.host_now()
            if not fresh:
                if now - heard > SILENT_AFTER:
                    self._tell({"machine": "task does not answer"}, None)
                continue
            heard = now
            ends = (status.echo_serial_number, status.state)
            soonest = 0.0 if self._hurry.is_set() else BRISK
            if now - shown >= (self._period if ends == told else soonest):
                shown, told = now, ends
                looks += 1
                self._tell({"machine": "ok", **readout.read(status, looks % LONG_EVERY == 0)}, ends)
            else:
                self._tell(None, ends)
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
            self._over.wait(FAST)
        elif rest > 0.0:
            self._hurry.wait(min(rest, BRISK))

    def _tell(self, values: dict[str, Any] | None, ends: tuple[int, int] | None) -> None:
        if not self._over.is_set():
            self._loop.call_soon_threadsafe(self._take, values, ends)

    def _take(self, values: dict[str, Any] | None, ends: tuple[int, int] | None) -> None:
        """In the event loop: a status has come."""
        if values is not None:
            self.values |= values
            self._on_status(values)
            self._changed.set()
            self._changed.clear()
        if ends is None:
            return
        echo, state = ends
        for order in list(self._waiting):
            if echo > order.serial or (echo == order.serial and state != linuxcnc.RCS_EXEC):
                self._waiting.remove(order)
                if not order.future.done():
                    order.future.set_result(state if echo == order.serial else linuxcnc.RCS_DONE)
        if not self._waiting and not self._closely:
            self._hurry.clear()

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
                self._loop.call_soon_threadsafe(self._hear, kind, text_of(message), int(getattr(message, "id", 0)))

    def _hear(self, kind: str, text: str, serial: int) -> None:
        if kind == "error" and serial:
            self._texts.setdefault(serial, []).append(text)
            for old in list(self._texts)[:-100]:
                del self._texts[old]
            self._heard.set()
            self._heard.clear()
        self._on_message(kind, text, serial)

    async def _hear_out(self, serial: int) -> None:
        """Wait for what task has to say about an order that has failed."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(FIRST_WORD):
                while serial not in self._texts:
                    await self._heard.wait()
        await asyncio.sleep(LAST_WORDS)

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

    async def finished(self, serial: int) -> int:
        """Wait for the end of an order that was given."""
        waiting = Waiting(self._loop.create_future(), serial)
        self._waiting.append(waiting)
        self._hurry.set()
        try:
            async with asyncio.timeout(PATIENCE):
                result = await waiting.future
        except TimeoutError:
            raise CallError("machine", "the machine has not finished it yet", messages=[]) from None
        finally:
            if waiting in self._waiting:
                self._waiting.remove(waiting)
        if result == linuxcnc.RCS_ERROR:
            await self._hear_out(serial)
        self._complain(serial, result)
        return serial

    async def adjust(self, name: str, *arguments: Any, lane: Lane = Lane.ORDERS) -> None:
        """Give an order that acts at once, also while a program runs, whose end is then not the order's."""
        serial = await self.send(name, *arguments, lane=lane)
        if self.values["interp_state"] == linuxcnc.INTERP_IDLE and self.values["inpos"]:
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(SETTLED):
                    await self.finished(serial)
        else:
            await asyncio.sleep(LAST_WORDS)
            self._complain(serial, linuxcnc.RCS_DONE)

    def _complain(self, serial: int, result: int) -> None:
        """CallError if an order has failed or task had something to say against it."""
        texts = self._texts.pop(serial, [])
        if result == linuxcnc.RCS_ERROR or texts:
            said = "; ".join(texts)
            raise CallError("machine", "{reason}" if said else "the machine refused it", reason=said, messages=texts)

    def only_ours(self, first: int, last: int) -> bool:
        """Whether every order from one serial number to another came from this server and none of them failed."""
        own = set(self._own)
        return all(serial in own and serial not in self._texts for serial in range(first, last + 1))

    def give_up(self) -> None:
        """An abort: whoever waits for the end of an order is told that there is none."""
        for order in self._waiting:
            if not order.future.done():
                order.future.set_exception(CallError("aborted", "aborted"))
        self._waiting.clear()

    async def mode(self, mode: int) -> None:
        """Be in a mode."""
        if self.values.get("task_mode") != mode:
            await self.order("mode", mode)
            await self.reach(lambda values: values["task_mode"] == mode)
