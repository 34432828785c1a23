"""Executes HAL commands: from a file, a command line or a terminal. ``halcmd``, ``halrun`` and the launcher use it."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

from hal import commands, loadusr
from hal.client import HostClient
from hal.core import Hal, suggest
from hal.halfile import logical_lines, substitute, words
from hal.twopass import LOADS, Loads
from nml.errors import ConfigError, HalError, Place, PyemcError
from nml.inifile import IniFile


class Quit(Exception):
    """``quit`` was executed."""


class Session:
    """One user's commands against the HAL of this namespace; ``close`` when done."""

    def __init__(self, ini: IniFile | None = None, keep_going: bool = False, script: bool = False) -> None:
        self.hal = Hal()
        self.host = HostClient(self.hal)
        self.ini = ini
        self.keep_going = keep_going
        self.script = script
        self.verbosity = 1  # 0 nothing, 1 errors, 2 results too
        self.echo = False
        self.errors = 0
        self.pass_number = -1  # of TWOPASS processing: 0, 1; -1 without
        self.gathered: Loads | None = None  # load commands of pass 0
        self.loads_done = False  # in pass 1
        self.programs: list[int] = []  # started by loadusr and not waited for
        self.place = Place("<commandline>")
        self._running: list[str] = []  # the files that are being executed, each sourced by the one before
        self.comp = self.hal.add_component(f"halcmd{os.getpid()}")
        self.comp.ready = True

    def close(self) -> None:
        if self.hal.segment.attached:
            if self.comp.exists:
                self.hal.remove_component(self.comp)
            self.host.close()
            self.hal.close()

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()

    # ---- where commands come from ----

    def run_file(self, path: Path | str, arguments: Sequence[str] = ()) -> bool:
        """All of a HAL or Tcl file; False where a command failed. ConfigError if it cannot be read."""
        if str(path).endswith(".tcl"):
            from hal.haltcl import run_file

            return run_file(self, str(path), list(arguments)) == 0
        try:
            with open(path, encoding="utf-8-sig", errors="surrogateescape") as file:
                return self.run_lines(file, str(path))
        except OSError as error:
            raise ConfigError(f"cannot read the HAL file: {error.strerror}", Place(str(path))) from None

    def run_lines(self, lines: TextIO, name: str) -> bool:
        """Each line as a command; stops at the first that fails unless told to keep going."""
        outer, fine = self.place, True
        self._running.append(os.path.realpath(name))
        for number, line in logical_lines(lines):
            self.place = Place(name, number)
            if not self.run_line(line):
                fine = False
                if not self.keep_going:
                    break
        self._running.pop()
        self.place = outer
        return fine

    def run_line(self, line: str) -> bool:
        """One command as a line of text."""
        if self.echo and line.strip():
            print(f"({self.place.line})<echo>: {line}", file=sys.stderr)
        try:
            self.execute(words(line, self.ini))
        except PyemcError as error:
            self.report(error)
            return False
        return True

    def run_words(self, arguments: list[str]) -> bool:
        """One command as the shell split it."""
        try:
            self.execute([substitute(word, self.ini) for word in arguments])
        except PyemcError as error:
            self.report(error)
            return False
        return True

    def report(self, error: Exception) -> None:
        """One line, with the place, on standard error."""
        self.errors += 1
        if self.verbosity > 0:
            sys.stdout.flush()
            where = str(self.place) if self.place.line else f"{self.place.file}:0"
            print(f"{where}: {error}", file=sys.stderr, flush=True)

    # ---- what they do ----

    def execute(self, given: list[str]) -> None:
        """Execute one command that has been split; HalError says why it cannot be done."""
        if not given:
            return
        if len(given) >= 2 and given[1] == "=":
            given = ["setp", given[0], *given[2:]]
        name, *args = given
        command = commands.TABLE.get(name)
        if command is None:
            raise HalError(f"Unknown command '{name}'{_meant(name)}")
        command.check(name, args)
        if self._left_out(given):
            return
        command.run(self, args)
        if self.verbosity > 1:
            print(f"{name} done: {' '.join(args)}")

    def _left_out(self, given: list[str]) -> bool:
        """Whether TWOPASS keeps this command from being executed in this pass."""
        if self.gathered is not None:
            if given[0] in LOADS:
                self.gathered.add(given)
            return given[0] != "source"
        return self.loads_done and given[0] in LOADS

    def source(self, path: str) -> None:
        """``source``: a file beside the current one, or in the library with ``LIB:``."""
        found = find_hal_file(path, [Path(self.place.file).parent])
        if found is None:
            raise HalError(f"Could not open hal file '{path}'")
        if os.path.realpath(found) in self._running:
            raise HalError(f"'{path}' is being executed already; a file cannot source itself")
        if not self.run_file(found):
            raise HalError(f"'{path}' failed")

    def teardown(self) -> None:
        """End the session for everybody: stop the threads, end user components, then the realtime host."""
        self.hal.segment.locks = 0
        self.hal.halt_threads()
        commands.unload_all(self)
        loadusr.end_programs(self.programs)


def _meant(name: str) -> str:
    """What somebody may have wanted who gave an unknown command."""
    pin, equals, value = name.partition("=")
    if pin and equals:
        return f"; '{pin} = {value}' would be right"
    if " " in name:
        return "; quotes make one word of a command and its arguments"
    return suggest(name.lower(), commands.TABLE)


def library_dirs() -> list[Path]:
    """Folders of HAL files that ``LIB:`` names and that are looked through last: HALLIB_PATH, ours, LinuxCNC's."""
    ours = Path(__file__).resolve().parent / "hallib"
    given = [Path(part) for part in os.environ.get("HALLIB_PATH", "").split(os.pathsep) if part and part != "."]
    return [path for path in (*given, ours, Path("/usr/share/linuxcnc/hallib")) if path.is_dir()]


def find_hal_file(name: str, folders: list[Path]) -> Path | None:
    """A HAL file by the rules of ``[HAL]HALFILE``: beside the INI file (``folders``), then the library; or None."""
    library_only = name.startswith("LIB:")
    plain = name.removeprefix("LIB:")
    places = library_dirs() if library_only else [*folders, Path(), *library_dirs()]
    for place in places:
        if os.path.isfile(place / plain):  # not Path.is_file, which raises for a name that is too long
            return place / plain
    return None
