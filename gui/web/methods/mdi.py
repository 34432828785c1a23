"""MDI: lines, their check, their history, and the buttons of [MDI_COMMAND_LIST]."""

from __future__ import annotations

from typing import Any

import linuxcnc
from gui.web.calls import Caller, CallError, Right, method
from gui.web.methods.operating import STOPPED

LONGEST_LINE = 254  # bytes, of task


@method("mdi.check", Right.ANYBODY)
async def check(caller: Caller, text: str) -> dict[str, Any]:
    return await caller.server.preview.check_block(_line(text))


@method("mdi.run", Right.CONTROLS)
async def run(caller: Caller, text: str) -> dict[str, int]:
    line = _line(text)
    caller.server.history.add(line)
    return {"serial": await execute(caller, line)}


@method("mdi.command", Right.CONTROLS)
async def command(caller: Caller, index: int) -> None:
    buttons = caller.server.config["mdi_commands"]
    if not 0 <= index < len(buttons):
        raise CallError("argument", "there is no such button", argument="index")
    for line in buttons[index]["commands"]:
        await execute(caller, line)


@method("mdi.history", Right.ANYBODY)
async def history(caller: Caller) -> list[str]:
    return caller.server.history.lines


@method("mdi.history_clear", Right.OPERATOR)
async def history_clear(caller: Caller) -> None:
    caller.server.history.clear()


async def execute(caller: Caller, line: str) -> int:
    """Have the machine execute one line and wait for its end; the serial number."""
    machine = caller.server.machine
    if machine.values["task_state"] in STOPPED:
        raise CallError("state", "switch the machine on first")
    await caller.server.jogging.stop()
    await machine.mode(linuxcnc.MODE_MDI)
    return await machine.order("mdi", line)


def _line(text: str) -> str:
    line = text.strip()
    if not line or "\n" in line or "\r" in line or not line.isprintable():
        raise CallError("argument", "one line of G-code is needed", argument="text")
    if len(line.encode()) > LONGEST_LINE:
        raise CallError("argument", "a line may have {most} characters", argument="text", most=LONGEST_LINE)
    return line
