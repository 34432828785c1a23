"""A canon that writes down calls instead of making them: compensation holds back a move, and what follows it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rs274ngc.canon import Canon

AT_ONCE = (
    "get_", "wait", "user_command_exists", "message", "print_text", "log", "select_plane", "select_tool",
    "set_tool_table_entry", "use_length_units",
)  # fmt: skip
"""How the calls begin that need not wait for a move: questions, words to the operator, what only prepares;
and the unit of length, to which what is held is converted."""


class HeldCanon(Canon):
    """Keeps calls in ``held`` as (name, arguments) for its owner to make; ``AT_ONCE`` goes to the real canon."""

    def __init__(self, canon: Canon) -> None:
        self.canon = canon
        self.held: list[Any] = []
        self.is_task = canon.is_task


def holding(name: str) -> Callable[..., None]:
    """A method that writes down its call while a move is held."""

    def method(self: HeldCanon, *arguments: Any) -> None:
        if self.held:
            self.held.append((name, arguments))
        else:
            getattr(self.canon, name)(*arguments)

    return method


def passing(name: str) -> Callable[..., Any]:
    """A method that makes its call at once."""

    def method(self: HeldCanon, *arguments: Any) -> Any:
        return getattr(self.canon, name)(*arguments)

    return method


for _name in dir(Canon):
    if callable(getattr(Canon, _name)) and not _name.startswith("_"):
        setattr(HeldCanon, _name, passing(_name) if _name.startswith(AT_ONCE) else holding(_name))
