"""What became of one command, with the messages that belong to it and to no other client's: ``command.result``.

Task tells the end of every command on emcResults, under its serial number. LinuxCNC's interface has only the state of
the command that anybody gave last; a machine that LinuxCNC runs, reached over a network, tells no more than that.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass

from linuxcnc._connection import error, open_channel
from linuxcnc._error import text_of
from nml import clock
from nml.channel import Channel
from nml.emc import EMC_ORDER_RESULT
from nml.emc.constants import ORDER_OUTCOME
from nml.emc.orders import RESULT_BUFFER
from nml.errors import BufferError_, NmlError
from nml.message import Message

LOOK = 1.0  # host seconds between looks whether task still lives
DEAD = 5.0  # host seconds without a sign of life after which nobody will tell a result


class Outcome(enum.Enum):
    """What became of an order."""

    DONE = "done"
    REFUSED = "refused"
    """It is not allowed now, or wrong: nothing was done."""
    FAILED = "failed"
    """It began and ended with an error."""
    ABORTED = "aborted"
    """An abort, E-stop, power-off or change of mode ended it before it was done."""


@dataclass(frozen=True, slots=True)
class Result:
    """The end of an order; true if it was done."""

    outcome: Outcome
    serial: int
    messages: tuple[str, ...]

    def __bool__(self) -> bool:
        return self.outcome is Outcome.DONE


OUTCOMES = {number: Outcome[number.name] for number in ORDER_OUTCOME}


class Results:
    """A reader of emcResults, which keeps some thousand ends of orders."""

    def __init__(self, status: Channel) -> None:
        self._status = status
        self._serial = 0
        self._messages: list[str] = []
        self._mark = 0
        self._channel: Channel | None = None
        try:
            self._channel = open_channel(RESULT_BUFFER)
        except error:
            if not status.remote:
                raise
        self.told = self._channel is not None
        """Does the machine tell results? A LinuxCNC elsewhere does not; known for sure when one was waited for."""

    def mark(self) -> None:
        """A command is about to be given; its result comes after what was told so far."""
        if self._channel is not None and not self._channel.remote:
            self._mark = self._channel.write_counter

    def wait(self, serial: int, timeout: float) -> Result | None:
        """The end of the command that was given last; None if it is not over after ``timeout`` s, or never told."""
        channel = self._channel
        if channel is None:
            return None
        if serial != self._serial:
            self._serial, self._messages = serial, []
        deadline = clock.host_now() + timeout
        try:
            while (result := self._read(channel)) is None:
                left = deadline - clock.host_now()
                if left <= 0.0:
                    return None
                if not channel.wait(min(left, LOOK)):
                    self._look_for_life()
        except BufferError_ as reason:
            if not channel.remote:
                raise error(f"{RESULT_BUFFER}: {reason}") from reason
            self.told = False
            return None
        except NmlError as reason:
            raise error(f"{RESULT_BUFFER}: {reason}") from reason
        return result

    def _read(self, channel: Channel) -> Result | None:
        missed = channel.missed
        while (message := channel.read()) is not None:
            if channel.missed != missed and channel.raw.last > self._mark + 1:
                raise error(f"the result of command {self._serial} was dropped: it was asked for too late")
            if isinstance(message, EMC_ORDER_RESULT):
                if message.serial == self._serial:
                    return Result(OUTCOMES[ORDER_OUTCOME(message.outcome)], self._serial, tuple(self._messages))
            elif _serial_of(message) == self._serial:
                self._messages.append(text_of(message))
        return None

    def _look_for_life(self) -> None:
        age = self._status.age()
        if age is not None and age > DEAD:
            raise error(f"task has given no sign of life for {age:.0f} s; what becomes of the command is not known")


def _serial_of(message: Message) -> int:
    """Number of the command that a message belongs to; 0 for none."""
    return int(getattr(message, "id", 0))
