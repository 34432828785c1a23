"""Record pins at thread rate: what ``halscope``, ``latency-histogram`` and tests use. Talks to the realtime host.

    with Capture(session, ["joint.0.vel-cmd", "spindle.0.on"], "servo-thread") as capture:
        rows = capture.read(1000)
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from hal.session import Session
from hal.stream import Stream
from nml import clock
from nml.errors import HalError

Row = tuple[Any, ...]
POLL_SECONDS = 0.002
COMPARISONS: dict[str, Callable[[float, float], bool]] = {">": float.__gt__, "<": float.__lt__}


@dataclass(frozen=True)
class Trigger:
    """The period in which a pin passes a level: ``pin>level`` upwards, ``pin<level`` downwards."""

    pin: str
    comparison: str
    level: float

    @classmethod
    def parse(cls, text: str) -> Trigger:
        for comparison in COMPARISONS:
            pin, found, level = text.partition(comparison)
            if found:
                try:
                    return cls(pin.strip(), comparison, float(level))
                except ValueError:
                    break
        raise HalError(f"trigger '{text}': PIN>LEVEL or PIN<LEVEL would be right")

    def fires(self, before: float, now: float) -> bool:
        compare = COMPARISONS[self.comparison]
        return compare(float(now), self.level) and not compare(float(before), self.level)


class Capture:
    """Pins queued by a function at the end of a thread, as long as this context lasts."""

    def __init__(self, session: Session, pins: Sequence[str], thread: str, depth: int = 20000) -> None:
        self.session, self.pins, self.thread, self.depth = session, list(pins), thread, depth

    def __enter__(self) -> Capture:
        self.session.host.loadrt("scope", [f"pins={','.join(self.pins)}", f"depth={self.depth}"])
        try:
            self.session.host.addf("scope.capture", self.thread)
            self.stream = Stream("scope")
        except HalError:
            self.session.host.unloadrt("scope")
            raise
        return self

    def __exit__(self, *exc: object) -> None:
        self.stream.close()
        self.session.host.unloadrt("scope")

    def _next(self) -> Row:
        while (row := self.stream.read()) is None:
            if not self.stream.alive:
                raise HalError("the realtime session has ended")
            clock.host_sleep(POLL_SECONDS)
        return row

    def read(self, count: int) -> list[Row]:
        """The next ``count`` periods."""
        return [self._next() for _ in range(count)]

    def read_triggered(self, count: int, trigger: Trigger, before: int) -> list[Row]:
        """``count`` periods, of which ``before`` lie before the one in which the trigger fires."""
        column = self.pins.index(trigger.pin)
        rows = [self._next()]
        while not (len(rows) > before and trigger.fires(rows[-2][column], rows[-1][column])):
            rows.append(self._next())
            del rows[: max(0, len(rows) - before - 2)]
        rows = rows[-before - 1 :]
        return rows + self.read(count - len(rows))
