"""User M-codes M100 to M199: finds the program ``Mnnn`` and runs it beside task, P and Q words as arguments."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from pathlib import Path

FIRST, LAST = 100, 199


def find_program(number: int, folders: Sequence[Path]) -> Path | None:
    """The first executable ``Mnnn`` in the folders; None: the machine has no such code."""
    if not FIRST <= number <= LAST:
        return None
    for folder in folders:
        path = folder / f"M{number}"
        if path.is_file() and os.access(path, os.X_OK):
            return path
    return None


class UserCommand:
    """One run of a user M-code."""

    def __init__(self, number: int, p: float, q: float, folders: Sequence[Path]) -> None:
        """Start it; FileNotFoundError or OSError when that does not work."""
        self.number = number
        program = find_program(number, folders)
        if program is None:
            looked = ", ".join(str(folder) for folder in folders)
            raise FileNotFoundError(f"M{number}: no executable M{number} in {looked}")
        self._process = subprocess.Popen([program, f"{p:f}", f"{q:f}"], stdin=subprocess.DEVNULL)

    def poll(self) -> int | None:
        """The exit code; None while it runs."""
        return self._process.poll()

    def stop(self) -> None:
        """Kill it, if it still runs."""
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()
