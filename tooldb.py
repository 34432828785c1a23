"""``import tooldb``: for a program that keeps the tools, [EMCIO]DB_PROGRAM, with the names of LinuxCNC's module.

    tooldb_tools([1, 2, 3])                           the tools that there are
    tooldb_callbacks(get, put, load, unload)
    tooldb_loop()                                     until the controller ends

``get(number)`` returns the tool's line of a tool table. ``put(number, line)`` gets new values, ``load(number, line)``
and ``unload(number, line)`` learn what went into the spindle and out of it. A function that raises is a complaint,
which the operator reads. Standard output belongs to the controller; a program tells things on standard error.
"""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Iterable

VERSION = "v2.1"
Told = Callable[[int, str], object]

_numbers: list[int] = []
_get: list[Callable[[int], str]] = []
_told: dict[str, Told] = {}


def tooldb_tools(tool_list: Iterable[int]) -> None:
    """The numbers of all tools, from now on."""
    _numbers[:] = tool_list


def tooldb_callbacks(
    tool_getter: Callable[[int], str], tool_putter: Told, spindle_loader: Told, spindle_unloader: Told
) -> None:
    """What answers the controller."""
    _get[:] = [tool_getter]
    _told.update(p=tool_putter, l=spindle_loader, u=spindle_unloader)


def tooldb_loop() -> None:
    """Answer the controller until it ends."""
    if not _get:
        raise RuntimeError("tooldb_callbacks() comes before tooldb_loop()")
    _reply(VERSION)
    for line in sys.stdin:
        try:
            _obey(line)
        except Exception as error:  # whatever the program's own functions raise
            traceback.print_exc()
            _reply(f"NAK {type(error).__name__}: {error}".replace("\n", " "))


def _obey(line: str) -> None:
    letter, _, rest = line.strip().partition(" ")
    if letter == "g":
        for text in [_get[0](number) for number in _numbers]:
            _reply(text)
        _reply("FINI")
        return
    if letter not in _told:
        raise ValueError(f"{line.strip()!r} is no command; g, p, l and u are")
    _told[letter](_number(rest), rest)
    _reply(f"OK {line.strip()}")


def _number(line: str) -> int:
    for word in line.upper().split():
        if word.startswith("T"):
            return int(word[1:])
    raise ValueError(f"{line!r} names no tool")


def _reply(text: str) -> None:
    print(text, flush=True)
