"""``[HAL]TWOPASS``: HAL files that may each load the same component are read twice.

In pass 0 ``loadrt`` and ``loadusr`` lines are gathered from all files and executed together at its end: ``names=`` are
joined, counts are added. In pass 1 the files are read again and everything else is executed. A file with a line
``#NOTWOPASS`` takes part in pass 1 only, with its loads, and goes on after a failure.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from nml.errors import HalError

if TYPE_CHECKING:
    from hal.session import Session

LOADS = ("loadrt", "loadusr")
COUNTS = ("count", "num_chan")
LISTS = ("names", "cfg", "step_type", "ctrl_type", "output_type", "personality")
EXCLUDED = "#NOTWOPASS"


class Loads:
    """The load commands of pass 0, merged by module."""

    def __init__(self) -> None:
        self._modules: dict[str, dict[str, str]] = {}
        self._programs: list[list[str]] = []

    def add(self, words: list[str]) -> None:
        """Take a ``loadrt`` or ``loadusr`` command."""
        if words[0] == "loadusr":
            if words not in self._programs:
                self._programs.append(words)
            return
        module, *parameters = words[1:]
        merged = self._modules.setdefault(module, {})
        for parameter in parameters:
            key, _, value = parameter.partition("=")
            merged[key] = self._merge(module, key, merged.get(key), value)
        if "names" in merged and merged.keys() & set(COUNTS):
            raise HalError(f"TWOPASS: {module} is loaded both with names= and with a count")

    @staticmethod
    def _merge(module: str, key: str, old: str | None, new: str) -> str:
        if old is None:
            return new
        if key in COUNTS:
            return str(int(old, 0) + int(new, 0))
        if key not in LISTS:
            return new
        if key == "names" and set(old.split(",")) & set(new.split(",")):
            raise HalError(f"TWOPASS: {module} is loaded twice with a name of {new}")
        return f"{old},{new}"

    def commands(self) -> list[list[str]]:
        """What to execute at the end of pass 0: realtime modules, then programs."""
        loads = [
            ["loadrt", module, *(f"{key}={value}" for key, value in parameters.items())]
            for module, parameters in self._modules.items()
        ]
        return loads + self._programs


def excluded(path: Path) -> bool:
    """Whether a file keeps out of pass 0."""
    with open(path, encoding="utf-8", errors="replace") as file:
        return any(line.replace(" ", "").startswith(EXCLUDED) for line in file)


def run(session: Session, files: Sequence[tuple[Path, Sequence[str]]]) -> bool:
    """Run HAL files with their arguments in two passes; False where a command failed."""
    session.gathered = Loads()
    try:
        session.pass_number = 0
        if not all(session.run_file(path, words) for path, words in files if not excluded(path)):
            return False
        loads, session.gathered = session.gathered.commands(), None
        if not all(session.run_words(words) for words in loads):
            return False
        session.pass_number = 1
        for path, words in files:
            session.loads_done = not excluded(path)
            if not session.run_file(path, words) and session.loads_done:
                return False
        return True
    finally:
        session.gathered, session.pass_number, session.loads_done = None, -1, False
