"""Taking, asking for, handing over and releasing the controls."""

from __future__ import annotations

from gui.web.calls import Caller, Right, method


@method("control.take", Right.OPERATOR)
async def take(caller: Caller, force: bool = False) -> None:
    caller.server.hub.take(caller.client, force)


@method("control.request", Right.OPERATOR)
async def request(caller: Caller) -> None:
    caller.server.hub.request(caller.client)


@method("control.release", Right.CONTROLS)
async def release(caller: Caller) -> None:
    caller.server.hub.release()


@method("control.hand", Right.CONTROLS)
async def hand(caller: Caller, client: int) -> None:
    caller.server.hub.hand(caller.client, client)
