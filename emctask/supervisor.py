"""Watches motion and io: E-stop, a machine that switched itself off, refused commands, partners that fell silent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask import transitions
from nml.emc.constants import EMC_IO_ABORT_REASON_ENUM as Reason
from nml.emc.constants import EMC_TASK_MODE_ENUM as Mode
from nml.emc.constants import EMC_TASK_STATE_ENUM as State
from nml.emc.emcmot import MotCommand

if TYPE_CHECKING:
    from emctask.task import Task


class Supervisor:
    """Looked at once a cycle."""

    def __init__(self, task: Task) -> None:
        self._task = task
        self._lost: set[str] = set()
        self._in_error = False
        self._all_homed = False
        self._homing_ordered = False
        self.homing_ends = False
        """Is the last joint homed, and motion about to change into teleop mode?"""

    def look(self) -> None:
        """React to whatever changed since the last cycle."""
        task = self._task
        self._partners()
        task.operator.from_io(task.io.order_of)
        for error in task.motion.errors():
            order = task.results.refused_by_motion(error.echo_serial_number)
            task.operator.from_motion(error, task.canon.places, order)
        self._refusals()
        self._state()
        self._homed()

    def _partners(self) -> None:
        task = self._task
        for name, partner in (("motion", task.motion), ("io", task.io)):
            if partner.alive:
                if name in self._lost:
                    self._lost.discard(name)
                    partner.reconnected()
                    task.operator.error(f"{name} answers again; reset the E-stop to go on")
            elif name not in self._lost:
                self._lost.add(name)
                task.fail(f"{name} does not answer any more; the machine is in E-stop")
                transitions.emergency_stop(task, Reason.MOTION_OR_IO_RCS_ERROR)

    def _refusals(self) -> None:
        """A command that motion refused or a move that failed ends the program."""
        task = self._task
        in_error = task.motion.in_error
        arose, self._in_error = in_error and not self._in_error, in_error
        if not task.motion.refused() and not arose:
            return
        task.failed |= arose or task.plan.active
        if task.plan.active:
            task.runner.abort(Reason.MOTION_OR_IO_RCS_ERROR)

    def _state(self) -> None:
        task = self._task
        state = self._seen()
        if state is task.state:
            return
        before, task.state = task.state, state
        if before is State.ON:
            transitions.left_on(task, state)

    def homing_ordered(self) -> None:
        """Motion was told to home joints, perhaps some that are homed already."""
        self._homing_ordered = True

    def _homed(self) -> None:
        """When the last joint is homed, or one of them anew, jogs in manual mode move axes from then on."""
        task = self._task
        if task.mode is not Mode.MANUAL:
            return
        before, self._all_homed = self._all_homed, task.motion.all_homed
        self.homing_ends |= self._all_homed and not before
        if not task.motion.settled or task.motion.homing:
            return
        anew = self._homing_ordered and self._all_homed and not task.motion.refused_last
        ended, self.homing_ends, self._homing_ordered = self.homing_ends or anew, False, False
        if ended and task.state is State.ON:
            task.motion.send(MotCommand.TELEOP)

    def _seen(self) -> State:
        """The state as motion and io show it."""
        task = self._task
        if self._lost or task.io.status.aux.estop:
            return State.ESTOP
        return State.ON if task.motion.enabled else State.ESTOP_RESET
