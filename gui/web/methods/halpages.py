"""HAL: tree, live values, setting, nets, threads, scope; and the state of the controller's processes."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from gui.web import frames, system
from gui.web.calls import Caller, CallError, Right, method
from gui.web.halview import KINDS, HalView, plain
from gui.web.scope import MOST_PINS, MOST_SAMPLES, Order, Record, Scope
from hal.capture import Trigger
from nml.errors import HalError

if TYPE_CHECKING:
    from gui.web.client import Client

MOST_WATCHED = 500
WATCH_INTERVAL = 0.05  # s
EDGES = {"rising": ">", "falling": "<"}


def _view(caller: Caller) -> HalView:
    view = caller.server.hal
    if view is None:
        raise CallError("hal", "there is no HAL on this computer")
    return view


@method("hal.tree", Right.ANYBODY)
async def tree(caller: Caller, filter: str = "", kinds: list[str] | None = None) -> dict[str, Any]:
    wanted = KINDS if kinds is None else [kind for kind in KINDS if kind in kinds]
    return await asyncio.to_thread(_view(caller).tree, filter, wanted)


@method("hal.watch", Right.ANYBODY)
async def watch(caller: Caller, names: list[str]) -> None:
    view = _view(caller)
    if len(names) > MOST_WATCHED or not all(isinstance(name, str) for name in names):
        raise CallError("argument", "{most} names may be watched", argument="names", most=MOST_WATCHED)
    caller.client.stream("hal", asyncio.create_task(_watch(caller.client, view, names)) if names else None)


async def _watch(client: Client, view: HalView, names: list[str]) -> None:
    """Send what changes of some values until cancelled; names that appear later are found later."""
    shown: dict[str, Any] = {}
    cells = view.cells(names)
    looks = 0
    while True:
        looks += 1
        if looks % 20 == 0:
            cells = view.cells(names)
        values = {name: plain(cell.get()) if cell.exists else None for name, cell in cells.items()}
        changed = {name: value for name, value in values.items() if name not in shown or shown[name] != value}
        if changed:
            shown |= changed
            await client.send_patiently(frames.encode("hal", {"values": changed}))
        await asyncio.sleep(WATCH_INTERVAL)


@method("hal.set", Right.CONTROLS)
async def set_value(caller: Caller, name: str, value: bool | int | float | str) -> None:
    if not caller.server.config["hal_write"]:
        raise CallError("hal", "setting HAL values is switched off; [WEB]HAL_WRITE = yes allows it")
    try:
        _view(caller).set(name, value)
    except HalError as reason:
        raise CallError("hal", "{reason}", reason=str(reason)) from None
    caller.server.messages.notice("{name} set {item} to {value}", name=caller.client.name, item=name, value=value)


@method("hal.nets", Right.ANYBODY)
async def nets(caller: Caller, filter: str = "") -> dict[str, Any]:
    return await asyncio.to_thread(_view(caller).nets, filter)


@method("hal.threads", Right.ANYBODY)
async def threads(caller: Caller) -> dict[str, Any]:
    return {"threads": _view(caller).threads()}


@method("scope.start", Right.OPERATOR)
async def scope_start(
    caller: Caller,
    pins: list[str],
    thread: str = "servo-thread",
    samples: int = 1000,
    before: int | None = None,
    trigger: dict[str, Any] | None = None,
    repeat: bool = False,
) -> None:
    order = _order(pins, thread, samples, before, trigger, repeat)
    server, client = caller.server, caller.client
    if server.scope is not None and server.scope_owner is not client and server.scope.running:
        raise CallError("busy", "another client's scope is running")
    await _end_scope(caller)
    loop = asyncio.get_running_loop()

    def deliver(record: Record) -> None:
        fields = {name: getattr(record, name) for name in Record.__slots__}
        loop.call_soon_threadsafe(client.send, "scope", {**fields, "done": not repeat, "text": ""})

    def failed(reason: str) -> None:
        loop.call_soon_threadsafe(client.send, "scope", {"run": 0, "done": True, "text": reason})

    server.scope, server.scope_owner = Scope(order, deliver, failed), client
    await asyncio.to_thread(server.scope.start)
    client.stream("scope", asyncio.create_task(_hold_scope(server.scope)))


async def _hold_scope(scope: Scope) -> None:
    """The scope ends with its client: this task is cancelled then."""
    try:
        while scope.running:
            await asyncio.sleep(0.2)
    finally:
        await asyncio.shield(asyncio.to_thread(scope.stop))


@method("scope.stop", Right.OPERATOR)
async def scope_stop(caller: Caller) -> None:
    if caller.server.scope_owner is caller.client:
        await _end_scope(caller)


async def _end_scope(caller: Caller) -> None:
    server = caller.server
    if server.scope is not None:
        await asyncio.to_thread(server.scope.stop)
    server.scope = server.scope_owner = None


def _order(
    pins: list[str], thread: str, samples: int, before: int | None, trigger: dict[str, Any] | None, repeat: bool
) -> Order:
    """The order of a call; CallError names what is wrong."""
    if not 1 <= len(pins) <= MOST_PINS or not all(isinstance(pin, str) and "," not in pin for pin in pins):
        raise CallError("argument", "1 to {most} pins can be recorded", argument="pins", most=MOST_PINS)
    if not 2 <= samples <= MOST_SAMPLES:
        raise CallError("argument", "2 to {most} samples can be recorded", argument="samples", most=MOST_SAMPLES)
    wanted = None
    if trigger is not None:
        pin, edge, level = trigger.get("pin"), trigger.get("edge", "rising"), trigger.get("level", 0.0)
        if pin not in pins or edge not in EDGES or type(level) not in (int, float):
            raise CallError("argument", "a trigger has a recorded pin, an edge and a level", argument="trigger")
        wanted = Trigger(pin, EDGES[edge], float(level))
    ahead = samples // 10 if before is None else before
    if not 0 <= ahead < samples:
        raise CallError("argument", "{argument} must be less than samples", argument="before")
    return Order(tuple(pins), thread, samples, ahead, wanted, repeat)


@method("system.processes", Right.ANYBODY)
async def processes(caller: Caller) -> dict[str, Any]:
    server = caller.server
    return {
        "processes": await asyncio.to_thread(server.processes.look),
        "buffers": await system.buffers(server.ini.file),
        "threads": server.hal.threads() if server.hal is not None else [],
    }
