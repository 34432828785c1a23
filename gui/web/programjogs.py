"""Continuous jogs that a program orders through the gateway: chains of bounded increments, as those of the page.

The program's EMC_JOG_CONT itself would go on for ever if this server were killed. So it is never passed on: ``Jogging``
extends increments for as long as frames come from the program, and whatever fails, the machine comes to rest.
"""

from __future__ import annotations

from typing import Any

from gui.web.calls import CallError
from gui.web.jogging import Jogging, target_of
from gui.web.machine import Machine
from nml.emc import EMC_JOG_CONT, EMC_JOG_STOP

Which = tuple[int, bool]  # number of the joint or axis, and whether it is a joint


class ProgramJogs:
    """The jogs of one connection."""

    id = 0  # no page has it

    def __init__(self, machine: Machine, jogging: Jogging, config: dict[str, Any]) -> None:
        self._machine = machine
        self._jogging = jogging
        self._config = config
        self._numbers: dict[Which, int] = {}

    def beat(self) -> None:
        """The program is alive."""
        for number in self._numbers.values():
            self._jogging.beat(self, number)

    async def go_on(self, message: EMC_JOG_CONT) -> int:
        """Begin to jog, or change the speed of a jog that goes on; the serial number of the order given last."""
        which = (message.joint_or_axis, bool(message.jjogmode))
        description = self._description(*which)
        velocity = max(-description["max_velocity"], min(message.vel, description["max_velocity"]))
        if velocity == 0.0:
            raise CallError("argument", "{argument} must not be 0", argument="vel")
        jog = self._jogging.find(self._numbers.get(which, 0))
        if jog is not None and jog.velocity * velocity < 0.0:
            await self._jogging.stop(jog.number)
            jog = None
        if jog is None:
            homed = not which[1] or bool(self._machine.values["homed"][which[0]])
            target = target_of(description, joint=which[1], homed=homed)
            number = await self._jogging.start(self, target, velocity, self._jogging.stops)
            self._numbers[which] = number
            jog = self._jogging.find(number)
        else:
            self._jogging.change(self, jog.number, velocity)
        return jog.serials[1] if jog is not None else 0

    async def stop(self, message: EMC_JOG_STOP) -> None:
        """Extend it no more; the order to stop itself goes on to the machine."""
        number = self._numbers.pop((message.joint_or_axis, bool(message.jjogmode)), None)
        if number is not None:
            await self._jogging.stop(number)

    def drop(self) -> None:
        """The program orders something else, which may end jogs: none of its own is extended any more."""
        if self._numbers:
            self._numbers.clear()
            self._jogging.drop_all()

    def end(self) -> None:
        """The program has gone."""
        self._numbers.clear()
        self._jogging.client_left(self)

    def _description(self, number: int, joint: bool) -> dict[str, Any]:
        """The axis or joint in the configuration of this machine."""
        for one in self._config["joints" if joint else "axes"]:
            if one["number" if joint else "index"] == number:
                return dict(one)
        raise CallError("argument", "there is no such axis or joint")
