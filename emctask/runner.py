"""Runs programs and MDI lines: start, pause, resume, step, the end, and abort with everything agreed afterwards.

The runner owns ``interp_state``. A program or MDI line begins when the machine stands still and the interpreter has
taken over where it stands; it is over when everything it queued is done. An abort empties all queues at once, and as
soon as motion stands the interpreter takes over the place where that is.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import TYPE_CHECKING

from emctask.interplist import ExecutionError
from emctask.saver import Saver
from nml.emc import EMC_TOOL_ABORT
from nml.emc.constants import EMC_IO_ABORT_REASON_ENUM as Reason
from nml.emc.constants import EMC_TASK_INTERP_ENUM as Interp
from nml.emc.constants import EMC_TASK_MODE_ENUM as Mode
from nml.emc.constants import EMC_TASK_STATE_ENUM as State
from nml.emc.constants import ORDER_OUTCOME as Outcome
from nml.emc.emcmot import MotCommand, MotionState
from nml.errors import PyemcError

if TYPE_CHECKING:
    from emctask.task import Task

log = logging.getLogger(__name__)


class Runner:
    """See the module."""

    def __init__(self, task: Task) -> None:
        self._task = task
        self._begin: Callable[[], None] | None = None
        self._pending_error = ""
        self.stepping = False
        self._on_abort = False
        self.serial = 0
        """Serial number of the command that started what is under way; 0: nothing is."""
        self.saver = Saver(task.plan.save_parameters)

    def save_parameters(self) -> None:
        """Write the parameter file soon."""
        self.saver.request()

    # --- Start

    def run_program(self, line: int) -> None:
        """Start the loaded program; ``line`` above 1 skips what comes before."""
        self._task.status.forget_line(self._task.motion.status.id)
        self._start(lambda: self._task.plan.start(line), self._task.echo)

    def run_mdi(self, text: str) -> None:
        """Queue an MDI line; it runs at once if nothing else does."""
        self._task.mdi_queue.append((text, self._task.echo))

    def owns(self, serial: int) -> bool:
        """Does the program or an MDI line of this command run or wait to run?"""
        return serial == self.serial or any(serial == waiting for _, waiting in self._task.mdi_queue)

    def _start(self, begin: Callable[[], None], serial: int) -> None:
        self._begin = begin
        self.serial = self._task.operator.serial = serial
        self._set(Interp.READING)

    def _set(self, state: Interp) -> None:
        self._task.interp_state = state

    # --- Each cycle

    def advance(self) -> None:
        """Go on with whatever is under way."""
        task = self._task
        if self.saver.failure:
            task.operator.error(self.saver.take_failure())
        self._synchronise_when_quiet()
        if self._on_abort and not task.plan.must_synch and not task.plan.active:
            self._on_abort = False
            if task.state is State.ON and task.motion.all_homed:
                task.mdi_queue.appendleft((task.config.on_abort, task.echo))
        if self._begin is None and task.mdi_queue and not task.plan.active and not task.paused:
            text, serial = task.mdi_queue.popleft()
            task.mdi_text = text
            self._start(lambda: task.plan.start_mdi(text), serial)
        if self._begin is not None and not task.plan.must_synch and task.sequencer.idle and self._coordinated():
            begin, self._begin = self._begin, None
            self._guard(begin)
        if task.plan.active and not task.paused:
            self._guard(task.plan.read_ahead)
            if task.plan.active:
                reads = task.plan.typed or (task.plan.busy and not task.plan.waiting_for_synch)
                self._set(Interp.READING if reads else Interp.WAITING)
        self._step()
        try:
            task.sequencer.execute()
        except ExecutionError as error:
            task.fail(str(error))
            self.abort(Reason.TASK_EXEC_ERROR)
        self._finish_when_done()

    def _coordinated(self) -> bool:
        """Does motion move as programs need it? A homing cycle that failed has left it in joint mode."""
        motion = self._task.motion
        if motion.state is not MotionState.FREE or not motion.may_coordinate:
            return True
        if motion.settled:
            motion.send(MotCommand.COORD)
        return False

    def _guard(self, work: Callable[[], None]) -> None:
        """Let the interpreter work; an error ends the program after the blocks before it are done."""
        task = self._task
        try:
            work()
        except (PyemcError, OSError) as error:
            self._stop_reading(task.plan.describe(error))
        except Exception as error:  # a flaw of ours must not leave a machine without its controller
            log.exception("internal error")
            self._stop_reading(f"internal error in the interpreter: {type(error).__name__}: {error}")

    def _stop_reading(self, text: str) -> None:
        if self._task.plan.dry_run is not None or not self._task.plan.active:
            self._give_up_start(text)
            return
        if self._task.plan.typed and not self._task.canon.queue and self._task.sequencer.idle:
            self._reject_line(text)
            return
        self._task.operator.error(text)
        self._task.plan.stop_reading()
        self._pending_error = text

    def _give_up_start(self, text: str) -> None:
        """A program cannot begin at all, or not at the line: nothing was moved or switched, and nothing will be."""
        task = self._task
        task.plan.abort(task.plan.block_in_execution())
        self.stepping = False
        self._refuse(text)

    def _reject_line(self, text: str) -> None:
        """An MDI line that is wrong before it does anything: nothing changes, and the lines that wait behind it go."""
        task = self._task
        for _, serial in task.mdi_queue:
            task.results.end(serial, Outcome.ABORTED)
        task.mdi_queue.clear()
        task.mdi_text = ""
        task.plan.finish()
        task.plan.must_synch = True
        self._refuse(text)

    def _refuse(self, text: str) -> None:
        task = self._task
        task.fail(text)
        task.results.end(self.serial, Outcome.REFUSED)
        self.serial = 0
        self._set(Interp.IDLE)

    def _synchronise_when_quiet(self) -> None:
        task = self._task
        if task.plan.must_synch and not task.plan.active and task.sequencer.idle and self._quiet():
            task.plan.synch()

    def _quiet(self) -> bool:
        return self._task.at_rest and self._task.io.done

    def _finish_when_done(self) -> None:
        task = self._task
        plan = task.plan
        if not plan.active or plan.busy or plan.waiting_for_synch or task.paused:
            return
        if not (task.sequencer.idle and self._quiet()):
            return
        error, self._pending_error = self._pending_error, ""
        if error:
            self.abort(Reason.INTERPRETER_ERROR)
            task.failed = True
            return
        plan.finish()
        self._synchronise_when_quiet()
        task.mdi_text = ""
        self.stepping = False
        task.results.end(self.serial, Outcome.DONE)
        self.serial = 0
        task.canon.places.forget()
        self.save_parameters()
        self._set(Interp.READING if task.mdi_queue else Interp.IDLE)

    # --- Pause, resume, step

    def pause(self) -> None:
        """Motion holds, and nothing new begins; in auto mode the loaded program is held before it has begun."""
        task = self._task
        waits_to_run = task.mode is Mode.AUTO and task.plan.open_file
        if task.paused or (task.interp_state is Interp.IDLE and task.motion.settled and not waits_to_run):
            return
        task.motion.send(MotCommand.PAUSE)
        self._hold()
        if waits_to_run:
            self._set(Interp.PAUSED)

    def pause_at_stop(self) -> None:
        """The program stopped itself: motion stands already, and says so. A typed line that ends there is over."""
        plan = self._task.plan
        if plan.typed and not plan.busy and not self._task.canon.queue:
            return
        self._task.motion.send(MotCommand.PAUSE)
        self._hold()

    def _hold(self) -> None:
        task = self._task
        task.paused = True
        task.sequencer.held = True
        if task.interp_state is not Interp.IDLE:
            self._set(Interp.PAUSED)

    def resume(self) -> None:
        """Go on after a pause, a stop of the program, or in the middle of stepping."""
        task = self._task
        self.stepping = False
        task.sequencer.only_block = None
        self._release()
        task.motion.send(MotCommand.RESUME)

    def _release(self) -> None:
        task = self._task
        task.paused = False
        task.sequencer.held = False
        self._set(Interp.READING if task.plan.active else Interp.IDLE)

    def step(self) -> None:
        """Go on to the end of one block: of the moves that motion holds, or of the next block in the list.

        A pause may still be on its way to motion.
        """
        task = self._task
        held = task.motion.status.paused or not task.motion.echoed
        if held and task.motion.status.depth:
            task.motion.send(MotCommand.STEP)
            return
        if held:
            task.motion.send(MotCommand.RESUME)
        self.stepping = True
        task.sequencer.only_block = None
        self._release()

    def _step(self) -> None:
        task = self._task
        if not self.stepping or task.paused:
            return
        sequencer, queue = task.sequencer, task.canon.queue
        if sequencer.only_block is None:
            if queue:
                sequencer.only_block = queue[0][3]
            return
        over = not queue or queue[0][3] is not sequencer.only_block
        if over and sequencer.waits_for_nothing and self._quiet() and (queue or task.plan.busy):
            sequencer.only_block = None
            self._hold()

    # --- Abort

    def stop_spindles(self) -> None:
        """All spindles stop, and stay so until they are started again."""
        task = self._task
        for spindle in range(len(task.config.spindles)):
            task.motion.send(MotCommand.SPINDLE_OFF, spindle=spindle)
        task.canon.forget_spindles()

    def abort(self, reason: Reason) -> None:
        """Stop everything now; interpreter, motion and io agree again as soon as motion stands.

        If something ran, [RS274NGC]ON_ABORT_COMMAND follows then, unless it was that command which was aborted.
        """
        task = self._task
        place = task.plan.block_in_execution()
        ran = task.plan.dry_run is None and (task.plan.active or task.busy_with_program)
        ran_on_abort = task.plan.active and task.mdi_text == task.config.on_abort
        self._begin = None
        self._pending_error = ""
        self.stepping = False
        task.results.aborted(reason, self.serial, [serial for _, serial in task.mdi_queue])
        self.serial = 0
        task.mdi_queue.clear()
        task.mdi_text = ""
        task.status.forget_line(task.motion.status.id)
        task.sequencer.abort()
        task.motion.send(MotCommand.ABORT)
        task.paused = False
        self.stop_spindles()
        task.io.send_first(EMC_TOOL_ABORT(reason=reason))
        task.plan.abort(place)
        task.sequencer.abort()
        self._set(Interp.IDLE)
        self._on_abort = ran and bool(task.config.on_abort) and not ran_on_abort
