"""JOG: continuous, incremental, absolute jogs of joints and axes. Manual, chapter 4.4."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask.commandtable import MANUAL, PassedOver, command, error_in_auto
from nml.emc import EMC_JOG_ABS, EMC_JOG_CONT, EMC_JOG_INCR, EMC_JOG_STOP
from nml.emc.emcmot import MotCommand

if TYPE_CHECKING:
    from emctask.task import Task

Jog = EMC_JOG_ABS | EMC_JOG_CONT | EMC_JOG_INCR | EMC_JOG_STOP


def _target(task: Task, message: Jog) -> dict[str, int]:
    """Fields that say what is jogged: a joint (``jjogmode``) or an axis."""
    number = message.joint_or_axis
    if message.jjogmode:
        if not 0 <= number < len(task.config.joints):
            last = len(task.config.joints) - 1
            raise PassedOver(f"joint {number} cannot be jogged; this machine has joints 0 to {last}")
        return {"joint": number, "axis": -1, "mode": 1}
    if number not in task.config.axes:
        letters = "".join("XYZABCUVW"[axis] for axis in sorted(task.config.axes))
        raise PassedOver(f"axis {number} cannot be jogged; this machine has the axes {letters}")
    return {"joint": -1, "axis": number, "mode": 0}


@command(EMC_JOG_CONT, on=True, modes=MANUAL, refusal=error_in_auto)
def continuous(task: Task, message: EMC_JOG_CONT) -> None:
    """Until it is stopped, or a limit is reached."""
    task.motion.send(MotCommand.JOG_CONT, vel=message.vel, **_target(task, message))


@command(EMC_JOG_INCR, on=True, modes=MANUAL, refusal=error_in_auto)
def increment(task: Task, message: EMC_JOG_INCR) -> None:
    """By a distance."""
    task.motion.send(MotCommand.JOG_INCR, vel=message.vel, offset=message.incr, **_target(task, message))


@command(EMC_JOG_ABS, on=True, modes=MANUAL, refusal=error_in_auto)
def absolute(task: Task, message: EMC_JOG_ABS) -> None:
    """To a position."""
    task.motion.send(MotCommand.JOG_ABS, vel=message.vel, offset=message.pos, **_target(task, message))


@command(EMC_JOG_STOP)
def stop(task: Task, message: EMC_JOG_STOP) -> None:
    """End a jog; allowed at any time."""
    task.motion.send(MotCommand.JOG_ABORT, **_target(task, message))
