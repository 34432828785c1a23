"""The ``ini.*`` HAL pins: limits, velocities and homing of the INI file, changed while the machine runs.

    ini.0.max_velocity   of joint 0        ini.x.max_velocity   of axis X        ini.traj_max_velocity   of the path

A pin begins with the INI file's value. When it changes, the new value goes into the machine's configuration and to
motion; one that cannot be is refused with a text, and the machine keeps what it had. Names are LinuxCNC's.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import hal
from emctask.config import AXES, AxisConfig, JointConfig
from emctask.setup import arc_blend, axis_limits, axis_speeds, path_limits, send_homing
from nml import clock
from nml.emc.emcmot import MotCommand

if TYPE_CHECKING:
    from emctask.config import MachineConfig
    from emctask.task import Task

COMPONENT, PREFIX = "inihal", "ini"
LOOK_S = 0.02  # host time between two looks at the pins while no command waits

Apply = Callable[["Task"], None]

POSITIVE = frozenset({"max_velocity", "max_acceleration"})
NOT_NEGATIVE = frozenset({"ferror", "min_ferror", "max_jerk", "default_velocity", "default_acceleration"})


@dataclass(slots=True)
class Pin:
    """One pin: the object and attribute that it stands for, and what tells motion of a change."""

    name: str
    kind: int
    owner: Any
    attribute: str
    apply: Apply
    value: Any = 0

    def problem(self, value: Any) -> str:
        """Why the machine cannot have this value; empty if it can."""
        if self.attribute in POSITIVE and value <= 0:
            return "a number above 0 is needed"
        if self.attribute in NOT_NEGATIVE and value < 0:
            return "0 or more is needed"
        if self.attribute == "min_limit" and value >= self.owner.max_limit:
            return f"a number below max_limit, {self.owner.max_limit:g}, is needed"
        if self.attribute == "max_limit" and value <= self.owner.min_limit:
            return f"a number above min_limit, {self.owner.min_limit:g}, is needed"
        return ""


def _joint_pins(number: int, joint: JointConfig) -> Iterator[Pin]:
    def send(order: MotCommand, *fields: tuple[str, str]) -> Apply:
        def apply(task: Task) -> None:
            task.motion.send(order, joint=number, **{name: getattr(joint, attribute) for name, attribute in fields})

        return apply

    def homing(task: Task) -> None:
        send_homing(task.motion, number, joint)

    limits = send(MotCommand.SET_JOINT_POSITION_LIMITS, ("minLimit", "min_limit"), ("maxLimit", "max_limit"))
    rows: tuple[tuple[str, str, Apply], ...] = (
        ("backlash", "backlash", send(MotCommand.SET_JOINT_BACKLASH, ("backlash", "backlash"))),
        ("ferror", "ferror", send(MotCommand.SET_JOINT_MAX_FERROR, ("maxFerror", "ferror"))),
        ("min_ferror", "min_ferror", send(MotCommand.SET_JOINT_MIN_FERROR, ("minFerror", "min_ferror"))),
        ("min_limit", "min_limit", limits),
        ("max_limit", "max_limit", limits),
        ("max_velocity", "max_velocity", send(MotCommand.SET_JOINT_VEL_LIMIT, ("vel", "max_velocity"))),
        ("max_acceleration", "max_acceleration", send(MotCommand.SET_JOINT_ACC_LIMIT, ("acc", "max_acceleration"))),
        ("jerk", "max_jerk", send(MotCommand.SET_JOINT_JERK_LIMIT, ("jerk", "max_jerk"))),
        ("home", "home", homing),
        ("home_offset", "home_offset", homing),
    )
    for name, attribute, apply in rows:
        yield Pin(f"{number}.{name}", hal.HAL_FLOAT, joint, attribute, apply)
    yield Pin(f"{number}.home_sequence", hal.HAL_S32, joint, "home_sequence", homing)


def _axis_pins(axis: int, values: AxisConfig) -> Iterator[Pin]:
    def speeds(task: Task) -> None:
        axis_speeds(task.motion, axis, values)
        config = task.config
        config.max_axis_velocities[axis] = values.max_velocity
        config.max_axis_accelerations[axis] = values.max_acceleration
        task.canon.set_limits(config.max_axis_velocities, config.max_axis_accelerations, config.axis_mask)

    def limits(task: Task) -> None:
        axis_limits(task.motion, axis, values)

    def jerk(task: Task) -> None:
        task.motion.send(MotCommand.SET_AXIS_JERK_LIMIT, axis=axis, jerk=values.max_jerk)

    letter = AXES[axis].lower()
    for name, apply in (
        ("min_limit", limits), ("max_limit", limits), ("max_velocity", speeds), ("max_acceleration", speeds),
        ("max_jerk", jerk),
    ):  # fmt: skip
        yield Pin(f"{letter}.{name}", hal.HAL_FLOAT, values, name, apply)


def _path_pins(config: MachineConfig) -> Iterator[Pin]:
    def path(task: Task) -> None:
        path_limits(task.motion, config)

    def blends(task: Task) -> None:
        arc_blend(task.motion, config.arc_blend)

    float_ = partial(Pin, kind=hal.HAL_FLOAT)
    for name in ("default_velocity", "max_velocity", "default_acceleration", "max_acceleration", "max_jerk"):
        yield float_(f"traj_{name}", owner=config, attribute=name, apply=path)
    yield Pin("traj_planner_type", hal.HAL_S32, config, "planner_type", path)
    kinds = {"enable": hal.HAL_BIT, "fallback_enable": hal.HAL_BIT, "optimization_depth": hal.HAL_S32}
    for name in ("enable", "fallback_enable", "optimization_depth", "gap_cycles", "ramp_freq", "tangent_kink_ratio"):
        kind = kinds.get(name, hal.HAL_FLOAT)
        yield Pin(f"traj_arc_blend_{name}", kind, config.arc_blend, name, blends)


class IniPins:
    """The component of one machine; ``look`` once a cycle."""

    def __init__(self, config: MachineConfig) -> None:
        self._component = hal.component(COMPONENT, PREFIX)
        self._pins = [*_path_pins(config)]
        for number, joint in enumerate(config.joints):
            self._pins += _joint_pins(number, joint)
        for axis, values in config.axes.items():
            self._pins += _axis_pins(axis, values)
        for pin in self._pins:
            pin.value = getattr(pin.owner, pin.attribute)
            self._component.newpin(pin.name, pin.kind, hal.HAL_IN)
            self._component[pin.name] = pin.value
        for axis, letter in enumerate(AXES.lower()):
            if axis not in config.axes:
                for name in ("min_limit", "max_limit", "max_velocity", "max_acceleration"):
                    self._component.newpin(f"{letter}.{name}", hal.HAL_FLOAT, hal.HAL_IN)
        self._component.ready()
        self._next_look = 0.0

    def look(self, task: Task, *, at_once: bool) -> None:
        """Take over what has changed; ``at_once`` where a command waits: what was set before it holds for it."""
        now = clock.host_now()
        if now < self._next_look and not at_once:
            return
        self._next_look = now + LOOK_S
        component = self._component
        for pin in self._pins:
            value = component[pin.name]
            if value != pin.value:
                pin.value = value
                self._take(task, pin, value)

    def _take(self, task: Task, pin: Pin, value: Any) -> None:
        problem = pin.problem(value)
        if problem:
            kept = getattr(pin.owner, pin.attribute)
            task.operator.error(f"{PREFIX}.{pin.name} = {value:g} is refused: {problem}; {kept:g} stays in force")
            return
        setattr(pin.owner, pin.attribute, value)
        pin.apply(task)

    def close(self) -> None:
        """Remove the pins."""
        self._component.exit()
