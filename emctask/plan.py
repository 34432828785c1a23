"""Drives the interpreter: opens programs, reads ahead into the interp list, runs MDI lines, and synchronises.

Reading ahead stops at a full list and at a queue-buster (the interpreter answers EXECUTE_FINISH: probe, M66, tool
change, ...). After a queue-buster everything queued must be finished and motion and io must stand still; only then the
interpreter takes over the state of the world and reads on. So the same program gives the same result every time.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from enum import Enum, auto
from typing import TYPE_CHECKING

from emctask import standing
from emctask.canon import TaskCanon
from emctask.places import Block, Calls, Modes
from emctask.runfromline import RunFromLine
from nml import clock
from nml.errors import InterpError
from nml.inifile import IniFile
from rs274ngc.interp import (
    INTERP_ENDFILE,
    INTERP_EXECUTE_FINISH,
    INTERP_EXIT,
    Interpreter,
)

if TYPE_CHECKING:
    from emctask.sequencer import Sequencer

SLICE_S = 0.004  # host time that reading ahead may take before task looks at its other duties
BLOCKS_PER_LOOK = 32  # blocks between two looks at the clock

INTERP_ERROR = 5  # LinuxCNC's number, for stat.interpreter_errcode
TYPED = "MDI"  # the file that the interpreter names for a line that was typed in

MAY_OFFSET = re.compile(r"#0*5[123]\d\d=|#[\[#]|g0*(?:10|28\.1|30\.1|52|5[4-9]|92)|m0*(?:2|30)(?!\d)", re.IGNORECASE)
"""Words of a block after which the stored offsets may be others."""


class Source(Enum):
    """Where blocks come from."""

    NOTHING = auto()
    PROGRAM = auto()
    MDI = auto()


class Plan:
    """The interpreter and what it is doing."""

    def __init__(self, ini: IniFile, canon: TaskCanon, sequencer: Sequencer) -> None:
        self.canon = canon
        self.sequencer = sequencer
        self.interp = Interpreter(canon, ini)
        self.interp.repeats_main = True
        self.interp.init()
        self.source = Source.NOTHING
        self.waiting_for_synch = False
        self.at_end = False
        self.must_synch = True
        self.file = ""
        self._last_line = ""
        self.dry_run: RunFromLine | None = None
        """Run from line, as long as the lines before the first one are being read."""
        self._modal_version = (-1, -1)
        self._modes = Modes((), (), ())
        self._offsets = standing.read_offsets(self.interp)
        """The stored offsets as far as the program was read."""
        self._before = Block("")
        """What was in force when the program or MDI line began."""
        self._restore: Block | None = None
        """Where the machine was when a program was aborted; the interpreter had read on."""
        self.interpreter_code = 0
        self._units = canon.coords.units
        """The program's length units when the interpreter last took over the state of the machine."""

    # --- Programs

    def open(self, path: str) -> None:
        """Load a program; InterpError or ConfigError when it cannot be read."""
        self.interp.close()
        self.file = ""
        self.interpreter_code = INTERP_ERROR
        self.interp.open(path)
        self.interpreter_code = 0
        self.sequencer.current_line = 0
        self.file = str(path)

    def close(self) -> None:
        """Forget the loaded program."""
        self.interp.close()
        self.file = ""

    @property
    def open_file(self) -> bool:
        """Is a program loaded?"""
        return bool(self.file)

    def start(self, line: int = 0) -> None:
        """Begin to read the loaded program, from its first line or from ``line``."""
        self.interp.close()
        self.interp.open(self.file)
        self._begin(Source.PROGRAM)
        if line > 1:
            self.dry_run = RunFromLine(self.interp, self.canon, self.file, line, self._before)

    def start_mdi(self, text: str) -> None:
        """Execute one line; InterpError when it is wrong."""
        self._begin(Source.MDI)
        self._execute(lambda: self.interp.execute_mdi(text))
        if not self.waiting_for_synch and not self.interp.call_level:
            self._reached_end()

    def _begin(self, source: Source) -> None:
        self._last_line = ""
        self.source = source
        self._before = self.canon.block = Block(self.file)
        self.canon.end_block(self._current_modes(), self._offsets)
        self.sequencer.current_block = None
        self.sequencer.current_line = 0
        self.at_end = False
        self.waiting_for_synch = False
        self.interpreter_code = 0

    @property
    def busy(self) -> bool:
        """Is there something left to read?"""
        return self.source is not Source.NOTHING and not self.at_end

    @property
    def active(self) -> bool:
        """Is a program or an MDI line under way, be it only in the machine?"""
        return self.source is not Source.NOTHING

    @property
    def program_line(self) -> str:
        """Text of the program's line that was read last; it stays when the program is over."""
        return self.interp.block_text.strip() if self.source is Source.PROGRAM else self._last_line

    def forget_line(self) -> None:
        """The program's line is not shown any more."""
        self._last_line = ""

    @property
    def runs_program(self) -> bool:
        """Is it a program that is under way?"""
        return self.source is Source.PROGRAM

    @property
    def typed(self) -> bool:
        """Is it an MDI line that is under way?"""
        return self.source is Source.MDI

    def read_ahead(self) -> None:
        """Read until the list is full, the slice is over, or something must be waited for; InterpError ends it."""
        if not self.busy:
            return
        if self.waiting_for_synch:
            if not self._quiet():
                return
            self.synch()
            if self.source is Source.MDI and not self.interp.call_level:
                self._reached_end()
                return
        until = clock.host_now() + SLICE_S
        if self.dry_run is not None and not self._reach_line(self.dry_run, until):
            return
        while not self.canon.queue.full:
            for _ in range(BLOCKS_PER_LOOK):
                if not self._read_block():
                    return
            if clock.host_now() > until:
                return

    def _reach_line(self, dry_run: RunFromLine, until: float) -> bool:
        """Go on with run from line; may the line be read?"""
        if not dry_run.advance(until):
            return False
        modes = self._current_modes()
        dry_run.check(modes)
        self._offsets = standing.read_offsets(self.interp)
        for text in dry_run.start(modes, self._offsets):
            self.sequencer.hooks.show_text(text)
        self.dry_run = None
        return True

    def _read_block(self) -> bool:
        """Read and execute one block; False when reading must stop."""
        interp = self.interp
        if interp.read() == INTERP_ENDFILE:
            self._reached_end()
            return False
        self._execute(interp.execute)
        if self.source is Source.MDI and not interp.call_level and not self.waiting_for_synch:
            self._reached_end()
        return not (self.at_end or self.waiting_for_synch)

    def _execute(self, execute: Callable[[], int]) -> None:
        canon, interp = self.canon, self.interp
        canon.begin_block(interp.line, self.file if self.source is Source.PROGRAM else "", self.calls)
        code = execute()
        if code == INTERP_EXIT:
            self._reached_end()
        elif code == INTERP_EXECUTE_FINISH:
            canon.flush()
            self.waiting_for_synch = True
        if code == INTERP_EXIT or MAY_OFFSET.search(interp.block_text.replace(" ", "")):
            self._offsets = standing.read_offsets(interp)
        canon.end_block(self.modes, self._offsets)

    @property
    def calls(self) -> Calls:
        """The subroutine calls that the interpreter stands in; a line that was typed in stands in no file."""
        calls = self.interp.calls if self.interp.call_level else ()
        return ((calls[0][0], "", 0), *calls[1:]) if calls and self.source is Source.MDI else calls

    @property
    def modes(self) -> Modes:
        """The codes that are active for the machine."""
        return (self._before.modes if self.dry_run is not None else None) or self._current_modes()

    def _current_modes(self) -> Modes:
        """The interpreter's active codes."""
        interp = self.interp
        version = interp.modal_version, interp.state.motion  # a plain move changes nothing but its own code
        if version != self._modal_version:
            self._modal_version = version
            self._modes = Modes(interp.active_g_codes(), interp.active_m_codes(), interp.active_settings())
        return self._modes

    def _reached_end(self) -> None:
        self.canon.flush()
        self.at_end = True

    def stop_reading(self) -> None:
        """The rest of the program cannot be read; what is queued will still be done."""
        self.canon.flush()
        self.at_end = True
        self.waiting_for_synch = False

    def finish(self) -> None:
        """Everything that was read is done: nothing is under way any more."""
        self._last_line = self.program_line
        self.source = Source.NOTHING
        self.waiting_for_synch = False
        self.must_synch |= self.canon.tool_data_changed or self.canon.coords.units != self._units

    # --- Agreement with the machine

    def _quiet(self) -> bool:
        canon = self.canon
        return self.sequencer.idle and canon.motion.settled and canon.io.done

    def synch(self) -> None:
        """The interpreter takes over position, tool and spindle from the machine, which must stand still."""
        self.interp.synch()
        self.waiting_for_synch = False
        self.must_synch = self.canon.tool_data_changed = False
        self._units = self.canon.coords.units
        restore, self._restore = self._restore, None
        if restore is not None:
            self._bring_back(restore)
            self._offsets = standing.read_offsets(self.interp)

    def _bring_back(self, place: Block) -> None:
        """The modes and offsets of ``place`` are in force again; the operator is told what cannot be."""
        tolerance_set = self.canon.tolerance_set
        for line in standing.blocks(place, self.canon):
            try:
                self.interp.execute_mdi(line)
            except InterpError as error:
                self.sequencer.hooks.show_text(f"after the abort {line} is not in force again: {error.message}")
        self.canon.tolerance_set = tolerance_set
        if place.modes is not None:
            standing.set_motion(self.interp, place.modes)
        self.interp.synch()

    def abort(self, place: Block | None) -> None:
        """Unwind everything; the interpreter must synchronise before it is used again, as it was at ``place``."""
        self._restore = place or self._restore
        self.canon.forget()
        self.interp.abort()
        if self.dry_run is not None:
            self.dry_run.leave()
            self.dry_run = None
        if self._restore is not None:
            standing.write_offsets(self.interp, self._restore.offsets)
        self.canon.forget()
        self.finish()
        self.forget_line()
        self.must_synch = True

    def block_in_execution(self) -> Block | None:
        """The block that the machine is at: of the move under way, else of the last entry executed; None: idle."""
        if self.dry_run is not None:
            return self._before
        if not self.active:
            return None
        motion = self.canon.motion
        place = None if motion.settled else self.canon.places.find(motion.status.id)
        return place.block if place is not None else self.sequencer.current_block or self._before

    def reset(self, startup_code: str) -> None:
        """Back to the modes after the start, with no program loaded; PyemcError when the code is wrong."""
        self.close()
        self.interp.restart()
        self.startup(startup_code)
        self._offsets = standing.read_offsets(self.interp)
        self.must_synch = True

    def startup(self, code: str) -> None:
        """Run [RS274NGC]RS274NGC_STARTUP_CODE; PyemcError when it is wrong."""
        if code:
            self.interp.execute_mdi(code)
        self.canon.flush()

    def save_parameters(self) -> None:
        """Write the parameter file, if there is one."""
        self.interp.save_parameters()

    def describe(self, error: Exception) -> str:
        """An interpreter's error for the operator: ``file:line:column: message``; of a typed line the message."""
        if not isinstance(error, InterpError):
            return str(error)
        self.interpreter_code = INTERP_ERROR
        if error.place is None and self.source is Source.PROGRAM:
            return f"{self.file}:{self.interp.line}: {error.message}"
        typed = error.place is not None and error.place.file == TYPED
        return error.message if typed else str(error)
