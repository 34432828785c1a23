"""Between pins and devices: the pins of each transaction, and a thread for each link that does its work in turn.

A transaction that fails counts in its pin ``num_errors``; its pins keep their values, and it is tried again.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass, field

import hal
from hal.modbus import protocol
from hal.modbus.config import PINS_BY_TYPE, Config, Transaction
from hal.modbus.links import Link
from hal.modbus.protocol import WORD, ModbusError
from hal.modbus.trace import Trace
from nml import clock

REST_S = 0.001  # host time between two looks whether something is due
AFTER_ERROR_S = 0.1  # host time before a transaction without a rate is tried again
PINS_PART = "create_each_mb_tx_hal_pins"


@dataclass(frozen=True, slots=True)
class Element:
    """The pins of one coil, input or register."""

    main: hal.Pin
    """The bit, or the register as a real number."""
    inverse: hal.Pin | None = None
    whole: hal.Pin | None = None

    def show(self, value: int) -> None:
        """What was read."""
        self.main.set(value)
        if self.inverse is not None:
            self.inverse.set(not value)
        if self.whole is not None:
            self.whole.set(value)

    def wanted(self, bits: bool) -> int:
        """What is to be written: the sum of both pins of a register, as far as it fits."""
        if bits:
            return int(self.main.get())
        whole = 0 if self.whole is None else self.whole.get()
        return max(0, min(WORD, int(self.main.get() + whole)))


@dataclass(slots=True)
class Job:
    """A transaction with its pins."""

    transaction: Transaction
    errors: hal.Pin
    elements: list[Element] = field(default_factory=list)
    due: float = 0.0

    def do(self, link: Link) -> None:
        """Read or write once; ModbusError when it fails."""
        t = self.transaction
        if t.function.writes:
            wanted = [element.wanted(t.function.bits) for element in self.elements]
            for request in protocol.write_requests(t.function, t.first, wanted):
                protocol.check(t.function, link.exchange(t.device, request, t.timeouts))
            return
        count = len(self.elements)
        answer = link.exchange(t.device, protocol.read_request(t.function, t.first, count), t.timeouts)
        for element, value in zip(self.elements, protocol.values(t.function, count, answer), strict=True):
            element.show(value)


def make_pins(component: hal.component, config: Config, trace: Trace) -> list[Job]:
    """All pins, and what is to be done with them."""
    jobs = []
    for t in config.transactions:
        named = _Namer(component, config, t, trace)
        errors = component.newpin(named.shown("num_errors"), hal.HAL_U32, hal.HAL_OUT)
        jobs.append(Job(t, errors, list(named.elements())))
    return jobs


@dataclass(slots=True)
class _Namer:
    """Makes the pins of one transaction."""

    component: hal.component
    config: Config
    transaction: Transaction
    trace: Trace

    def shown(self, element: str) -> str:
        """The name of an element's pins, without the module's."""
        name = f"{self.transaction.name}.{element}"
        number = self.transaction.number
        self.trace.detail(PINS_PART, f"mb_tx_num [{number}] pin_name [{self.config.module}.{name}]")
        return name

    def elements(self) -> Iterator[Element]:
        """The elements' pins, made one after the other."""
        function = self.transaction.function
        by_type = self.config.version >= PINS_BY_TYPE
        direction = hal.HAL_IN if function.writes else hal.HAL_OUT
        newpin = self.component.newpin
        for element in self.transaction.elements:
            name = self.shown(element)
            if function.bits:
                bit = newpin(f"{name}.bit" if by_type else name, hal.HAL_BIT, direction)
                inverse = None
                if by_type and not function.writes:
                    inverse = newpin(f"{name}.bit-inv", hal.HAL_BIT, direction)
                    inverse.set(True)
                yield Element(bit, inverse=inverse)
            elif by_type or not function.writes:
                real = newpin(f"{name}.float", hal.HAL_FLOAT, direction)
                yield Element(real, whole=newpin(f"{name}.int", hal.HAL_S32, direction))
            else:
                yield Element(newpin(name, hal.HAL_FLOAT, direction))


class Loop(threading.Thread):
    """Does the transactions of one link until ``stop``."""

    def __init__(self, link: Link, jobs: list[Job], slowdown_s: float) -> None:
        super().__init__(daemon=True)
        self._link, self._jobs, self._slowdown_s = link, jobs, slowdown_s
        self._stopped = threading.Event()
        self._traces = {job.transaction.number: Trace(job.transaction.debug) for job in jobs}

    def run(self) -> None:
        """Whatever is due, in the order of the file."""
        while not self._stopped.wait(REST_S):
            for job in self._jobs:
                if clock.host_now() >= job.due and not self._stopped.is_set():
                    self._once(job)

    def _once(self, job: Job) -> None:
        t = job.transaction
        trace = self._traces[t.number]
        started = clock.host_now()
        try:
            job.do(self._link)
        except ModbusError as error:
            job.errors.set((job.errors.get() + 1) & 0xFFFFFFFF)
            trace.error("link_loop_and_logic", f"transaction {t.number}: {error}")
            pause = 1 / t.rate if t.rate else AFTER_ERROR_S
        else:
            trace.ok("link_loop_and_logic", f"transaction {t.number} done")
            pause = 1 / t.rate if t.rate else 0.0
        job.due = started + pause
        self._stopped.wait(t.delay_s + self._slowdown_s)

    def stop(self) -> None:
        """End it, after the exchange that is under way."""
        self._stopped.set()
        self.join()
        self._link.close()
