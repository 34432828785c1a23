"""Coordinate systems and touch-off: all of it by G10, so that the interpreter knows it as well."""

from __future__ import annotations

from typing import Any

from gui.web import parameters
from gui.web.calculator import calculate
from gui.web.calls import Caller, CallError, Right, method
from gui.web.methods.mdi import execute

MM_OF_PROGRAM_UNIT = {1: 25.4, 2: 1.0, 3: 10.0}  # by stat.program_units
ROTARY = "ABC"


@method("offsets.read", Right.ANYBODY)
async def read(caller: Caller) -> dict[str, Any]:
    return parameters.offsets(caller.server.parameter_file, caller.server.machine.values)


@method("offsets.write", Right.CONTROLS)
async def write(caller: Caller, system: int, values: dict[str, Any]) -> None:
    if not 1 <= system <= len(parameters.NAMES):
        raise CallError("argument", "{argument} must be 1 to 9", argument="system")
    words = []
    for letter, value in values.items():
        if type(value) not in (int, float) or abs(value) > 1e6:
            raise CallError("argument", "{argument} must be a number", argument=str(letter))
        if letter == "R":
            words.append(f"R{_number(value)}")
        else:
            words.append(f"{_letter(caller, letter)}{_number(value / _machine_units(caller, letter))}")
    if not words:
        raise CallError("argument", "no value was given", argument="values")
    await _execute(caller, f"G10 L2 P{system} {' '.join(words)}")


@method("offsets.clear_g92", Right.CONTROLS)
async def clear_g92(caller: Caller) -> None:
    await _execute(caller, "G92.1")


@method("touchoff.axis", Right.CONTROLS)
async def axis(caller: Caller, axis: str, value: float | str, system: int | None = None) -> None:
    letter = _letter(caller, axis)
    chosen = system if system is not None else caller.server.machine.values["g5x_index"]
    if not 1 <= chosen <= len(parameters.NAMES):
        raise CallError("argument", "{argument} must be 1 to 9", argument="system")
    await _execute(caller, f"G10 L20 P{chosen} {letter}{_number(_value(caller, value))}")


@method("touchoff.tool", Right.CONTROLS)
async def tool(caller: Caller, axis: str, value: float | str, fixture: bool = False) -> None:
    number = caller.server.machine.values["tool_in_spindle"]
    if number <= 0:
        raise CallError("state", "there is no tool in the spindle")
    await _execute(
        caller, f"G10 L{11 if fixture else 10} P{number} {_letter(caller, axis)}{_number(_value(caller, value))}"
    )
    await execute(caller, "G43")


async def _execute(caller: Caller, line: str) -> None:
    """Execute a line that changes offsets, and have the parameter file written."""
    await execute(caller, line)
    await caller.server.machine.order("task_plan_synch")
    caller.server.state.bump("offsets")


def _letter(caller: Caller, letter: Any) -> str:
    name = str(letter).upper()
    if name not in [axis["letter"] for axis in caller.server.config["axes"]]:
        raise CallError("argument", "there is no axis {axis}", argument="axis", axis=name[:10])
    return name


def _machine_units(caller: Caller, letter: str) -> float:
    """Machine units in one program unit."""
    if letter.upper() in ROTARY:
        return 1.0
    program = MM_OF_PROGRAM_UNIT[caller.server.machine.values["program_units"]]
    return float(program / caller.server.config["units"]["mm_per_unit"])


def _value(caller: Caller, value: float | str) -> float:
    if isinstance(value, float):
        return value
    return calculate(value, MM_OF_PROGRAM_UNIT[caller.server.machine.values["program_units"]])


def _number(value: float) -> str:
    return f"{value:.7f}".rstrip("0").rstrip(".") or "0"
