"""Writes the tool table in a thread of its own, so that a slow disk never holds up the E-stop chain."""

from __future__ import annotations

import threading
from pathlib import Path

from emcio.tooltable import replace_file


class Saver:
    """Writes the newest text it was given; texts that were overtaken are skipped."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._text: str | None = None
        self._change = threading.Condition()
        self._busy = False
        self._closing = False
        self._failure: str | None = None
        self._thread = threading.Thread(target=self._run, name="tool table", daemon=True)
        self._thread.start()

    def save(self, text: str) -> None:
        """Ask for ``text`` to be written; returns at once."""
        with self._change:
            self._text = text
            self._busy = True
            self._change.notify_all()

    @property
    def busy(self) -> bool:
        """Is something not yet on the disk?"""
        return self._busy

    def failure(self) -> str | None:
        """Why the last write failed, told once."""
        with self._change:
            failure, self._failure = self._failure, None
        return failure

    def close(self, timeout_s: float = 5.0) -> None:
        """Finish what was asked for and end the thread."""
        with self._change:
            self._closing = True
            self._change.notify_all()
        self._thread.join(timeout_s)

    def _run(self) -> None:
        while True:
            with self._change:
                while self._text is None and not self._closing:
                    self._change.wait()
                text, self._text = self._text, None
            if text is None:
                return
            failure = None
            try:
                replace_file(self._path, text)
            except OSError as error:
                failure = f"{self._path}: the tool table cannot be written: {error.strerror}"
            with self._change:
                self._failure = failure or self._failure
                self._busy = self._text is not None
