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
        """What is to be told; a failure that lasts is told once."""
        self._last = ""  # the failure of the last write
        self._thread = threading.Thread(target=self._run, name="parameters", daemon=True)
        self._thread.start()

    def request(self) -> None:
        """Write soon; returns at once."""
        self._wanted.set()

    def take_failure(self) -> str:
        """Why a write failed; empty if none did, or that was told already."""
        failure, self.failure = self.failure, ""
        return failure

    def close(self, timeout_s: float = 5.0) -> None:
        """Write once more and end the thread; a failure that nobody can take any more is logged."""
        self._closing = True
        self._wanted.set()
        self._thread.join(timeout_s)
        if self.failure:
            log.warning("%s", self.take_failure())

    def _run(self) -> None:
        while not self._closing:
            self._wanted.wait()
            self._wanted.clear()
            failure = ""
            try:
                self._save()
            except (OSError, PyemcError) as error:
                failure = str(error)
            if failure != self._last:
                self._last = self.failure = failure
