"""The text of the loaded program, by lines: an index of where they begin, so that a million lines cost no memory."""

from __future__ import annotations

import mmap
from pathlib import Path
from typing import Any

import numpy as np

from gui.web.calls import CallError
from gui.web.programfolder import version_of

MOST_LINES = 2000  # of one answer
LONGEST_LINE = 4096  # bytes that are shown of a line


class ProgramText:
    """One file as it was when it was indexed."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.version = version_of(path)
        self.size = path.stat().st_size
        self.mtime = path.stat().st_mtime
        self._starts = _line_starts(path)

    @property
    def total(self) -> int:
        return len(self._starts) - 1

    def lines(self, first: int, count: int) -> list[str]:
        """Up to `MOST_LINES` lines from ``first`` (1-based); CallError when the file has changed."""
        if version_of(self.path) != self.version:
            raise CallError("conflict", "{path} was changed meanwhile", path=self.path.name, version=None)
        begin = min(max(first, 1), self.total + 1) - 1
        end = min(begin + max(0, min(count, MOST_LINES)), self.total)
        with self.path.open("rb") as file:
            file.seek(int(self._starts[begin]))
            data = file.read(int(self._starts[end] - self._starts[begin]))
        offset = int(self._starts[begin])
        found = []
        for number in range(begin, end):
            raw = data[int(self._starts[number]) - offset : int(self._starts[number + 1]) - offset]
            found.append(raw[:LONGEST_LINE].rstrip(b"\r\n").decode("utf-8", "replace"))
        return found

    def card(self, relative: str | None) -> dict[str, Any]:
        """What the state says of it."""
        return {
            "file": str(self.path), "path": relative, "name": self.path.name, "size": self.size, "lines": self.total,
            "mtime": self.mtime, "version": self.version, "writable": relative is not None,
        }  # fmt: skip


def _line_starts(path: Path) -> Any:
    """Where each line begins, and where the last one ends."""
    size = path.stat().st_size
    if size == 0:
        return np.zeros(1, np.int64)
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as view:
        data = np.frombuffer(view, np.uint8)
        ends = np.flatnonzero(data == 10) + 1
        del data
        starts = np.concatenate(([0], ends)).astype(np.int64)
    return starts if starts[-1] == size else np.append(starts, size)
