"""The oscilloscope of the page: records of pins at thread rate, taken by a thread of this process, one at a time."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hal.capture import POLL_SECONDS, Capture, Row, Trigger
from hal.session import Session
from nml import clock
from nml.errors import HalError

MOST_PINS = 16
MOST_SAMPLES = 100_000
ARM_SECONDS = 5.0  # until the recording function is in its thread
AUTO_SECONDS = 0.2  # a record without a trigger is shown this often


@dataclass(frozen=True, slots=True)
class Order:
    """What to record."""

    pins: tuple[str, ...]
    thread: str
    samples: int
    before: int
    trigger: Trigger | None
    repeat: bool


@dataclass(frozen=True, slots=True)
class Record:
    """What was recorded; ``data`` is float32, a row for each sample."""

    run: int
    period: float  # s
    pins: tuple[str, ...]
    samples: int
    trigger: int  # the sample in which it fired
    data: bytes


class Scope:
    """One run from `start` to `stop`; records go to ``deliver``, a failure to ``failed``, both in its own thread."""

    def __init__(self, order: Order, deliver: Callable[[Record], None], failed: Callable[[str], None]) -> None:
        self._order = order
        self._deliver = deliver
        self._failed = failed
        self._over = threading.Event()
        self._armed = threading.Event()
        self._thread = threading.Thread(target=self._run, name="web-scope", daemon=True)

    def start(self) -> None:
        """Begin; returns when every period is seen, or when it has failed."""
        self._thread.start()
        self._armed.wait(ARM_SECONDS)

    def stop(self) -> None:
        """End it and wait until its function is out of the thread."""
        self._over.set()
        self._thread.join(5.0)

    @property
    def running(self) -> bool:
        return self._thread.is_alive()

    def _run(self) -> None:
        try:
            with Session() as session:
                thread = session.hal.segment.find_thread(self._order.thread)
                if thread is None:
                    raise HalError(f"there is no thread {self._order.thread}")
                with Capture(session, self._order.pins, self._order.thread) as capture:
                    self._armed.set()
                    self._record(capture, thread.period_ns * 1e-9)
        except HalError as reason:
            self._failed(str(reason))
        finally:
            self._armed.set()

    def _record(self, capture: Capture, period: float) -> None:
        run = 0
        while not self._over.is_set():
            rows, fired = self._one(capture)
            if rows is None:
                return
            run += 1
            data = np.array(rows, np.float32)
            self._deliver(Record(run, period, self._order.pins, len(rows), fired, data.tobytes()))
            if not self._order.repeat:
                return
            self._over.wait(AUTO_SECONDS)
            while capture.stream.read() is not None:
                pass  # what came meanwhile is older than the next picture

    def _one(self, capture: Capture) -> tuple[list[Row] | None, int]:
        """One picture: its rows and the row of the trigger; None when the end was asked for."""
        order, rows = self._order, list[Row]()
        fired = order.trigger is None
        column = order.pins.index(order.trigger.pin) if order.trigger is not None else 0
        before = 0 if order.trigger is None else order.before
        while len(rows) < order.samples or not fired:
            row = self._next(capture)
            if row is None:
                return None, 0
            rows.append(row)
            if not fired:
                assert order.trigger is not None
                fired = len(rows) > before + 1 and order.trigger.fires(rows[-2][column], rows[-1][column])
                if fired:
                    rows = rows[-before - 1 :]
                else:
                    del rows[: max(0, len(rows) - before - 2)]
        return rows, before

    def _next(self, capture: Capture) -> Row | None:
        while (row := capture.stream.read()) is None:
            if not capture.stream.alive:
                raise HalError("the realtime session has ended")
            if self._over.is_set():
                return None
            clock.host_sleep(POLL_SECONDS)
        return row
