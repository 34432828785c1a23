"""The words behind a command of linuxcncrsh turned into numbers and choices, and what is said where they make no sense.

The texts are LinuxCNC's. ``linuxcncrsh`` sends the text of a `Refused` as a line of its own before the refusal.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

import linuxcnc

AXES = "XYZABCUVW"
ALL = -1  # joint, axis or spindle number that means each of them

ON_OFF = {"ON": 1, "OFF": 0, "1": 1, "0": 0, "TRUE": 1, "FALSE": 0, "YES": 1, "NO": 0}
ON_OFF_SHOWN = "{on,off}"

_INTEGER = re.compile(r"[+-]?\d{1,9}", re.ASCII)
_WORD = re.compile(r"\S+")


class Refused(Exception):
    """A command is not understood or not allowed now; the text, if any, says why."""


@dataclass(frozen=True, slots=True)
class Arguments:
    """What stands behind a command: its words, and the same as it was written."""

    words: list[str]
    rest: str

    def __len__(self) -> int:
        return len(self.words)

    def integer(self, at: int, default: int) -> int:
        """A whole number; ``default`` where there is no such word."""
        if at >= len(self.words):
            return default
        if not _INTEGER.fullmatch(self.words[at]):
            raise Refused(f"Invalid argument '{self.words[at]}', must be integer")
        return int(self.words[at])

    def real(self, at: int, default: float = 0.0) -> float:
        """A finite number; ``default`` where there is no such word."""
        if at >= len(self.words):
            return default
        try:
            value = float(self.words[at])
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise Refused(f"Invalid argument '{self.words[at]}', must be floating point")
        return value

    def choice(self, at: int, choices: Mapping[str, int], shown: str = "") -> int:
        """The value of a word of a list; ``shown``: the list as the refusal gives it."""
        value = choices.get(self.words[at].upper())
        if value is None:
            shown = shown or f"{{{','.join(choices).lower()}}}"
            raise Refused(f"Invalid argument '{self.words[at]}', must be {shown}")
        return value

    def switch(self, at: int = 0) -> int:
        """1 for on, 0 for off, in any of the usual words."""
        return self.choice(at, ON_OFF, ON_OFF_SHOWN)

    def joint(self, at: int, status: linuxcnc.stat, *, least: int = ALL) -> int:
        """A joint of the machine, or one of the numbers from ``least`` to -1 with a meaning of their own."""
        number = self.integer(at, ALL)
        if not least <= number < status.joints:
            raise Refused(f"Invalid joint '{number}', valid range [{least},{status.joints - 1}]")
        return number

    def spindles(self, at: int, status: linuxcnc.stat, default: int = 0) -> list[int]:
        """The spindles meant by a number, or by -1."""
        if not status.spindles:
            raise Refused("no spindles configured")
        number = self.integer(at, default)
        if not ALL <= number < status.spindles:
            raise Refused(f"Invalid spindle '{number}', valid range [-1,{status.spindles - 1}]")
        return list(range(status.spindles)) if number == ALL else [number]

    def axis_letter(self, at: int) -> int:
        """The number of an axis given by its letter."""
        word = self.words[at].upper()
        if len(word) != 1 or word not in AXES:
            raise Refused(f"Invalid axis '{self.words[at]}', must be one of XYZABCUVW")
        return AXES.index(word)

    def is_number(self, at: int) -> bool:
        return bool(_INTEGER.fullmatch(self.words[at]))


def split(line: str) -> tuple[str, str, Arguments]:
    """Verb and command of a line, in capitals, and the arguments behind them."""
    found = list(_WORD.finditer(line))
    words = [match.group() for match in found]
    rest = line[found[2].start() :].rstrip() if len(found) > 2 else ""
    verb, name = (*(word.upper() for word in words[:2]), "", "")[:2]
    return verb, name, Arguments(words[2:], rest)
