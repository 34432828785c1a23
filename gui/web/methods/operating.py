"""E-stop, power, modes, homing, limits."""

from __future__ import annotations

import linuxcnc
from gui.web.calls import Caller, CallError, Right, method
from gui.web.machine import Lane

STOPPED = (linuxcnc.STATE_ESTOP, linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_OFF)


@method("machine.estop", Right.OPERATOR)
async def estop(caller: Caller) -> None:
    machine = caller.server.machine
    caller.server.jogging.drop_all()
    machine.give_up()
    await machine.order("state", linuxcnc.STATE_ESTOP, lane=Lane.URGENT)


@method("machine.estop_reset", Right.CONTROLS)
async def estop_reset(caller: Caller) -> None:
    machine = caller.server.machine
    await machine.order("state", linuxcnc.STATE_ESTOP_RESET)
    if not await machine.reach(lambda values: values["task_state"] != linuxcnc.STATE_ESTOP):
        raise CallError("machine", "E-stop is still on: the chain is open", messages=[])


@method("machine.power", Right.CONTROLS)
async def power(caller: Caller, on: bool) -> None:
    machine = caller.server.machine
    if not on:
        caller.server.jogging.drop_all()
        machine.give_up()
        await machine.order("state", linuxcnc.STATE_OFF, lane=Lane.URGENT)
        return
    if machine.values.get("task_state") == linuxcnc.STATE_ESTOP:
        raise CallError("state", "reset the E-stop first")
    await machine.order("state", linuxcnc.STATE_ON)
    if not await machine.reach(lambda values: values["task_state"] == linuxcnc.STATE_ON):
        raise CallError("machine", "the machine does not switch on", messages=[])


@method("machine.abort", Right.OPERATOR)
async def abort(caller: Caller) -> None:
    machine = caller.server.machine
    caller.server.jogging.drop_all()
    machine.give_up()
    await machine.adjust("abort", lane=Lane.URGENT)


@method("machine.mode", Right.CONTROLS)
async def mode(caller: Caller, mode: int) -> None:
    if mode not in (linuxcnc.MODE_MANUAL, linuxcnc.MODE_AUTO, linuxcnc.MODE_MDI):
        raise CallError("argument", "{argument} must be 1, 2 or 3", argument="mode")
    await caller.server.machine.mode(mode)


@method("home", Right.CONTROLS)
async def home(caller: Caller, joint: int = -1) -> None:
    await _manual_and_free(caller, joint)
    await caller.server.machine.send("home", joint)


@method("unhome", Right.CONTROLS)
async def unhome(caller: Caller, joint: int = -1) -> None:
    await _manual_and_free(caller, joint)
    await caller.server.machine.order("unhome", joint)


@method("override_limits", Right.CONTROLS)
async def override_limits(caller: Caller) -> None:
    await caller.server.machine.mode(linuxcnc.MODE_MANUAL)
    await caller.server.machine.order("override_limits")


@method("teleop", Right.CONTROLS)
async def teleop(caller: Caller, on: bool) -> None:
    await caller.server.machine.mode(linuxcnc.MODE_MANUAL)
    await set_teleop(caller, on)


@method("debug", Right.CONTROLS)
async def debug(caller: Caller, flags: int) -> None:
    await caller.server.machine.adjust("debug", flags)


async def set_teleop(caller: Caller, on: bool) -> None:
    """Jog axes or joints from now on."""
    machine = caller.server.machine
    wanted = linuxcnc.TRAJ_MODE_TELEOP if on else linuxcnc.TRAJ_MODE_FREE
    if machine.values["motion_mode"] == wanted:
        return
    await machine.order("teleop_enable", int(on))
    if not await machine.reach(lambda values: values["motion_mode"] == wanted):
        raise CallError(
            "state", "axes can be jogged when the machine is homed" if on else "joints cannot be jogged now"
        )


async def _manual_and_free(caller: Caller, joint: int) -> None:
    """What homing needs: manual mode, joints, and no jog under way."""
    if joint not in range(-1, caller.server.machine.values["joints"]):
        raise CallError("argument", "there is no such joint", argument="joint")
    if caller.server.machine.values["task_state"] in STOPPED:
        raise CallError("state", "switch the machine on first")
    await caller.server.jogging.stop()
    await caller.server.machine.mode(linuxcnc.MODE_MANUAL)
    await set_teleop(caller, on=False)
