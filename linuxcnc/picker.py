"""``linuxcnc`` without an INI file: a numbered list of the configurations on this computer, in the terminal.

It only prints lines and reads lines, so that any terminal will do. A number takes a configuration, other words narrow
the list; numbers stay the same whatever is shown.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

from nml.errors import PyemcError

OURS = Path(__file__).resolve().parents[1] / "configs"
PROMPT = "number, words to search for, Enter for the whole list, q to leave: "
LEAVE = ("q", "quit")


class NothingChosen(PyemcError):
    """No configuration was chosen; the text says why."""


@dataclass(frozen=True, slots=True)
class Offer:
    """One line of the list."""

    number: int
    path: Path

    @property
    def folder(self) -> Path:
        return self.path.parent

    def matches(self, words: Sequence[str]) -> bool:
        """Whether every word is in its path."""
        text = str(self.path).lower()
        return all(word.lower() in text for word in words)


def folders() -> list[Path]:
    """Where configurations are looked for: the person's own, the computer's, the samples that come with us."""
    return [Path.home() / "linuxcnc" / "configs", Path("/usr/local/etc/linuxcnc/configs"), OURS]


def offers(places: Sequence[Path]) -> list[Offer]:
    """All INI files below ``places``, grouped by folder, numbered from 1."""
    found = [path for place in places for path in sorted(place.rglob("*.ini"), key=lambda ini: (ini.parent, ini.name))]
    return [Offer(number, path) for number, path in enumerate(dict.fromkeys(found), 1)]


def has_terminal() -> bool:
    """Is there a person at a terminal?"""
    return sys.stdin.isatty() and sys.stdout.isatty()


def has_desktop() -> bool:
    """Is there a desktop, where a browser can be opened?"""
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def pick() -> Path:
    """Let the person at the terminal choose; NothingChosen without a terminal."""
    if not has_terminal():
        raise NothingChosen("no INI file named, and no terminal to choose one in; give linuxcnc INI, or linuxcnc -l")
    return choose(offers(folders()), input, print)


def choose(offered: Sequence[Offer], ask: Callable[[str], str], show: Callable[[str], object]) -> Path:
    """Show the list, narrow it, until one is chosen; NothingChosen when the person leaves."""
    if not offered:
        raise NothingChosen(f"no configuration in {', '.join(map(str, folders()))}; name an INI file: linuxcnc INI")
    by_number = {str(offer.number): offer for offer in offered}
    shown = list(offered)
    show(_listing(shown))
    while True:
        try:
            answer = ask(PROMPT).strip()
        except (EOFError, KeyboardInterrupt):
            raise NothingChosen("no configuration was chosen") from None
        if answer in by_number:
            return by_number[answer].path
        if answer.lower() in LEAVE:
            raise NothingChosen("no configuration was chosen")
        narrowed = [offer for offer in offered if offer.matches(answer.split())]
        if narrowed:
            shown = narrowed
        else:
            show(f"nothing has {answer!r} in its name")
        show(_listing(shown))


def _listing(shown: Sequence[Offer]) -> str:
    width = max(len(str(offer.number)) for offer in shown)
    lines = []
    for folder, group in groupby(shown, key=lambda offer: offer.folder):
        lines.append(str(folder))
        lines += [f"  {offer.number:{width}}  {offer.path.name}" for offer in group]
    return "\n".join(lines)
