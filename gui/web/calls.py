"""What clients may ask for: a table of methods, each with the right that it needs and arguments that are checked.

A method is an async function of a `Caller` and keyword arguments; its annotations say which arguments it takes:

    @method("coolant.flood", Right.CONTROLS)
    async def flood(caller: Caller, on: bool) -> None: ...

An unwanted, missing or wrong argument is a `CallError` that names it; the function only ever sees good ones.
"""

from __future__ import annotations

import enum
import inspect
import math
import types
import typing
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gui.web.client import Client
    from gui.web.server import Server

LONGEST_TEXT = 16_000_000  # characters of an argument


class Right(enum.Enum):
    """What a method asks of its caller."""

    ANYBODY = "anybody"
    OPERATOR = "operator"
    CONTROLS = "controls"


class CallError(Exception):
    """A call that is refused or has failed; ``text`` may hold {names} of ``more``, filled in after translation."""

    def __init__(self, code: str, text: str, **more: Any) -> None:
        self.code, self.text, self.more = code, text, more
        super().__init__(text)


@dataclass(slots=True)
class Caller:
    """Who calls, and where."""

    server: Server
    client: Client


Function = Callable[..., Awaitable[Any]]


@dataclass(frozen=True, slots=True)
class Method:
    """One row of the table."""

    name: str
    right: Right
    function: Function
    parameters: dict[str, tuple[tuple[type, ...], bool]]  # name: (types that are right, may be left out)

    def arguments(self, given: Any) -> dict[str, Any]:
        """The arguments of a call, checked; CallError names the one that is wrong."""
        if given is None:
            given = {}
        if not isinstance(given, dict):
            raise CallError("argument", "the arguments of {method} must be a map", method=self.name)
        for name in given:
            if name not in self.parameters:
                raise CallError("argument", "{method} takes no {argument}", method=self.name, argument=str(name))
        checked = {}
        for name, (kinds, optional) in self.parameters.items():
            if name in given and not (given[name] is None and optional):
                checked[name] = self._value(name, given[name], kinds)
            elif not optional:
                raise CallError("argument", "{method} needs {argument}", method=self.name, argument=name)
        return checked

    def _value(self, name: str, value: Any, kinds: tuple[type, ...]) -> Any:
        if isinstance(value, int) and not isinstance(value, bool) and float in kinds and int not in kinds:
            value = float(value) if abs(value) < 1e15 else math.inf
        right = type(value) in kinds or object in kinds
        if isinstance(value, float) and not math.isfinite(value):
            right = False
        if isinstance(value, str) and len(value) > LONGEST_TEXT:
            right = False
        if not right:
            wanted = " or ".join("null" if kind is types.NoneType else kind.__name__ for kind in kinds)
            raise CallError("argument", "{argument} must be {wanted}", argument=name, wanted=wanted)
        return value


METHODS: dict[str, Method] = {}


def method(name: str, right: Right) -> Callable[[Function], Function]:
    """Register a function as a method."""

    def register(function: Function) -> Function:
        METHODS[name] = Method(name, right, function, _parameters(function))
        return function

    return register


def _parameters(function: Function) -> dict[str, tuple[tuple[type, ...], bool]]:
    hints = typing.get_type_hints(function, localns={"Caller": Caller}, include_extras=False)
    found = {}
    for parameter in list(inspect.signature(function).parameters.values())[1:]:
        hint = hints[parameter.name]
        union = typing.get_args(hint) if typing.get_origin(hint) in (types.UnionType, typing.Union) else (hint,)
        kinds = tuple(typing.get_origin(kind) or (object if kind is Any else kind) for kind in union)
        found[parameter.name] = (kinds, parameter.default is not parameter.empty)
    return found


async def perform(caller: Caller, name: Any, given: Any) -> Any:
    """Carry out one call; CallError where it is refused or fails."""
    row = METHODS.get(name) if isinstance(name, str) else None
    if row is None:
        raise CallError("method", "there is no method {method}", method=str(name)[:100])
    if name.startswith("wizard.") != caller.server.config["wizard"] and not name.startswith("control."):
        raise CallError("state", "no machine runs" if caller.server.config["wizard"] else "a machine runs")
    caller.server.hub.require(caller.client, row.right)
    return await row.function(caller, **row.arguments(given))
