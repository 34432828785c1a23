"""Programs: the folder, the editor, and running them."""

from __future__ import annotations

import asyncio
from typing import Any

import linuxcnc
from gui.web.calls import Caller, CallError, Right, method
from gui.web.machine import Lane


@method("program.list", Right.ANYBODY)
async def list_folder(caller: Caller, folder: str = "") -> dict[str, Any]:
    return await asyncio.to_thread(caller.server.folder.listing, folder)


@method("program.open", Right.CONTROLS)
async def open_program(caller: Caller, path: str) -> None:
    file = caller.server.folder.existing(path)
    await caller.server.programs.open(file)


@method("program.lines", Right.ANYBODY)
async def lines(caller: Caller, first: int, count: int, version: str | None = None) -> dict[str, Any]:
    text = caller.server.programs.text
    if text is None:
        raise CallError("state", "no program is loaded")
    if version is not None and version != text.version:
        raise CallError("conflict", "another program is loaded", version=text.version)
    found = await asyncio.to_thread(text.lines, first, count)
    return {"version": text.version, "first": max(1, first), "lines": found, "total": text.total}


@method("program.read", Right.ANYBODY)
async def read(caller: Caller, path: str) -> dict[str, str]:
    return await asyncio.to_thread(caller.server.folder.read, path)


@method("program.save", Right.OPERATOR)
async def save(caller: Caller, path: str, text: str, version: str | None = None) -> dict[str, str]:
    _not_running(caller, path)
    fresh = await asyncio.to_thread(caller.server.folder.save, path, text, version)
    await caller.server.programs.changed(path)
    return {"version": fresh}


@method("program.remove", Right.OPERATOR)
async def remove(caller: Caller, path: str) -> None:
    _not_loaded(caller, path)
    await asyncio.to_thread(caller.server.folder.remove, path)
    caller.server.state.bump("programs")


@method("program.rename", Right.OPERATOR)
async def rename(caller: Caller, path: str, to: str) -> None:
    _not_loaded(caller, path)
    await asyncio.to_thread(caller.server.folder.rename, path, to)
    caller.server.state.bump("programs")


@method("program.run", Right.CONTROLS)
async def run(caller: Caller, line: int = 1, token: str | None = None) -> None:
    machine, programs = caller.server.machine, caller.server.programs
    if programs.text is None:
        raise CallError("state", "no program is loaded")
    _idle(caller)
    if line > 1:
        await programs.redeem(line, token)
    await caller.server.jogging.stop()
    await machine.mode(linuxcnc.MODE_AUTO)
    await machine.begin("auto", linuxcnc.AUTO_RUN, line if line > 1 else 0)


@method("program.run_from_check", Right.ANYBODY)
async def run_from_check(caller: Caller, line: int) -> dict[str, Any]:
    if caller.server.programs.text is None:
        raise CallError("state", "no program is loaded")
    if not 1 <= line <= caller.server.programs.text.total:
        raise CallError("argument", "there is no such line", argument="line")
    return await caller.server.programs.check_run_from(line)


@method("program.step", Right.CONTROLS)
async def step(caller: Caller) -> None:
    machine = caller.server.machine
    if caller.server.programs.text is None:
        raise CallError("state", "no program is loaded")
    if machine.values["task_mode"] != linuxcnc.MODE_AUTO:
        _idle(caller)
        await machine.mode(linuxcnc.MODE_AUTO)
    await machine.begin("auto", linuxcnc.AUTO_STEP)


@method("program.pause", Right.OPERATOR)
async def pause(caller: Caller) -> None:
    await caller.server.machine.adjust("auto", linuxcnc.AUTO_PAUSE, lane=Lane.URGENT)


@method("program.resume", Right.CONTROLS)
async def resume(caller: Caller) -> None:
    await caller.server.machine.adjust("auto", linuxcnc.AUTO_RESUME)


@method("program.reverse", Right.CONTROLS)
async def reverse(caller: Caller) -> None:
    await caller.server.machine.adjust("auto", linuxcnc.AUTO_REVERSE)


@method("program.forward", Right.CONTROLS)
async def forward(caller: Caller) -> None:
    await caller.server.machine.adjust("auto", linuxcnc.AUTO_FORWARD)


@method("program.optional_stop", Right.CONTROLS)
async def optional_stop(caller: Caller, on: bool) -> None:
    await caller.server.machine.adjust("set_optional_stop", int(on))


@method("program.block_delete", Right.CONTROLS)
async def block_delete(caller: Caller, on: bool) -> None:
    await caller.server.machine.adjust("set_block_delete", int(on))


def _idle(caller: Caller) -> None:
    if caller.server.machine.values["interp_state"] != linuxcnc.INTERP_IDLE:
        raise CallError("state", "a program runs")


def _loaded(caller: Caller, path: str) -> bool:
    text = caller.server.programs.text
    return text is not None and text.path == caller.server.folder.resolve(path)


def _not_loaded(caller: Caller, path: str) -> None:
    if _loaded(caller, path):
        raise CallError("state", "{path} is loaded", path=path)


def _not_running(caller: Caller, path: str) -> None:
    running = caller.server.machine.values.get("interp_state", linuxcnc.INTERP_IDLE) != linuxcnc.INTERP_IDLE
    if running and _loaded(caller, path):
        raise CallError("state", "{path} runs", path=path)
