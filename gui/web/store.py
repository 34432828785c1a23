"""Small files of the display: the MDI history, as LinuxCNC's screens keep it, and the preferences."""

from __future__ import annotations

import contextlib
import json
import logging
from pathlib import Path
from typing import Any

from gui.web.calls import CallError
from gui.web.programfolder import replace_file

log = logging.getLogger(__name__)

LINES_KEPT = 1000
LONGEST_PREFERENCES = 256 << 10  # bytes


class MdiHistory:
    """The MDI lines of the operators, oldest first, one a line in a file."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self.lines: list[str] = []
        with contextlib.suppress(OSError):
            text = path.read_text("utf-8", "replace")
            self.lines = [line for line in text.splitlines() if line.strip()][-LINES_KEPT:]

    def add(self, line: str) -> None:
        """Remember a line; the same one twice in a row counts once."""
        if self.lines[-1:] != [line]:
            self.lines = [*self.lines, line][-LINES_KEPT:]
            self._save()

    def clear(self) -> None:
        self.lines = []
        self._save()

    def _save(self) -> None:
        try:
            replace_file(self._path, "".join(f"{line}\n" for line in self.lines).encode())
        except CallError as reason:
            log.warning("the MDI history is not kept: %s", reason.text.format(**reason.more))


class Preferences:
    """What people set in the page and want to find again: a map in a JSON file."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self.values: dict[str, Any] = {}
        with contextlib.suppress(OSError, ValueError):
            found = json.loads(path.read_text("utf-8"))
            if isinstance(found, dict):
                self.values = found

    def change(self, values: dict[str, Any]) -> None:
        """Take changes over; null removes a key."""
        merged = {**self.values, **values}
        merged = {key: value for key, value in merged.items() if value is not None}
        try:
            data = json.dumps(merged, indent=1, sort_keys=True).encode()
        except (TypeError, ValueError):
            raise CallError("argument", "{argument} cannot be kept", argument="values") from None
        if len(data) > LONGEST_PREFERENCES:
            raise CallError("argument", "{argument} is too large", argument="values")
        replace_file(self._path, data)
        self.values = merged
