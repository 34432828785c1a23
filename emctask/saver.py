"""Writes the parameter file in a thread of its own: a slow disk never holds up a program."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable

from nml.errors import PyemcError

log = logging.getLogger(__name__)


class Saver:
    """Calls ``save`` soon after it was asked to; several wishes in a row become one write."""

    def __init__(self, save: Callable[[], None]) -> None:
        self._save = save
        self._wanted = threading.Event()
        self._closing = False
        self.failure = ""
        self._thread = threading.Thread(target=self._run, name="parameters", daemon=True)
        self._thread.start()

    def request(self) -> None:
        """Write soon; returns at once."""
        self._wanted.set()

    def take_failure(self) -> str:
        """Why the last write failed; empty if it did not, or was told already."""
        failure, self.failure = self.failure, ""
        return failure

    def close(self, timeout_s: float = 5.0) -> None:
        """Write once more and end the thread."""
        self._closing = True
        self._wanted.set()
        self._thread.join(timeout_s)

    def _run(self) -> None:
        while not self._closing:
            self._wanted.wait()
            self._wanted.clear()
            try:
                self._save()
            except (OSError, PyemcError) as error:
                self.failure = f"the parameter file cannot be written: {error}"
                log.warning("%s", self.failure)
