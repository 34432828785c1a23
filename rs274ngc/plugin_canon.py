"""The module ``emccanon`` that Python remaps import: LinuxCNC's canonical functions, done by the interpreter's canon.

Names in capitals are the methods of ``canon.Canon``; the few whose arguments differ are written out.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from types import ModuleType
from typing import Any

from rs274ngc import canon as canonical
from rs274ngc.canon import AXES, Canon
from rs274ngc.printer import PrintCanon

_current: list[Canon] = []


@contextmanager
def using(canon: Canon) -> Iterator[None]:
    """While a function runs, the canonical functions are this canon's."""
    _current.append(canon)
    try:
        yield
    finally:
        _current.pop()


def current() -> Canon:
    """The canon of the function that runs."""
    if not _current:
        raise RuntimeError("canonical functions can only be called from a remapped code")
    return _current[-1]


def write_out(canon: Canon) -> None:
    """What Python and a canon have printed so far leaves both, in the order in which it was printed."""
    sys.stdout.flush()
    if isinstance(canon, PrintCanon):
        canon.flush()


def calling(name: str) -> Any:
    """A function that calls the canon's method of this name."""

    def function(*arguments: Any) -> Any:
        canon = current()
        write_out(canon)
        result = getattr(canon, name)(*arguments)
        write_out(canon)
        return result

    function.__name__ = name.upper()
    return function


def change_tool(_index: int = 0) -> None:
    """CHANGE_TOOL(index): the canon knows the tool that was selected."""
    current().change_tool()


def enable_speed_override(spindle: int = 0) -> None:
    current().enable_speed_override(spindle)


def disable_speed_override(spindle: int = 0) -> None:
    current().disable_speed_override(spindle)


def set_spindle_speed(*arguments: float) -> None:
    """SET_SPINDLE_SPEED([spindle,] speed)"""
    spindle, speed = arguments if len(arguments) == 2 else (0, arguments[0])
    current().set_spindle_speed(int(spindle), speed)


def position_of(axis: int) -> Any:
    def function() -> float:
        return current().get_external_position()[axis]

    return function


SPECIAL = {
    "CHANGE_TOOL": change_tool,
    "ENABLE_SPEED_OVERRIDE": enable_speed_override,
    "DISABLE_SPEED_OVERRIDE": disable_speed_override,
    "SET_SPINDLE_SPEED": set_spindle_speed,
    "enqueue_SET_SPINDLE_SPEED": set_spindle_speed,
    "enqueue_SET_FEED_RATE": calling("set_feed_rate"),
    "CANON_ERROR": calling("error"),
    "PRINT": calling("print_text"),
    **{f"GET_EXTERNAL_POSITION_{letter}": position_of(axis) for axis, letter in enumerate(AXES)},
}


@cache
def module() -> ModuleType:
    """The module."""
    made = ModuleType("emccanon", __doc__)
    for name in dir(Canon):
        if not name.startswith("_") and callable(getattr(Canon, name)):
            setattr(made, name.upper(), calling(name))
    made.__dict__.update({name: value for name, value in vars(canonical).items() if name.startswith("CANON_")})
    made.__dict__.update(SPECIAL)
    return made
