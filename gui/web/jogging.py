"""Continuous jogs that stop by themselves: the machine never has more than a bounded increment ahead.

A continuous jog is a chain of increments. As long as the page's beats come, each tick extends the target of the
running increment, so that it lies `AHEAD` s of travel plus the stopping distance before the tool. Whatever fails
(the page, the network, this server, killed in the middle of it), nobody extends it any more and the machine comes to
rest at the target. When the beats stop or the button is released, an ordinary jog stop brings it to rest sooner. An
order of another program in the middle of a jog ends it too, for it may be an abort, and an increment after that
would move the machine again.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
from dataclasses import dataclass
from typing import Any, Protocol

import linuxcnc
from gui.web.calls import CallError
from gui.web.machine import Lane, Machine
from gui.web.state import State
from nml import clock

log = logging.getLogger(__name__)

BEAT_INTERVAL = 0.05  # s between beats of the page
BEAT_TIMEOUT = 0.25  # s without a beat until the jog stops
TICK = 0.04  # s between extensions
AHEAD = 0.25  # s of travel beyond the stopping distance
NEAREST = 1e-6  # machine units: nearer to a limit than this is at the limit
FARTHEST = 1e6  # machine units that a joint without a home may be jogged


class Client(Protocol):
    """Who holds a jog: a page, or a program at the gateway."""

    @property
    def id(self) -> int: ...


@dataclass(slots=True)
class Target:
    """What is jogged: an axis in teleop mode or a joint in free mode."""

    letter: str | None
    joint: int | None
    index: int  # of the axis (X = 0) or joint
    acceleration: float  # units/s²
    low: float
    high: float

    @property
    def flag(self) -> int:
        """1 for a joint, as ``linuxcnc.command.jog`` wants it."""
        return int(self.joint is not None)

    def position(self, values: dict[str, Any]) -> float:
        """Where it stands."""
        return float(values["joint_position" if self.flag else "position"][self.index])


def target_of(description: dict[str, Any], *, joint: bool, homed: bool) -> Target:
    """What is jogged, by its entry in the configuration; limits are known where it is homed."""
    low, high = (description["min"], description["max"]) if homed else (-FARTHEST, FARTHEST)
    acceleration = max(description["max_acceleration"], 1e-6)
    if joint:
        return Target(None, description["number"], description["number"], acceleration, low, high)
    return Target(description["letter"], None, description["index"], acceleration, low, high)


@dataclass(slots=True)
class Jog:
    """One continuous jog."""

    number: int
    client: Client
    target: Target
    velocity: float  # units/s, with sign
    last_beat: float  # host time
    aim: float  # the position that the machine was sent to so far
    serials: tuple[int, int] = (0, 0)  # of the last two increments
    task: asyncio.Task[None] | None = None


class Jogging:
    """All continuous jogs of one machine."""

    def __init__(self, machine: Machine, state: State) -> None:
        self._machine = machine
        self._state = state
        self._jogs: dict[int, Jog] = {}
        self._numbers = itertools.count(1)
        self.stops = 0  # how often everything was stopped; a start that was asked for before is void
        state.update({"jog": []})

    def find(self, number: int) -> Jog | None:
        """A jog that goes on."""
        return self._jogs.get(number)

    def beat(self, client: Client, number: Any) -> None:
        """The page says that the button is still held."""
        jog = self._jogs.get(number) if isinstance(number, int) else None
        if jog is not None and jog.client is client:
            jog.last_beat = clock.host_now()

    async def start(self, client: Client, target: Target, velocity: float, stops: int) -> int:
        """Begin a jog; its number. ``stops`` was taken when it was asked for."""
        if stops != self.stops:
            raise CallError("aborted", "the jog was stopped before it began")
        if any(jog.target.index == target.index and jog.target.flag == target.flag for jog in self._jogs.values()):
            raise CallError("state", "this axis is being jogged already")
        jog = Jog(
            next(self._numbers), client, target, velocity, clock.host_now(), target.position(self._machine.values)
        )
        self._jogs[jog.number] = jog
        self._machine.watch_closely(True)
        try:
            await self._extend(jog)
        except CallError:
            self._forget(jog)
            raise
        if jog.number not in self._jogs:
            raise CallError("aborted", "the jog was stopped before it began")
        jog.task = asyncio.create_task(self._keep_going(jog))
        self._publish()
        return jog.number

    def change(self, client: Client, number: int, velocity: float) -> None:
        """Another speed in the same direction."""
        jog = self._jogs.get(number)
        if jog is None or jog.client is not client:
            raise CallError("state", "this jog is over")
        if velocity * jog.velocity <= 0.0:
            raise CallError("argument", "a jog keeps its direction", argument="velocity")
        jog.velocity = velocity

    async def stop(self, number: int | None = None) -> None:
        """Stop one jog, or all of them."""
        if number is None:
            self.stops += 1
        chosen = [jog for jog in self._jogs.values() if number is None or jog.number == number]
        for jog in chosen:
            self._forget(jog)
        for jog in chosen:
            await self._machine.send("jog", linuxcnc.JOG_STOP, jog.target.flag, jog.target.index, lane=Lane.JOGS)

    def drop_all(self) -> None:
        """Extend nothing any more; for whoever stops the machine by other means."""
        self.stops += 1
        for jog in list(self._jogs.values()):
            self._forget(jog)

    async def stop_increments(self) -> None:
        """Stop single increments under way, on every axis or joint."""
        values = self._machine.values
        if values.get("task_mode") != linuxcnc.MODE_MANUAL or values["inpos"]:
            return
        joints = values["motion_mode"] == linuxcnc.TRAJ_MODE_FREE
        for index in range(values["joints"] if joints else linuxcnc.MAX_AXIS):
            await self._machine.send("jog", linuxcnc.JOG_STOP, int(joints), index, lane=Lane.JOGS)

    def client_left(self, client: Client) -> None:
        """A client has lost the controls: its jogs end."""
        for jog in list(self._jogs.values()):
            if jog.client is client:
                self._stop_soon(jog)

    def _stop_soon(self, jog: Jog) -> None:
        task = asyncio.create_task(self.stop(jog.number))
        task.add_done_callback(_log_failure)

    def _forget(self, jog: Jog) -> None:
        self._jogs.pop(jog.number, None)
        self._machine.watch_closely(bool(self._jogs))
        if jog.task is not None and jog.task is not asyncio.current_task():
            jog.task.cancel()
        self._publish()

    def _publish(self) -> None:
        self._state.update(
            {
                "jog": [
                    {
                        "jog": jog.number, "axis": jog.target.letter, "joint": jog.target.joint,
                        "velocity": jog.velocity, "client": jog.client.id,
                    }
                    for jog in self._jogs.values()
                ]
            }
        )  # fmt: skip

    async def _keep_going(self, jog: Jog) -> None:
        """Extend the target until something ends the jog."""
        try:
            while jog.number in self._jogs:
                await asyncio.sleep(TICK)
                if clock.host_now() - jog.last_beat > BEAT_TIMEOUT or not self._allowed(jog):
                    await self.stop(jog.number)
                    return
                await self._extend(jog)
        except CallError as reason:
            log.warning("jog ended: %s", reason)
            await self.stop(jog.number)

    def _allowed(self, jog: Jog) -> bool:
        """Whether the machine is still one that may be jogged."""
        values = self._machine.values
        mode = linuxcnc.TRAJ_MODE_FREE if jog.target.flag else linuxcnc.TRAJ_MODE_TELEOP
        return bool(
            values.get("machine") == "ok"
            and values["task_state"] == linuxcnc.STATE_ON
            and values["task_mode"] == linuxcnc.MODE_MANUAL
            and values["motion_mode"] == mode
            and self._machine.only_ours(*jog.serials)
        )

    async def _extend(self, jog: Jog) -> None:
        """Send the target on, as far as travel and limits want it."""
        increment = extension(jog.target, jog.target.position(self._machine.values), jog.aim, jog.velocity)
        if increment <= 0.0:
            return
        sign = 1.0 if jog.velocity > 0.0 else -1.0
        jog.aim += sign * increment
        serial = await self._machine.send(
            "jog", linuxcnc.JOG_INCREMENT, jog.target.flag, jog.target.index, jog.velocity, increment, lane=Lane.JOGS
        )
        jog.serials = (jog.serials[1] or serial, serial)


def extension(target: Target, position: float, aim: float, velocity: float) -> float:
    """How far to move the aim on, in the direction of the velocity; 0 for not now."""
    speed, sign = abs(velocity), 1.0 if velocity > 0.0 else -1.0
    travel = speed * clock.speed() * (AHEAD + 2.0 * TICK)
    wanted = position + sign * (travel + speed * speed / (2.0 * target.acceleration))
    wanted = min(max(wanted, target.low), target.high)
    increment = sign * (wanted - aim)
    return increment if increment > NEAREST else 0.0


def _log_failure(task: asyncio.Task[None]) -> None:
    if not task.cancelled() and task.exception() is not None:
        log.warning("jog stop: %s", task.exception())
