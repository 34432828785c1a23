"""Jogging: continuous ones by ``gui.web.jogging``, single increments here."""

from __future__ import annotations

import linuxcnc
from gui.web.calls import Caller, CallError, Right, method
from gui.web.jogging import Target, target_of
from gui.web.machine import Lane
from gui.web.methods.operating import STOPPED, set_teleop


@method("jog.start", Right.CONTROLS)
async def start(caller: Caller, velocity: float, axis: str | None = None, joint: int | None = None) -> dict[str, int]:
    stops = caller.server.jogging.stops
    target = await _prepare(caller, axis, joint)
    velocity = _allowed_speed(caller, axis, joint, velocity)
    return {"jog": await caller.server.jogging.start(caller.client, target, velocity, stops)}


@method("jog.velocity", Right.CONTROLS)
async def velocity(caller: Caller, jog: int, velocity: float) -> None:
    caller.server.jogging.change(caller.client, jog, velocity)


@method("jog.step", Right.CONTROLS)
async def step(
    caller: Caller, velocity: float, distance: float, axis: str | None = None, joint: int | None = None
) -> None:
    if velocity <= 0.0:
        raise CallError("argument", "{argument} must be above 0", argument="velocity")
    target = await _prepare(caller, axis, joint)
    speed = _allowed_speed(caller, axis, joint, velocity)
    if distance < 0.0:
        speed = -speed
    await caller.server.machine.send(
        "jog", linuxcnc.JOG_INCREMENT, target.flag, target.index, speed, abs(distance), lane=Lane.JOGS
    )


@method("jog.stop", Right.OPERATOR)
async def stop(caller: Caller, jog: int | None = None) -> None:
    await caller.server.jogging.stop(jog)
    if jog is None:
        await caller.server.jogging.stop_increments()


def _description(caller: Caller, axis: str | None, joint: int | None) -> dict[str, float]:
    config = caller.server.config
    if (axis is None) == (joint is None):
        raise CallError("argument", "either axis or joint is needed", argument="axis")
    for one in config["axes"]:
        if axis is not None and one["letter"] == axis.upper():
            return dict(one)
    for one in config["joints"]:
        if joint is not None and one["number"] == joint:
            return dict(one)
    raise CallError("argument", "there is no such axis or joint", argument="joint" if axis is None else "axis")


def _allowed_speed(caller: Caller, axis: str | None, joint: int | None, velocity: float) -> float:
    """The velocity, no faster than the axis and the INI file's highest jog speed."""
    one = _description(caller, axis, joint)
    highest = caller.server.config["jog_speed"]["linear" if one["linear"] else "angular"]["max_per_min"] / 60.0
    limit = min(one["max_velocity"], highest)
    if velocity == 0.0:
        raise CallError("argument", "{argument} must not be 0", argument="velocity")
    return max(-limit, min(limit, velocity))


async def _prepare(caller: Caller, axis: str | None, joint: int | None) -> Target:
    """Bring the machine into the mode for this jog; what is jogged."""
    one = _description(caller, axis, joint)
    values = caller.server.machine.values
    if values["task_state"] in STOPPED:
        raise CallError("state", "switch the machine on first")
    if values["interp_state"] != linuxcnc.INTERP_IDLE:
        raise CallError("state", "a program runs")
    await caller.server.machine.mode(linuxcnc.MODE_MANUAL)
    await set_teleop(caller, on=axis is not None)
    homed = axis is not None or values["homed"][joint]
    return target_of(one, joint=axis is None, homed=bool(homed))
