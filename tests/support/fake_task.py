"""Stands in for task in tests of clients: takes commands from emcCommand, remembers them, and answers in emcStatus.

Results go to emcResults: done, refused for an error; what is being executed is aborted by the next command.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import TracebackType

from nml.channel import Channel
from nml.emc import EMC_OPERATOR_ERROR, EMC_ORDER_RESULT, EMC_STAT
from nml.emc.constants import ORDER_OUTCOME as Outcome
from nml.message import Command

RCS_DONE, RCS_EXEC, RCS_ERROR = 1, 2, 3


class FakeTask:
    """Answers every command with RCS_DONE, or with what ``answer(command, status)`` returns.

    ``cycle``: the status is also written every so many seconds, as task does it.
    """

    def __init__(self, answer: Callable[[Command, EMC_STAT], int] | None = None, cycle: float | None = None) -> None:
        self.status = EMC_STAT(status=RCS_DONE)
        self.taken: list[Command] = []
        self._answer = answer or (lambda command, status: RCS_DONE)
        self._commands = Channel(None, "emcCommand", "emc")
        self._statuses = Channel(None, "emcStatus", "emc")
        self.errors = Channel(None, "emcError", "emc")
        self._results = Channel(None, "emcResults", "emc")
        self._executing: list[Command] = []
        self._cycle = cycle
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self.publish()

    def publish(self) -> None:
        """Write the status as it is now."""
        self._statuses.write(self.status)

    def _run(self) -> None:
        while not self._over.is_set():
            if self._cycle is not None:
                self.publish()
            if not self._commands.wait(self._cycle or 0.05):
                continue
            while (command := self._commands.read()) is not None:
                assert isinstance(command, Command)
                self.taken.append(command)
                self.status.status = self._answer(command, self.status)
                self.status.echo_serial_number = command.serial_number
                self._tell_results(command)
                self.publish()

    def tell_error(self, serial: int, text: str) -> None:
        """Tell every operator, and who waits for the result of this command."""
        for channel in (self.errors, self._results):
            channel.write(EMC_OPERATOR_ERROR(id=serial, error=text))

    def _tell_results(self, command: Command) -> None:
        over = [(one, Outcome.ABORTED) for one in self._executing]
        self._executing = []
        if self.status.status == RCS_EXEC:
            self._executing.append(command)
        else:
            over.append((command, Outcome.REFUSED if self.status.status == RCS_ERROR else Outcome.DONE))
        for one, outcome in over:
            result = EMC_ORDER_RESULT(serial=one.serial_number, command_type=one.TYPE_ID, outcome=outcome)
            self._results.write(result)

    def __enter__(self) -> FakeTask:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        self._thread.join()
        for channel in (self._commands, self._statuses, self.errors, self._results):
            channel.close()
