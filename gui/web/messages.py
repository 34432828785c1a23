"""Messages for the operator: a history that every client sees whole, and the log file of [DISPLAY]LOG_FILE."""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from gui.web import texts

log = logging.getLogger(__name__)

KEPT = 1000
IN_HELLO = 200
KINDS = {1: "error", 2: "text", 3: "display", 11: "error", 12: "text", 13: "display"}


NOTICE = "notice"  # of the display itself, in each client's language


@dataclass(frozen=True, slots=True)
class Message:
    """One message; a notice has {places} that ``values`` fill in after translation."""

    id: int
    kind: str
    text: str
    time: float  # s since the epoch
    serial: int  # of the order that it is about, or 0
    values: dict[str, Any] = field(default_factory=dict)

    def words(self, language: str) -> str:
        """What it says; the machine's own words are left as they are."""
        return texts.fill(language, self.text, self.values) if self.kind == NOTICE else self.text

    def frame(self, language: str) -> dict[str, Any]:
        """As a page gets it."""
        words = self.words(language)
        return {"id": self.id, "kind": self.kind, "text": words, "time": self.time, "serial": self.serial}


class Messages:
    """The messages since the server's start."""

    def __init__(self, log_file: Path | None, tell: Callable[[Message], None]) -> None:
        self._kept: deque[Message] = deque(maxlen=KEPT)
        self._log_file = log_file
        self._tell = tell
        self._next = 1

    def add(self, kind: str, text: str, serial: int = 0) -> None:
        """Keep a message of the machine and show it to everybody."""
        self._keep(Message(self._next, kind, text, time.time(), serial))

    def notice(self, text: str, **values: Any) -> None:
        """Keep a notice of the display and show it to everybody."""
        self._keep(Message(self._next, NOTICE, text, time.time(), 0, values))

    def _keep(self, message: Message) -> None:
        self._next += 1
        self._kept.append(message)
        self._write(message.kind, message.words(texts.ENGLISH))
        self._tell(message)

    def newest(self, language: str, count: int = IN_HELLO, before: int | None = None) -> list[dict[str, Any]]:
        """Up to ``count`` messages, oldest first; those older than ``before``."""
        older = [message for message in self._kept if before is None or message.id < before]
        return [message.frame(language) for message in older[-count:]] if count > 0 else []

    def _write(self, kind: str, text: str) -> None:
        if self._log_file is None:
            return
        try:
            with self._log_file.open("a", encoding="utf-8") as file:
                file.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')} {kind}: {' '.join(text.split())}\n")
        except OSError as reason:
            log.warning("%s cannot be written: %s", self._log_file, reason.strerror)
            self._log_file = None
