"""Executes the interp list: sends each entry when its turn has come, and waits where the entry says so.

``execute`` is called in every cycle of task and returns as soon as something must be waited for. What it waits for is
``exec_state``, which EMC_STAT shows. Moves go out in batches, as many as motion's planner has room for.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from emctask import operations as op
from emctask.config import MachineConfig
from emctask.homing import Homing, home
from emctask.interplist import Exec, ExecutionError, InterpList
from emctask.ioclient import IoClient
from emctask.motion import MotionClient
from emctask.places import Block
from emctask.usercommands import UserCommand
from nml import clock

ORIENT_COMPLETE, ORIENT_FAULTED = 1, 3
WAIT_IMMEDIATE, WAIT_RISE, WAIT_FALL, WAIT_HIGH, WAIT_LOW = range(5)
DIGITAL = 1


class Hooks(Protocol):
    """What the sequencer needs of task itself."""

    optional_stop: bool
    input_timeout: bool
    offsets: dict[str, object]

    def pause_here(self) -> None:
        """Pause before the next entry."""

    def show_text(self, text: str) -> None:
        """Show a text to the operator."""


class Sequencer:
    """See the module."""

    def __init__(
        self, config: MachineConfig, queue: InterpList, motion: MotionClient, io: IoClient, hooks: Hooks
    ) -> None:
        self.config = config
        self.queue = queue
        self.motion = motion
        self.io = io
        self.hooks = hooks
        self.exec_state = Exec.DONE
        self.current_line = 0
        self.current_block: Block | None = None
        self.only_block: Block | None = None
        self.held = False
        self.spindle_wait = False
        self.deadline = 0.0
        self._arrived: Callable[[], bool] = self._never_waits
        self._command: UserCommand | None = None
        self._homing: Homing | None = None
        self._conditions: dict[Exec, Callable[[], bool]] = {
            Exec.DONE: self._never_waits,
            Exec.WAITING_FOR_MOTION: self._motion_done,
            Exec.WAITING_FOR_IO: self._io_done,
            Exec.WAITING_FOR_MOTION_AND_IO: lambda: self.motion.settled and self._io_done(),
            Exec.WAITING_FOR_DELAY: lambda: self._arrived(),
            Exec.WAITING_FOR_SYSTEM_CMD: self._user_command_done,
            Exec.WAITING_FOR_SPINDLE_ORIENTED: lambda: self._arrived(),
        }
        self._after = Exec.DONE

    @property
    def idle(self) -> bool:
        """Nothing is queued and nothing is waited for."""
        return not self.queue and self._after is Exec.DONE

    @property
    def waits_for_nothing(self) -> bool:
        """Is the entry that ran last finished?"""
        return self._after is Exec.DONE

    @property
    def delay_left(self) -> float:
        """Seconds that a dwell or a wait for an input still lasts."""
        return max(0.0, self.deadline - clock.now()) if self._after is Exec.WAITING_FOR_DELAY else 0.0

    def execute(self) -> None:
        """Go on as far as possible; ExecutionError when an entry fails."""
        queue, conditions, motion = self.queue, self._conditions, self.motion
        if self.held:
            return
        if self._after is not Exec.DONE:
            if not conditions[self._after]():
                return
            self._after = self.exec_state = Exec.DONE
        room = motion.room()
        while queue:
            operation, payload, line, block = queue[0]
            if self.only_block is not None and block is not self.only_block:
                break
            if operation is op.move:
                if room <= 0:
                    self.exec_state = Exec.WAITING_FOR_MOTION_QUEUE
                    return
                room -= 1
            elif operation.before is not Exec.DONE and not conditions[operation.before]():
                self.exec_state = operation.before
                return
            queue.popleft()
            self.current_block = block
            if operation.moves:
                self.current_line = line
            operation.run(self, payload)
            if operation.after is not Exec.DONE:
                self._after = self.exec_state = operation.after
                if not conditions[operation.after]():
                    return
                self._after = Exec.DONE
            if self.held:
                break
        self.exec_state = Exec.DONE

    def abort(self) -> None:
        """Forget what is queued and what is waited for."""
        self.queue.clear()
        self._after = self.exec_state = Exec.DONE
        self.spindle_wait = False
        self.only_block = None
        self.held = False
        if self._command is not None:
            self._command.stop()
            self._command = None
        self._homing = None

    # --- What operations call

    def take_spindle_wait(self) -> int:
        """1 for the first move after a spindle was started: it waits until the spindle is at speed."""
        wait, self.spindle_wait = self.spindle_wait, False
        return int(wait)

    def wait_time(self, seconds: float) -> None:
        """Begin a dwell."""
        self.deadline = clock.now() + seconds
        self._arrived = lambda: clock.now() >= self.deadline

    def wait_input(self, index: int, kind: int, wait_type: int, timeout: float) -> None:
        """Begin to wait for an input (M66)."""
        self.hooks.input_timeout = False
        self.deadline = clock.now() + timeout
        if wait_type == WAIT_IMMEDIATE:
            self._arrived = self._never_waits
            return
        status = self.motion.status
        level = status.synch_di[index] if kind == DIGITAL else status.analog_input[index]
        seen = [bool(level)]

        def arrived() -> bool:
            now = bool(self.motion.status.synch_di[index])
            before, seen[0] = seen[0], now
            if {WAIT_RISE: now and not before, WAIT_FALL: before and not now, WAIT_HIGH: now, WAIT_LOW: not now}[
                wait_type
            ]:
                return True
            if clock.now() >= self.deadline:
                self.hooks.input_timeout = True
                return True
            return False

        self._arrived = arrived

    def wait_oriented(self, spindle: int, timeout: float) -> None:
        """Begin to wait for the end of an orientation (M19)."""
        self.deadline = clock.now() + timeout

        def arrived() -> bool:
            state = self.motion.status.spindle_status[spindle]
            if not self.motion.echoed:
                return False
            if state.orient_state == ORIENT_FAULTED:
                raise ExecutionError(f"spindle {spindle}: orientation failed with fault {state.orient_fault}")
            if state.orient_state == ORIENT_COMPLETE:
                return True
            if timeout > 0.0 and clock.now() >= self.deadline:
                raise ExecutionError(f"spindle {spindle}: not oriented within {timeout:g} s (M19 Q)")
            return False

        self._arrived = arrived

    def run_user_command(self, number: int, p: float, q: float) -> None:
        """Start a user M-code."""
        try:
            self._command = UserCommand(number, p, q, self.config.m_code_folders)
        except OSError as error:
            raise ExecutionError(str(error)) from None

    def home(self, joint: int) -> None:
        """Start the homing cycle of a joint, or of all."""
        self._homing = home(self.motion, self.config.joints, joint)

    # --- Conditions

    @staticmethod
    def _never_waits() -> bool:
        return True

    def _motion_done(self) -> bool:
        if self._homing is not None:
            for _ in self._homing:
                return False
            self._homing = None
        return self.motion.settled

    def _io_done(self) -> bool:
        if not self.io.done:
            return False
        if self.io.failed:
            raise ExecutionError("io could not carry out the last command; see the message before this one")
        return True

    def _user_command_done(self) -> bool:
        if self._command is None:
            return True
        code = self._command.poll()
        if code is None:
            return False
        number, self._command = self._command.number, None
        if code:
            raise ExecutionError(f"M{number} failed with exit code {code}")
        return True
