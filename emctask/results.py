"""What becomes of each command: done, refused, failed or aborted, told on emcResults by the command's serial number.

``Task`` begins an order for every command that it takes. An order ends in one of three ways: a program or an MDI line
when the runner says so; a change of state or mode when what was expected has arrived; every other one as soon as its
own condition holds, which for most is that motion and io have taken what was sent to them. Settings thus are done while
a program runs. The messages for the operator that belong to an order are copied to emcResults before its end.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from emctask.operatorline import OperatorMessage
from nml.channel import Channel
from nml.emc import EMC_JOINT_HOME, EMC_OPERATOR_ERROR, EMC_ORDER_RESULT, EMC_TASK_ABORT, EMC_TASK_PLAN_STEP
from nml.emc.constants import EMC_IO_ABORT_REASON_ENUM as Reason
from nml.emc.constants import EMC_TASK_INTERP_ENUM as Interp
from nml.emc.constants import ORDER_OUTCOME as Outcome
from nml.errors import NmlError
from nml.message import Command, Message

if TYPE_CHECKING:
    from emctask.task import Task

log = logging.getLogger(__name__)

FAILURES = frozenset({Reason.TASK_EXEC_ERROR, Reason.MOTION_OR_IO_RCS_ERROR, Reason.INTERPRETER_ERROR})
"""Reasons for an abort that lie in what was aborted."""


@dataclass(slots=True)
class Order:
    """A command that has been taken and is not over yet."""

    command: Command
    sent_before: int
    """Motion commands up to this number are not this order's."""
    sent: int
    """The last motion command that this order sent; ``sent_before`` if it sent none."""
    over: Callable[[Task, Order], bool] | None = None
    """When it is done; None: somebody else tells."""
    to_io: bool = False
    """A part of it went to io."""
    refused: bool = False
    """Motion refused a part of it."""
    told_error: bool = False
    """An error message belongs to it."""


def taken(task: Task, order: Order) -> bool:
    """Motion has taken all of it, and io has finished its part."""
    return task.motion.status.commandNumEcho >= order.sent and (not order.to_io or task.io.done)


def homed(task: Task, order: Order) -> bool:
    """Homing has ended, well or not."""
    return taken(task, order) and not task.motion.homing and not task.supervisor.homing_ends and task.at_rest


def at_rest(task: Task, order: Order) -> bool:
    """The machine stands."""
    return taken(task, order) and (task.at_rest or task.jogs)


def stepped(task: Task, order: Order) -> bool:
    """The program stands again, or is over."""
    return taken(task, order) and (task.paused or task.interp_state is Interp.IDLE)


CONDITIONS: dict[int, Callable[[Task, Order], bool]] = {
    EMC_JOINT_HOME.TYPE_ID: homed,
    EMC_TASK_ABORT.TYPE_ID: at_rest,
    EMC_TASK_PLAN_STEP.TYPE_ID: stepped,
}
"""When orders are done that need more than to be taken."""


class Results:
    """The orders under way; one writer of emcResults."""

    def __init__(self, task: Task, channel: Channel) -> None:
        self._task = task
        self._channel = channel
        self._open: dict[int, Order] = {}
        self._told: list[Message] = []
        self._io_sent = 0

    # --- The life of an order

    def begin(self, command: Command) -> None:
        """A command is taken."""
        sent = self._task.motion.sent
        self._io_sent = self._task.io.sent
        self._open[command.serial_number] = Order(command, sent, sent)

    def handled(self, serial: int, *, told_elsewhere: bool) -> None:
        """Its handler has returned; ``told_elsewhere``: the runner, or whoever waits for what it set off, ends it."""
        order = self._open.get(serial)
        if order is None:
            return
        order.sent = self._task.motion.sent
        order.to_io = self._task.io.sent != self._io_sent
        order.over = CONDITIONS.get(order.command.TYPE_ID, None if told_elsewhere else taken)

    def look(self) -> None:
        """End the orders whose condition holds."""
        for serial, order in list(self._open.items()):
            if order.over is not None and order.over(self._task, order):
                self.end(serial, self._of_homing(order) if order.over is homed else Outcome.DONE)

    def end(self, serial: int, outcome: Outcome) -> None:
        """An order is over; nothing happens for one that was over before."""
        order = self._open.pop(serial, None)
        if order is None:
            return
        if order.refused and outcome in (Outcome.DONE, Outcome.FAILED):
            outcome = Outcome.REFUSED
        elif order.to_io and outcome is Outcome.DONE and self._task.io.failed:
            outcome = Outcome.FAILED
        self._told.append(EMC_ORDER_RESULT(serial=serial, command_type=order.command.TYPE_ID, outcome=outcome))

    def aborted(self, reason: Reason, running: int, waiting: list[int]) -> None:
        """The machine was told to stop: what ran, the MDI lines that waited behind it, and homing are over."""
        self.end(running, Outcome.FAILED if reason in FAILURES else Outcome.ABORTED)
        for serial in waiting:
            self.end(serial, Outcome.ABORTED)
        self.homing_aborted()

    def homing_aborted(self) -> None:
        """Homing was ended from outside."""
        for serial, order in list(self._open.items()):
            if order.over is homed:
                self.end(serial, Outcome.ABORTED)

    def publish(self) -> None:
        """Tell what has happened since the last call, after the status that shows it."""
        told, self._told = self._told, []
        for message in told:
            try:
                self._channel.write(message)
            except NmlError as error:
                log.warning("a result was lost: %s", error)

    def close(self) -> None:
        """Task ends; an order that is not over is aborted."""
        for serial in list(self._open):
            self.end(serial, Outcome.ABORTED)
        self.publish()
        self._channel.close()

    def _of_homing(self, order: Order) -> Outcome:
        joints = self._task.motion.status.joint_status
        command = order.command
        assert isinstance(command, EMC_JOINT_HOME)
        wanted = range(len(self._task.config.joints)) if command.joint < 0 else [command.joint]
        if all(joints[number].homed for number in wanted):
            return Outcome.DONE
        return Outcome.FAILED if order.told_error else Outcome.ABORTED

    # --- Which order a message belongs to

    @property
    def homing(self) -> int:
        """The order by which joints home; 0 if none do."""
        return next((serial for serial, order in self._open.items() if order.over is homed), 0)

    def refused_by_motion(self, sent: int) -> int:
        """Motion refused its command number ``sent``: the order that sent it, 0 if none did."""
        for serial, order in self._open.items():
            if order.sent_before < sent <= order.sent:
                order.refused = True
                return serial
        return 0

    def tell(self, message: OperatorMessage) -> None:
        """A message for the operator, which belongs to the order that it carries as id."""
        order = self._open.get(message.id)
        if order is not None:
            order.told_error |= isinstance(message, EMC_OPERATOR_ERROR)
            self._told.append(message)
