"""A canon that writes down calls instead of making them: compensation holds back a move, and what follows it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rs274ngc.canon import Canon

ASKS = ("get_", "wait", "user_command_exists")


class HeldCanon(Canon):
    """Keeps calls in ``held`` as (name, arguments) for its owner to make; questions go to the real canon at once."""

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


def asking(name: str) -> Callable[..., Any]:
    """A method that passes a question on."""

    def method(self: HeldCanon, *arguments: Any) -> Any:
        return getattr(self.canon, name)(*arguments)

    return method


for _name in dir(Canon):
    if callable(getattr(Canon, _name)) and not _name.startswith("_"):
        setattr(HeldCanon, _name, asking(_name) if _name.startswith(ASKS) else holding(_name))
