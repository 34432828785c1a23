"""What mb2hal tells of its work, in LinuxCNC's form: ``mb2hal PART KIND: text``; errors go to standard error."""

from __future__ import annotations

import sys
from dataclasses import dataclass

ERRORS, CONFIRMATIONS, DETAILS = 1, 2, 3
"""The levels of INIT_DEBUG and DEBUG: each includes those below it, 0 is silent."""
KINDS = {ERRORS: "ERR", CONFIRMATIONS: "OK", DETAILS: "DEBUG"}


@dataclass(slots=True)
class Trace:
    """Prints what its level includes."""

    level: int = ERRORS

    def tell(self, level: int, part: str, text: str) -> None:
        """A line of this level."""
        if level <= self.level:
            out = sys.stderr if level == ERRORS else sys.stdout
            print(f"mb2hal {part} {KINDS[level]}: {text}", file=out, flush=True)

    def ok(self, part: str, text: str) -> None:
        """Something is done."""
        self.tell(CONFIRMATIONS, part, text)

    def detail(self, part: str, text: str) -> None:
        """For whoever looks for a fault."""
        self.tell(DETAILS, part, text)

    def error(self, part: str, text: str) -> None:
        """Something failed."""
        self.tell(ERRORS, part, text)
