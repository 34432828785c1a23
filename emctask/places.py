"""Where a move came from: the way back from motion's id to file, line, call level and the modal codes in force."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple


class Modes(NamedTuple):
    """The interpreter's active codes at some place of the program."""

    g_codes: tuple[int, ...]
    m_codes: tuple[int, ...]
    settings: tuple[float, ...]


class Block:
    """One block of the program that made moves; its codes are known when it has been executed."""

    __slots__ = ("file", "level", "modes")

    def __init__(self, file: str, level: int) -> None:
        self.file = file
        self.level = level
        self.modes: Modes | None = None


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
