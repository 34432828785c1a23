"""Tool table and tool changes."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import linuxcnc
from gui.web import tooltable
from gui.web.calls import Caller, CallError, Right, method
from gui.web.methods.mdi import execute


@method("tools.read", Right.ANYBODY)
async def read(caller: Caller) -> dict[str, Any]:
    return await asyncio.to_thread(tooltable.read, _file(caller))


@method("tools.write", Right.CONTROLS)
async def write(caller: Caller, version: str, tools: list[Any]) -> dict[str, str]:
    if caller.server.machine.values["interp_state"] != linuxcnc.INTERP_IDLE:
        raise CallError("state", "a program runs")
    fresh = await asyncio.to_thread(tooltable.write, _file(caller), version, tools)
    await caller.server.machine.order("load_tool_table")
    caller.server.state.bump("tools")
    return {"version": fresh}


@method("toolchange.confirm", Right.CONTROLS)
async def confirm(caller: Caller) -> None:
    if not caller.server.toolchange.confirm():
        raise CallError("state", "no tool change is asked for")


@method("toolchange.load", Right.CONTROLS)
async def load(caller: Caller, tool: int) -> None:
    await execute(caller, f"T{_number(tool)} M6")


@method("toolchange.declare", Right.CONTROLS)
async def declare(caller: Caller, tool: int) -> None:
    await execute(caller, f"M61 Q{_number(tool)}")


def _number(tool: int) -> int:
    if not 0 <= tool <= 99999:
        raise CallError("argument", "there is no such tool", argument="tool")
    return tool


def _file(caller: Caller) -> Path:
    path = caller.server.tool_file
    if path is None:
        raise CallError("state", "this machine keeps its tools in a program of its own")
    return Path(path)
