"""The task controller: one cycle that takes commands, supervises motion and io, runs programs, and reports.

``Task`` holds the state of the whole machine; what a command does is in the ``handlers_*`` modules, state and mode
transitions in ``emctask.transitions``, running and stopping programs in ``emctask.runner``. The process sleeps on the
command buffer, so a command is taken at once; while something is under way it wakes every CYCLE_TIME as well.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from emctask import handlers, transitions
from emctask.canon import TaskCanon
from emctask.commandtable import REFUSALS, RULES, PassedOver, Refused, check
from emctask.config import MachineConfig
from emctask.inipins import IniPins
from emctask.ioclient import IoClient
from emctask.motion import MotionClient
from emctask.operatorline import OperatorLine
from emctask.plan import Plan
from emctask.results import Results
from emctask.runner import Runner
from emctask.sequencer import Sequencer
from emctask.status import StatusWriter
from emctask.supervisor import Supervisor
from nml import clock
from nml.channel import Channel
from nml.emc.constants import EMC_TASK_INTERP_ENUM as Interp
from nml.emc.constants import EMC_TASK_MODE_ENUM as Mode
from nml.emc.constants import EMC_TASK_STATE_ENUM as State
from nml.emc.constants import ORDER_OUTCOME as Outcome
from nml.inifile import IniFile
from nml.message import Command, Message

log = logging.getLogger(__name__)

DONE, EXEC, ERROR = 1, 2, 3
IDLE_WAIT_S = 0.01  # host time between two cycles when nothing is under way
SHORTEST_WAIT_S = 0.0005  # host time

assert handlers.LOADED


@dataclass(slots=True)
class Expectation:
    """Something a command set off and must see through before the next command is taken."""

    arrived: Callable[[], bool]
    deadline: float  # host time
    complaint: str
    serial: int  # of the command


class Task:
    """See the module."""

    def __init__(
        self,
        config: MachineConfig,
        ini: IniFile,
        commands: Channel,
        motion: MotionClient,
        io: IoClient,
        status: StatusWriter,
        operator: OperatorLine,
        results: Channel,
        pins: IniPins,
    ) -> None:
        self.config = config
        self.commands = commands
        self.motion = motion
        self.io = io
        self.status = status
        self.operator = operator
        self.pins = pins
        self.running = True
        self.state = State.ESTOP
        self.mode = Mode.MANUAL
        self.interp_state = Interp.IDLE
        self.paused = False
        self.optional_stop = True
        self.block_delete = True
        self.input_timeout = False
        self.offsets: dict[str, object] = {}
        self.mdi_queue: deque[tuple[str, int]] = deque()
        self.mdi_text = ""
        self.debug = config.debug
        self.echo = 0
        self.command_type = 0
        self.failed = False
        self.canon = TaskCanon(config, motion, io)
        self.canon.input_timed_out = lambda: self.input_timeout
        self.canon.optional_stop, self.canon.block_delete = self.optional_stop, self.block_delete
        self.sequencer = Sequencer(config, self.canon.queue, motion, io, self)
        self.plan = Plan(ini, self.canon, self.sequencer)
        self.runner = Runner(self)
        self.supervisor = Supervisor(self)
        self.results = Results(self, results)
        operator.also_tell = self.results.tell
        io.order = lambda: operator.serial
        self._waiting: deque[Message] = deque()
        self._expected: Expectation | None = None

    # --- The cycle

    def run(self, stopped: Callable[[], bool]) -> None:
        """Work until ``stopped`` or told to halt; then switch the machine off and save what must be kept."""
        while self.running and not stopped():
            self.cycle()
            self.commands.wait(self._wait_s())
        transitions.shut_down(self)
        self.status.write(self)

    def cycle(self) -> None:
        """Once around: look, obey, go on, report."""
        self.motion.poll()
        self.io.poll()
        self.operator.serial = self._serial_in_force()
        self.supervisor.look()
        self._read_commands()
        self.pins.look(self, at_once=bool(self._waiting))
        self._obey()
        self.operator.serial = self._serial_in_force()
        self.runner.advance()
        self.results.look()
        self.motion.beat()
        self.status.write(self)
        self.results.publish()

    def _wait_s(self) -> float:
        if self.rcs_status != EXEC and not self.mdi_queue and not self._waiting:
            return IDLE_WAIT_S
        return max(self.config.cycle_s / clock.speed(), SHORTEST_WAIT_S) if self.config.cycle_s > 0 else SHORTEST_WAIT_S

    @property
    def busy(self) -> bool:
        """Is something under way that a command set off?"""
        return (
            self._expected is not None
            or self.interp_state is not Interp.IDLE
            or bool(self.mdi_queue)
            or not self.sequencer.idle
            or not self.io.done
            or not (self.at_rest or self.jogs)
            or self.supervisor.homing_ends
        )

    @property
    def busy_with_program(self) -> bool:
        """Is a program or an MDI line under way or about to begin?"""
        return self.interp_state is not Interp.IDLE or bool(self.mdi_queue) or not self.sequencer.idle

    @property
    def at_rest(self) -> bool:
        """Has motion taken and finished everything? A machine that is off cannot be in position."""
        return self.motion.settled or (self.motion.echoed and not self.motion.enabled)

    @property
    def jogs(self) -> bool:
        """Does the operator jog? The order is done when motion has taken it, so that the next one can end the jog."""
        return self.motion.echoed and bool(self.motion.status.jogging_active)

    @property
    def rcs_status(self) -> int:
        """How the last command stands: done, executing, error."""
        return ERROR if self.failed else EXEC if self.busy else DONE

    def _serial_in_force(self) -> int:
        """The command that texts of now belong to: of program, MDI line or homing, else the last until it is done."""
        return self.runner.serial or self.results.homing or (self.echo if self.busy else 0)

    # --- Commands

    def _read_commands(self) -> None:
        while (message := self.commands.read()) is not None:
            self._waiting.append(message)

    def _obey(self) -> None:
        if any(RULES[m.TYPE_ID].urgent(m) for m in self._waiting if m.TYPE_ID in RULES):
            self._give_up_expectation()
        while self._waiting:
            if self._expected is not None and not self._has_arrived(self._expected):
                return
            self._take(self._waiting.popleft())
        if self._expected is not None:
            self._has_arrived(self._expected)

    def _give_up_expectation(self) -> None:
        if self._expected is not None:
            self.results.end(self._expected.serial, Outcome.ABORTED)
            self._expected = None

    def _has_arrived(self, expected: Expectation) -> bool:
        if expected.arrived():
            self._expected = None
            self.results.end(expected.serial, Outcome.DONE)
            return True
        if clock.host_now() < expected.deadline:
            return False
        self._expected = None
        self.operator.serial = expected.serial
        self.fail(expected.complaint)
        self.results.end(expected.serial, Outcome.FAILED)
        return True

    def expect(self, arrived: Callable[[], bool], complaint: str, timeout_s: float | None = None) -> None:
        """The command being handled is done when ``arrived`` says so, and fails with ``complaint`` after a while."""
        deadline = clock.host_now() + (timeout_s or self.config.comm_timeout_s)
        self._expected = Expectation(arrived, deadline, complaint, self.echo)

    def _take(self, message: Message) -> None:
        self.failed = False
        self.command_type = message.TYPE_ID
        if isinstance(message, Command):
            self.echo = self.operator.serial = message.serial_number
            self.results.begin(message)
        name = type(message).__name__
        rule = RULES.get(message.TYPE_ID)
        try:
            if rule is None:
                reason = REFUSALS.get(message.TYPE_ID, "this controller does not know it")
                raise Refused(f"{name} is refused: {reason}")
            check(rule, message, self.state, self.mode, self.interp_state)
            log.debug("%r", message)
            rule.handler(self, message)
        except Refused as refusal:
            self.operator.error(str(refusal))
            self.failed = not isinstance(refusal, PassedOver)
            self.results.end(self.echo, Outcome.REFUSED)
        else:
            told_elsewhere = self._expected is not None or self.runner.owns(self.echo)
            self.results.handled(self.echo, told_elsewhere=told_elsewhere)

    def fail(self, text: str) -> None:
        """Tell the operator; the command that was given last has failed."""
        self.failed = True
        self.operator.error(text)

    # --- What the sequencer calls

    def pause_here(self) -> None:
        """M0, M1, M60: the program waits for the operator."""
        self.runner.pause_at_stop()

    def show_text(self, text: str) -> None:
        """(MSG, ...)."""
        self.operator.display(text)

    def close(self) -> None:
        """Close every channel, remove the pins."""
        for part in (self.results, self.commands, self.motion, self.io, self.status, self.operator, self.pins):
            part.close()
