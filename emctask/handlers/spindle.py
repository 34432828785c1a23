"""SPINDLE: on, off, faster, slower, brake, orientation, by the operator. Manual, chapter 4.10."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask.commandtable import RUNNING, command
from emctask.handlers.traj import check_spindle
from nml.emc import (
    EMC_SPINDLE_BRAKE_ENGAGE,
    EMC_SPINDLE_BRAKE_RELEASE,
    EMC_SPINDLE_CONSTANT,
    EMC_SPINDLE_DECREASE,
    EMC_SPINDLE_INCREASE,
    EMC_SPINDLE_OFF,
    EMC_SPINDLE_ON,
    EMC_SPINDLE_ORIENT,
    EMC_SPINDLE_SPEED,
    EMC_SPINDLE_WAIT_ORIENT_COMPLETE,
)
from nml.emc.emcmot import MotCommand
from nml.message import Message

if TYPE_CHECKING:
    from emctask.task import Task

ALL = -1


def _spindles(task: Task, number: int) -> range:
    """The spindles that a command is for."""
    check_spindle(task, number, ALL)
    return range(len(task.config.spindles)) if number == ALL else range(number, number + 1)


@command(EMC_SPINDLE_ON, EMC_SPINDLE_SPEED, on=True, unless=RUNNING)
def on(task: Task, message: EMC_SPINDLE_ON) -> None:
    """Turn with this signed speed."""
    for spindle in _spindles(task, message.spindle):
        task.canon.spindles[spindle].direction = -1 if message.speed < 0 else 1
        task.motion.send(
            MotCommand.SPINDLE_ON,
            spindle=spindle,
            vel=message.speed,
            acc=message.factor,
            offset=message.xoffset,
            state=1,
            wait_for_spindle_at_speed=int(getattr(message, "wait_for_spindle_at_speed", 0)),
        )


@command(EMC_SPINDLE_OFF)
def off(task: Task, message: EMC_SPINDLE_OFF) -> None:
    """Stop turning."""
    for spindle in _spindles(task, message.spindle):
        task.canon.spindles[spindle].direction = 0
        task.motion.send(MotCommand.SPINDLE_OFF, spindle=spindle)


@command(EMC_SPINDLE_INCREASE, on=True)
def increase(task: Task, message: EMC_SPINDLE_INCREASE) -> None:
    """Turn faster by one step, [SPINDLE_n]INCREMENT."""
    for spindle in _spindles(task, message.spindle):
        task.motion.send(MotCommand.SPINDLE_INCREASE, spindle=spindle, vel=task.config.spindles[spindle].increment)


@command(EMC_SPINDLE_DECREASE, on=True)
def decrease(task: Task, message: EMC_SPINDLE_DECREASE) -> None:
    """Turn slower by one step."""
    for spindle in _spindles(task, message.spindle):
        task.motion.send(MotCommand.SPINDLE_DECREASE, spindle=spindle, vel=task.config.spindles[spindle].increment)


@command(EMC_SPINDLE_CONSTANT)
def constant(task: Task, message: Message) -> None:
    """End of a step; motion's steps end by themselves."""


@command(EMC_SPINDLE_BRAKE_ENGAGE, on=True, unless=RUNNING)
def engage_brake(task: Task, message: EMC_SPINDLE_BRAKE_ENGAGE) -> None:
    """Engage the brake, which stops the spindle."""
    for spindle in _spindles(task, message.spindle):
        task.motion.send(MotCommand.SPINDLE_BRAKE_ENGAGE, spindle=spindle)


@command(EMC_SPINDLE_BRAKE_RELEASE, on=True, unless=RUNNING)
def release_brake(task: Task, message: EMC_SPINDLE_BRAKE_RELEASE) -> None:
    """Release the brake."""
    for spindle in _spindles(task, message.spindle):
        task.motion.send(MotCommand.SPINDLE_BRAKE_RELEASE, spindle=spindle)


@command(EMC_SPINDLE_ORIENT, on=True)
def orient(task: Task, message: EMC_SPINDLE_ORIENT) -> None:
    """Turn to an angle."""
    for spindle in _spindles(task, message.spindle):
        task.motion.send(
            MotCommand.SPINDLE_ORIENT, spindle=spindle, orientation=message.orientation, mode=message.mode
        )


@command(EMC_SPINDLE_WAIT_ORIENT_COMPLETE)
def wait_oriented(task: Task, message: EMC_SPINDLE_WAIT_ORIENT_COMPLETE) -> None:
    """A client sees the end in orient_state; there is nothing that task could hold back for it."""
