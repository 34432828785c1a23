"""Overrides, spindles, coolant, outputs: what an operator turns while the machine cuts."""

from __future__ import annotations

import linuxcnc
from gui.web.calls import Caller, CallError, Right, method

ENABLES = {
    "feed": "set_feed_override",
    "hold": "set_feed_hold",
    "adaptive": "set_adaptive_feed",
}


def _within(name: str, value: float, low: float, high: float) -> float:
    if not low <= value <= high:
        raise CallError(
            "argument", "{argument} must be {low} to {high}", argument=name, low=f"{low:g}", high=f"{high:g}"
        )
    return value


def _spindle(caller: Caller, number: int) -> dict[str, float]:
    spindles: list[dict[str, float]] = caller.server.config["spindles"]
    if not 0 <= number < len(spindles):
        raise CallError("argument", "there is no such spindle", argument="spindle")
    return spindles[number]


@method("override.feed", Right.CONTROLS)
async def feed(caller: Caller, value: float) -> None:
    await caller.server.machine.adjust(
        "feedrate", _within("value", value, 0.0, caller.server.config["overrides"]["feed_max"])
    )


@method("override.rapid", Right.CONTROLS)
async def rapid(caller: Caller, value: float) -> None:
    await caller.server.machine.adjust(
        "rapidrate", _within("value", value, 0.0, caller.server.config["overrides"]["rapid_max"])
    )


@method("override.spindle", Right.CONTROLS)
async def spindle_override(caller: Caller, value: float, spindle: int = 0) -> None:
    one = _spindle(caller, spindle)
    await caller.server.machine.adjust(
        "spindleoverride", _within("value", value, one["min_override"], one["max_override"]), spindle
    )


@method("override.max_velocity", Right.CONTROLS)
async def max_velocity(caller: Caller, value: float) -> None:
    await caller.server.machine.adjust("maxvel", _within("value", value, 0.0, 1e9))


@method("override.enable", Right.CONTROLS)
async def enable(caller: Caller, what: str, on: bool, spindle: int = 0) -> None:
    if what == "spindle":
        _spindle(caller, spindle)
        await caller.server.machine.adjust("set_spindle_override", int(on), spindle)
    elif what in ENABLES:
        await caller.server.machine.adjust(ENABLES[what], int(on))
    else:
        raise CallError("argument", "{argument} must be feed, spindle, hold or adaptive", argument="what")


@method("spindle.on", Right.CONTROLS)
async def spindle_on(caller: Caller, speed: float, direction: int = 1, spindle: int = 0) -> None:
    one = _spindle(caller, spindle)
    if direction not in (1, -1):
        raise CallError("argument", "{argument} must be 1 or -1", argument="direction")
    _within("speed", speed, one["min_speed"], one["max_speed"])
    await caller.server.machine.mode(linuxcnc.MODE_MANUAL)
    await caller.server.machine.send("spindle", direction, speed, spindle)


@method("spindle.off", Right.CONTROLS)
async def spindle_off(caller: Caller, spindle: int = 0) -> None:
    _spindle(caller, spindle)
    await caller.server.machine.adjust("spindle", linuxcnc.SPINDLE_OFF, spindle)


@method("spindle.increase", Right.CONTROLS)
async def spindle_increase(caller: Caller, spindle: int = 0) -> None:
    _spindle(caller, spindle)
    await caller.server.machine.adjust("spindle", linuxcnc.SPINDLE_INCREASE, spindle)


@method("spindle.decrease", Right.CONTROLS)
async def spindle_decrease(caller: Caller, spindle: int = 0) -> None:
    _spindle(caller, spindle)
    await caller.server.machine.adjust("spindle", linuxcnc.SPINDLE_DECREASE, spindle)


@method("spindle.brake", Right.CONTROLS)
async def brake(caller: Caller, on: bool, spindle: int = 0) -> None:
    _spindle(caller, spindle)
    action = linuxcnc.BRAKE_ENGAGE if on else linuxcnc.BRAKE_RELEASE
    await caller.server.machine.adjust("brake", action, spindle)


@method("coolant.flood", Right.CONTROLS)
async def flood(caller: Caller, on: bool) -> None:
    await caller.server.machine.adjust("flood", int(on))


@method("coolant.mist", Right.CONTROLS)
async def mist(caller: Caller, on: bool) -> None:
    await caller.server.machine.adjust("mist", int(on))


@method("lube", Right.CONTROLS)
async def lube(caller: Caller, on: bool) -> None:
    await caller.server.machine.adjust("lube", int(on))


@method("output.digital", Right.CONTROLS)
async def digital(caller: Caller, index: int, value: bool) -> None:
    _within("index", index, 0, len(caller.server.machine.values["dout"]) - 1)
    await caller.server.machine.adjust("set_digital_output", index, int(value))


@method("output.analog", Right.CONTROLS)
async def analog(caller: Caller, index: int, value: float) -> None:
    _within("index", index, 0, len(caller.server.machine.values["aout"]) - 1)
    await caller.server.machine.adjust("set_analog_output", index, value)
