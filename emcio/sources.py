"""Where tools come from and go to: the table file, nothing, or a program that keeps a data base."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from emcio.saver import Saver
from emcio.toolstore import ToolStore
from emcio.tooltable import Tool, ToolFile


class ToolSource(Protocol):
    """What the controller needs of a source."""

    def load(self, store: ToolStore, path: str = "") -> list[str]:
        """Fill the store, from the named file if there is a name; what was left out, and why.

        ConfigError, store unchanged, when there is nothing to read.
        """

    def reload(self, store: ToolStore, path: str = "") -> list[str]:
        """As ``load``, at the operator's wish; may leave it to ``arrived``."""

    def arrived(self, store: ToolStore) -> list[str] | None:
        """What was left out of tools that came after ``reload`` and are in the store now; None: none came."""

    def save(self, store: ToolStore) -> None:
        """Pockets or values have changed; returns at once."""

    def put(self, tool: Tool) -> None:
        """One tool got new values."""

    def spindle(self, letter: str, toolno: int, pocket: int) -> None:
        """A tool was loaded (``l``) or unloaded (``u``)."""

    @property
    def busy(self) -> bool:
        """Is something not yet saved?"""

    def failure(self) -> str | None:
        """What went wrong since the last question."""

    def close(self) -> None:
        """Finish everything."""


class NoTools:
    """A machine without a tool table."""

    busy = False

    def load(self, store: ToolStore, path: str = "") -> list[str]:
        """Nothing to read, unless a file is named."""
        if not path:
            return []
        table = ToolFile(path)
        return table.remarks + store.load(table.tools, table)

    reload = load

    def arrived(self, store: ToolStore) -> None:
        """Nothing comes late."""

    def save(self, store: ToolStore) -> None:
        """Nowhere to write to."""

    def put(self, tool: Tool) -> None:
        """Nobody to tell."""

    def spindle(self, letter: str, toolno: int, pocket: int) -> None:
        """Nobody to tell."""

    def failure(self) -> str | None:
        """Nothing goes wrong."""
        return None

    def close(self) -> None:
        """Nothing to finish."""


class FileTools:
    """[EMCIO]TOOL_TABLE: read when asked, written in a thread of its own."""

    def __init__(self, path: Path) -> None:
        self._file = ToolFile(path)
        self._saver = Saver(path)

    def load(self, store: ToolStore, path: str = "") -> list[str]:
        """Read the table anew; a named file is read in its place, but the table is still saved to its own."""
        table = ToolFile(path or self._file.path)
        remarks = table.remarks + store.load(table.tools, table)
        if not path or Path(path).resolve() == self._file.path.resolve():
            self._file = table
        return remarks

    reload = load

    def arrived(self, store: ToolStore) -> None:
        """Nothing comes late."""

    def save(self, store: ToolStore) -> None:
        """Write every value that changed."""
        text = self._file.render(store.listed())
        self._file.adopt(text)
        self._saver.save(text)

    def put(self, tool: Tool) -> None:
        """The file is written as a whole by ``save``."""

    def spindle(self, letter: str, toolno: int, pocket: int) -> None:
        """A file does not know the spindle, except as pocket 0 of a random changer, which ``save`` writes."""

    @property
    def busy(self) -> bool:
        """Is a write under way?"""
        return self._saver.busy

    def failure(self) -> str | None:
        """Why the file could not be written."""
        return self._saver.failure()

    def close(self) -> None:
        """Wait for the last write."""
        self._saver.close()
