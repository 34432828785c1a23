"""``linuxcnc INI --run FILE``: the work of an operator who has one program to run, from E-stop to the summary."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import linuxcnc
from linuxcnc._connection import open_channel
from linuxcnc._error import text_of
from nml import clock
from nml.channel import Channel
from nml.emc import EMC_OPERATOR_ERROR
from nml.emc.emcmot import EMCMOT_STATUS
from nml.errors import PyemcError

HOMING_TIMEOUT = 600.0  # controller seconds
STATE_TIMEOUT = 30.0  # host seconds for E-stop reset, power, mode and loading
LOOK = 0.05  # host seconds between looks at a running program
AXES = "XYZABCUVW"


class ProgramError(PyemcError):
    """The program did not run to its end; the text says why."""


class Display(Protocol):
    """Shows how far the program is; see ``progress``."""

    def show(self, progress: Progress) -> None: ...
    def say(self, line: str) -> None: ...


@dataclass(slots=True)
class Progress:
    """Where the program is."""

    lines: int  # of the program file
    started: float  # controller time in s
    units: str
    axes: str
    line: int = 0
    position: tuple[float, ...] = ()
    tool: int = 0
    tool_changes: int = 0
    reached: int = 0  # highest line so far

    @property
    def elapsed(self) -> float:
        """Controller time in s."""
        return clock.now() - self.started

    @property
    def fraction(self) -> float:
        """Part of the program's lines that was reached, 0 to 1."""
        return min(1.0, self.reached / max(1, self.lines))

    @property
    def remaining(self) -> float | None:
        """Controller time in s that the rest will take if it goes on like this; None while nobody can tell."""
        return self.elapsed * (1.0 - self.fraction) / self.fraction if self.fraction > 0.0 else None


class Operator:
    """Drives a machine through the client API as a person at the screen would."""

    def __init__(self, check: Callable[[], None], display: Display) -> None:
        self._check = check
        self._display = display
        self._status = linuxcnc.stat()
        self._command = linuxcnc.command()
        self._resumer = linuxcnc.command()
        self._messages = open_channel("emcError")
        deque(iter(self._messages.read, None), maxlen=0)  # what was told before is not about this program

    def _tell(self) -> None:
        """Show the operator's messages, but for the errors that are the reason for a failure here."""
        for message in iter(self._messages.read, None):
            if not isinstance(message, EMC_OPERATOR_ERROR) or message.id != self._command.serial:
                self._display.say(text_of(message))

    def _look(self) -> linuxcnc.stat:
        self._check()
        self._status.poll()
        return self._status

    def prepare(self) -> None:
        """Out of E-stop, power on, all joints homed."""
        command = self._command
        command.state(linuxcnc.STATE_ESTOP_RESET)
        self._done("E-stop reset")
        command.state(linuxcnc.STATE_ON)
        self._done("machine on")
        command.mode(linuxcnc.MODE_MANUAL)
        self._done("manual mode")
        command.home(-1)
        self._done("homing", HOMING_TIMEOUT / clock.speed() + STATE_TIMEOUT)

    def open(self, path: Path) -> None:
        """Load the program."""
        self._command.mode(linuxcnc.MODE_AUTO)
        self._done("auto mode")
        self._command.program_open(str(path))
        self._done(f"opening {path}")

    def _done(self, doing: str, timeout: float = STATE_TIMEOUT) -> None:
        """Wait for the end of the last order; ProgramError with its messages when it was not done."""
        deadline = clock.host_now() + timeout
        while (result := self._command.result(min(LOOK, timeout))) is None:
            self._check()
            if clock.host_now() > deadline:
                raise ProgramError(f"{doing}: nothing happened for {timeout:g} s")
        if not result:
            raise ProgramError("; ".join(result.messages) or f"{doing} was {result.outcome.value}")

    def run(self, path: Path) -> Progress:
        """Run the loaded program to its end."""
        status = self._look()
        progress = Progress(
            lines=_count_lines(path),
            started=clock.now(),
            units=_unit_name(status.linear_units),
            axes="".join(axis for bit, axis in enumerate(AXES) if status.axis_mask >> bit & 1),
            tool=status.tool_in_spindle,
        )
        self._command.auto(linuxcnc.AUTO_RUN, 0)
        next_look = clock.host_now()
        while not self._ended():
            self._follow(progress)
            if clock.host_now() >= next_look:
                next_look = clock.host_now() + LOOK
                self._check()
                self._display.show(progress)
            self._status.wait(LOOK)
            self._status.poll()
        self._follow(progress)
        progress.reached = progress.lines
        self._display.show(progress)
        return progress

    def _ended(self) -> bool:
        """Whether the program is over; ProgramError when it ended before its end."""
        result = self._command.result(0.0)
        status = self._status
        if result is not None:
            if result:
                self._tell()
                return True
            off = status.task_state != linuxcnc.STATE_ON
            why = "the machine was switched off while the program was running" if off else "the program was aborted"
            raise ProgramError("; ".join(result.messages) or why)
        self._tell()
        if status.interp_state == linuxcnc.INTERP_PAUSED and status.task_paused:
            self._display.say(f"line {status.motion_line or status.current_line}: the program paused; going on")
            self._resumer.auto(linuxcnc.AUTO_RESUME)
        return False

    def _follow(self, progress: Progress) -> None:
        status = self._status
        progress.line = status.motion_line or status.current_line or progress.line
        progress.reached = max(progress.reached, progress.line)
        progress.position = status.actual_position
        if status.tool_in_spindle != progress.tool:
            progress.tool = status.tool_in_spindle
            progress.tool_changes += 1

    def worst_following_error(self) -> float:
        """Largest following error of any joint since the machine was switched on, in machine units."""
        status = self._look()
        return max(joint["ferror_highmark"] for joint in status.joint[: status.joints])


def run_program(check: Callable[[], None], path: Path) -> str:
    """Run one program on a started machine, from E-stop to the summary; ProgramError says why it did not end.

    ``check`` is called now and then; it raises when a process of the machine is gone.
    """
    from linuxcnc.progress import make_display

    with make_display(path.name) as display:
        operator = Operator(check, display)
        operator.prepare()
        operator.open(path)
        return run_loaded(operator, path)


def run_loaded(operator: Operator, path: Path) -> str:
    """Run the loaded program; returns the summary."""
    motion = Channel(linuxcnc.nmlfile, "emcmotStatus", "xemc")
    before = _distance(motion)
    progress = operator.run(path)
    return _summary(progress, _distance(motion) - before, operator.worst_following_error())


def _distance(motion: Channel) -> float:
    """Length of path that the controlled point has travelled since motion was loaded, in machine units."""
    status = motion.peek()
    return status.distance_travelled if isinstance(status, EMCMOT_STATUS) else 0.0


def _count_lines(path: Path) -> int:
    with path.open("rb") as file:
        return sum(1 for _ in file)


def _unit_name(units_per_mm: float) -> str:
    return "mm" if abs(units_per_mm - 1.0) < 1e-6 else "inch" if abs(units_per_mm * 25.4 - 1.0) < 1e-3 else "units"


def _summary(progress: Progress, distance: float, ferror: float) -> str:
    from linuxcnc.progress import duration

    rows = (
        ("time", duration(progress.elapsed)),
        ("distance", f"{distance:.3f} {progress.units}"),
        ("tool changes", str(progress.tool_changes)),
        ("worst following error", f"{ferror:.6f} {progress.units}"),
    )
    return "\n".join(f"{name + ':':<23}{value}" for name, value in rows)
