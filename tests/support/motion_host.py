"""Motion in a realtime host of this process, wired by HAL lines, with the three buffers as task has them.

The threads run as fast as ``speed`` times real time, all of them in one scheduler, so that they keep their order.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Any

from hal.realtime import Host
from hal.stream import Stream
from nml import clock
from nml.channel import Channel
from nml.emc.emcmot import EMCMOT_COMMAND, EMCMOT_STATUS, MotCommand, MotionFlag

PATIENCE = 60.0  # s; a watchdog, not a claim about speed
SAMPLES = 60_000  # servo periods


class MotionHost:
    """``hal`` is a HAL file's text, whose threads motmod makes; ``sampled`` pins are kept every servo period."""

    def __init__(self, hal: str, sampled: Sequence[str] = (), *, speed: float = 1.0) -> None:
        self._speed_before = clock.speed()
        clock.set_speed(speed)
        self.host = Host()
        self.hal = self.host.hal
        self._stream: Stream | None = None
        try:
            self._wire(hal, sampled)
        except BaseException:
            self.host.close()
            raise
        self.command = Channel(None, "emcmotCommand", "emc")
        self.status = Channel(None, "emcmotStatus", "emc")
        self.error = Channel(None, "emcmotError", "emc")
        self.hal.start_threads()

    def _wire(self, hal: str, sampled: Sequence[str]) -> None:
        for line in hal.splitlines():
            self.do(line)
        if sampled:
            self.do(f"loadrt sampler cfg={'f' * len(sampled)} depth={SAMPLES}")
            for column, pin in enumerate(sampled):
                self.do(f"net {self._signal_of(pin) or f'sample-{column}'} {pin} sampler.0.pin.{column}")
            self.do("addf sampler.0 servo-thread")
            self._stream = Stream("sampler.0")

    def _signal_of(self, pin: str) -> str | None:
        signal = self.hal.pin(pin).signal
        return signal.name if signal is not None else None

    def do(self, line: str) -> None:
        """One line of a HAL file: loadrt, net, setp or addf."""
        words = [word for word in line.partition("#")[0].split() if word not in ("=>", "<=", "<=>")]
        if not words:
            return
        name, args = words[0], words[1:]
        actions: dict[str, Callable[[], Any]] = {
            "loadrt": lambda: self.host.load(args[0], args[1:]),
            "net": lambda: self.hal.net(args[0], args[1:]),
            "setp": lambda: self.hal.set_item(args[0], args[1]),
            "addf": lambda: self.host.add_function(args[0], args[1]),
        }
        actions[name]()

    def configure(
        self, joint: int, *, vel: float = 100.0, acc: float = 1000.0, limit: float = 1000.0, **home: Any
    ) -> None:
        """What task says of a joint and the axis of its number; ``home``: fields of SET_JOINT_HOMING_PARAMS."""
        C = MotCommand
        self.send(C.SET_JOINT_POSITION_LIMITS, joint=joint, minLimit=-limit, maxLimit=limit)
        self.send(C.SET_JOINT_VEL_LIMIT, joint=joint, vel=vel)
        self.send(C.SET_JOINT_ACC_LIMIT, joint=joint, acc=acc)
        self.send(C.SET_JOINT_MIN_FERROR, joint=joint, minFerror=1.0)
        self.send(C.SET_JOINT_MAX_FERROR, joint=joint, maxFerror=2.0)
        self.send(C.SET_JOINT_HOMING_PARAMS, joint=joint, **{"home_sequence": 0, **home})
        self.send(C.JOINT_ACTIVATE, joint=joint)
        self.send(C.SET_AXIS_POSITION_LIMITS, axis=joint, minLimit=-limit, maxLimit=limit)
        self.send(C.SET_AXIS_VEL_LIMIT, axis=joint, vel=vel)
        self.send(C.SET_AXIS_ACC_LIMIT, axis=joint, acc=acc)

    def send(self, code: MotCommand, **fields: Any) -> int:
        return self.command.write(EMCMOT_COMMAND(command=int(code), **fields))

    def wait(self, condition: Callable[[EMCMOT_STATUS], object], what: str) -> EMCMOT_STATUS:
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            status = self.status.peek() or self.status.read()
            if status is not None and condition(status):  # type: ignore[arg-type]
                return status  # type: ignore[return-value]
            time.sleep(0.002)
        raise AssertionError(f"{what}: not within {PATIENCE} s; {self.errors()}")

    def done(self, serial: int) -> EMCMOT_STATUS:
        return self.wait(
            lambda s: s.commandNumEcho >= serial and s.depth == 0 and s.motionFlag & MotionFlag.INPOS, "motion done"
        )

    def errors(self) -> list[str]:
        found = []
        while (error := self.error.read()) is not None:
            found.append(error.text)
        return found

    def samples(self) -> list[tuple[float, ...]]:
        """One row for each servo period since the last call, none lost."""
        assert self._stream is not None
        assert self._stream.num_overruns == 0
        rows = []
        while (row := self._stream.read()) is not None:
            rows.append(row)
        return rows

    def close(self) -> None:
        if self._stream is not None:
            self._stream.close()
        self.host.close()
        for channel in (self.command, self.status, self.error):
            channel.close()
        clock.set_speed(self._speed_before)

    def __enter__(self) -> MotionHost:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
