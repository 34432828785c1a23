"""Messages for the operator: a history that every client sees whole, and the log file of [DISPLAY]LOG_FILE."""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

log = logging.getLogger(__name__)

KEPT = 1000
IN_HELLO = 200
KINDS = {1: "error", 2: "text", 3: "display", 11: "error", 12: "text", 13: "display"}


class Messages:
    """The messages since the server's start."""

    def __init__(self, log_file: Path | None, tell: Callable[[dict[str, Any]], None]) -> None:
        self._kept: deque[dict[str, Any]] = deque(maxlen=KEPT)
        self._log_file = log_file
        self._tell = tell
        self._next = 1

    def add(self, kind: str, text: str, serial: int = 0) -> None:
        """Keep a message and show it to everybody."""
        message = {"id": self._next, "kind": kind, "text": text, "time": time.time(), "serial": serial}
        self._next += 1
        self._kept.append(message)
        self._write(kind, text)
        self._tell(message)

    def newest(self, count: int = IN_HELLO, before: int | None = None) -> list[dict[str, Any]]:
        """Up to ``count`` messages, oldest first; those older than ``before``."""
        older = [message for message in self._kept if before is None or message["id"] < before]
        return older[-count:] if count > 0 else []

    def _write(self, kind: str, text: str) -> None:
        if self._log_file is None:
            return
        try:
            with self._log_file.open("a", encoding="utf-8") as file:
                file.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')} {kind}: {' '.join(text.split())}\n")
        except OSError as reason:
            log.warning("%s cannot be written: %s", self._log_file, reason.strerror)
            self._log_file = None
