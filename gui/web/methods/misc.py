"""Messages, dialogs, preferences, the calculator."""

from __future__ import annotations

from typing import Any

from gui.web.calculator import calculate
from gui.web.calls import Caller, CallError, Right, method


@method("messages.read", Right.ANYBODY)
async def messages(caller: Caller, before: int | None = None, count: int = 100) -> list[dict[str, Any]]:
    return caller.server.messages.newest(caller.client.language, count, before)


@method("preferences.read", Right.ANYBODY)
async def preferences(caller: Caller) -> dict[str, Any]:
    return caller.server.preferences.values


@method("preferences.write", Right.OPERATOR)
async def write_preferences(caller: Caller, values: dict[str, Any]) -> None:
    caller.server.preferences.change(values)
    caller.server.state.bump("preferences")


@method("calculate", Right.ANYBODY)
async def calculator(caller: Caller, text: str) -> float:
    mm = caller.server.config["units"]["mm_per_unit"]
    program_units = {1: 25.4, 2: 1.0, 3: 10.0}.get(caller.server.machine.values.get("program_units", 2), mm)
    return calculate(text, program_units)


@method("dialog.answer", Right.CONTROLS)
async def answer(caller: Caller, id: int, answer: bool) -> None:
    if not caller.server.dialogs.answer(id, answer):
        raise CallError("state", "this question is closed already")
