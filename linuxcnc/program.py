"""``linuxcnc INI --run FILE``: the work of an operator who has one program to run, from E-stop to the summary."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import linuxcnc
from nml import clock
from nml.channel import Channel
from nml.emc.emcmot import EMCMOT_STATUS
from nml.errors import PyemcError

HOMING_TIMEOUT = 600.0  # controller seconds
STATE_TIMEOUT = 5.0  # host seconds for E-stop reset, power and mode
LOOK = 0.05  # host seconds between looks at a running program
AXES = "XYZABCUVW"
ERRORS = (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR)


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
        self._errors = linuxcnc.error_channel()

    def _operator_errors(self) -> list[str]:
        """Pass operator messages on; returns those that are errors."""
        errors = []
        while (message := self._errors.poll()) is not None:
            kind, text = message
            if kind in ERRORS:
                errors.append(text)
            else:
                self._display.say(text)
        return errors

    def _refused(self, doing: str) -> ProgramError:
        errors = self._operator_errors()
        return ProgramError(errors[0] if errors else f"{doing} was refused")

    def _look(self) -> linuxcnc.stat:
        self._check()
        self._status.poll()
        return self._status

    def _reach(self, condition: Callable[[linuxcnc.stat], bool], doing: str, timeout: float) -> None:
        """Wait for a state of the machine; ProgramError with the operator's message when it does not come."""
        deadline = clock.host_now() + timeout
        while not condition(self._look()):
            errors = self._operator_errors()
            if errors:
                raise ProgramError(errors[0])
            if clock.host_now() > deadline:
                raise ProgramError(f"{doing}: nothing happened for {timeout:g} s")
            self._status.wait(LOOK)

    def prepare(self) -> None:
        """Out of E-stop, power on, all joints homed."""
        command = self._command
        command.state(linuxcnc.STATE_ESTOP_RESET)
        self._reach(lambda s: s.task_state != linuxcnc.STATE_ESTOP, "E-stop reset", STATE_TIMEOUT)
        command.state(linuxcnc.STATE_ON)
        self._reach(lambda s: s.task_state == linuxcnc.STATE_ON, "machine on", STATE_TIMEOUT)
        command.mode(linuxcnc.MODE_MANUAL)
        command.home(-1)
        self._reach(lambda s: all(s.homed[: s.joints]), "homing", HOMING_TIMEOUT / clock.speed() + STATE_TIMEOUT)
        command.wait_complete()

    def open(self, path: Path) -> None:
        """Load the program."""
        self._command.mode(linuxcnc.MODE_AUTO)
        self._command.wait_complete()
        self._command.program_open(str(path))
        if self._command.wait_complete() != linuxcnc.RCS_DONE:
            raise self._refused(f"opening {path}")

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
        errors = self._operator_errors()
        if errors:
            self._stop()
            raise ProgramError(errors[0])
        status = self._status
        if status.task_state != linuxcnc.STATE_ON:
            raise ProgramError("the machine was switched off while the program was running")
        if status.interp_state == linuxcnc.INTERP_PAUSED and status.task_paused:
            self._display.say(f"line {status.motion_line or status.current_line}: the program paused; going on")
            self._command.auto(linuxcnc.AUTO_RESUME)
            self._status.poll()
            return False
        if status.echo_serial_number < self._command.serial or status.state == linuxcnc.RCS_EXEC:
            return False
        if status.state == linuxcnc.RCS_ERROR:
            raise self._refused("running the program")
        return status.interp_state == linuxcnc.INTERP_IDLE

    def _follow(self, progress: Progress) -> None:
        status = self._status
        progress.line = status.motion_line or status.current_line or progress.line
        progress.reached = max(progress.reached, progress.line)
        progress.position = status.actual_position
        if status.tool_in_spindle != progress.tool:
            progress.tool = status.tool_in_spindle
            progress.tool_changes += 1

    def _stop(self) -> None:
        self._command.abort()
        self._command.wait_complete()

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
