"""Where a move came from: the way back from motion's id to file, line, call level and the modal codes in force."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

CONTINUOUS, INVERSE_TIME = 640, 930
PLANES = (170, 171, 180, 181, 190, 191)
LENGTHS = (200, 210, 900, 910, 901, 911, 70, 80)
FEEDS = (INVERSE_TIME, 940, 950, 980, 990)
SYSTEMS = (540, 550, 560, 570, 580, 590, 591, 592, 593)
PATHS = (610, 611, CONTINUOUS)
RESTORABLE = frozenset((*PLANES, *LENGTHS, *FEEDS, *SYSTEMS, *PATHS))
"""G codes times ten that an abort brings back; motion, compensation and tool length are not modes to come back to."""


Calls = tuple[tuple[str, str, int], ...]
"""The subroutine calls under way, the outermost first: what is called, file of the call, its line."""


class Modes(NamedTuple):
    """The interpreter's active codes at some place of the program."""

    g_codes: tuple[int, ...]
    m_codes: tuple[int, ...]
    settings: tuple[float, ...]

    @property
    def line(self) -> int:
        """The line of the block after which they were in force."""
        return self.g_codes[0] if self.g_codes else 0

    def as_block(self) -> str:
        """A line that brings these modes back: plane, units, distance, feed, coordinate system, path, F and S."""
        codes = [code for code in self.g_codes[1:] if code in RESTORABLE]
        words = [f"G{code // 10}" if code % 10 == 0 else f"G{code / 10:.1f}" for code in codes]
        feed, speed, path, naive = self.settings[1:5]
        if CONTINUOUS in codes:
            words += [f"P{path:.9g}"] if path else []
            words += [f"Q{naive:.9g}"] if path or naive else []
        if feed and INVERSE_TIME not in codes:
            words.append(f"F{feed:.9g}")
        if speed:
            words.append(f"S{speed:.9g}")
        return " ".join(words)


class Block:
    """One block of a program, and what is in force after it; until it has been executed, what was before it."""

    __slots__ = ("calls", "file", "modes", "offsets", "tool_offset")

    def __init__(self, file: str, calls: Calls = (), before: Block | None = None) -> None:
        self.file = file
        self.calls = calls
        self.modes: Modes | None = before.modes if before else None
        self.offsets: tuple[float, ...] = before.offsets if before else ()
        """The parameters of ``emctask.standing.STORED``."""
        self.tool_offset: tuple[float, ...] = before.tool_offset if before else ()
        """X to W, machine units."""


class Place(NamedTuple):
    """The origin of one move."""

    line: int
    block: Block


class Places:
    """Ids grow by one with each move; the origins of moves that are over are forgotten."""

    def __init__(self) -> None:
        self._first = 1
        self._places: deque[Place] = deque()

    def new_id(self, place: Place) -> int:
        """The id of the next move."""
        self._places.append(place)
        return self._first + len(self._places) - 1

    def find(self, move: int) -> Place | None:
        """Where a move came from; None for a move that is over or never was."""
        index = move - self._first
        return self._places[index] if 0 <= index < len(self._places) else None

    def at(self, executing: int) -> Place | None:
        """Where the executing move came from; forgets those before it."""
        places = self._places
        while places and self._first < executing:
            places.popleft()
            self._first += 1
        return self.find(executing)

    def forget(self) -> None:
        """No move is on the way any more; ids go on."""
        self._first += len(self._places)
        self._places.clear()
