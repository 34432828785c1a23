"""TRAJ and MOTION: overrides, limits of the path, teleop, digital and analog outputs. Manual, chapters 4.5 and 4.6."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask import transitions
from emctask.commandtable import NEVER, UNDER_WAY, PassedOver, Refused, always, command, refuse
from nml.emc import (
    EMC_MOTION_ABORT,
    EMC_MOTION_ADAPTIVE,
    EMC_MOTION_HALT,
    EMC_MOTION_INIT,
    EMC_MOTION_SET_AOUT,
    EMC_MOTION_SET_DOUT,
    EMC_TRAJ_ABORT,
    EMC_TRAJ_CIRCULAR_MOVE,
    EMC_TRAJ_CLEAR_PROBE_TRIPPED_FLAG,
    EMC_TRAJ_DELAY,
    EMC_TRAJ_DISABLE,
    EMC_TRAJ_ENABLE,
    EMC_TRAJ_HALT,
    EMC_TRAJ_INIT,
    EMC_TRAJ_LINEAR_MOVE,
    EMC_TRAJ_PAUSE,
    EMC_TRAJ_PROBE,
    EMC_TRAJ_RESUME,
    EMC_TRAJ_RIGID_TAP,
    EMC_TRAJ_SET_ACCELERATION,
    EMC_TRAJ_SET_AXES,
    EMC_TRAJ_SET_CYCLE_TIME,
    EMC_TRAJ_SET_FH_ENABLE,
    EMC_TRAJ_SET_FO_ENABLE,
    EMC_TRAJ_SET_G5X,
    EMC_TRAJ_SET_G92,
    EMC_TRAJ_SET_HOME,
    EMC_TRAJ_SET_MAX_ACCELERATION,
    EMC_TRAJ_SET_MAX_VELOCITY,
    EMC_TRAJ_SET_MODE,
    EMC_TRAJ_SET_MOTION_ID,
    EMC_TRAJ_SET_OFFSET,
    EMC_TRAJ_SET_RAPID_SCALE,
    EMC_TRAJ_SET_ROTATION,
    EMC_TRAJ_SET_SCALE,
    EMC_TRAJ_SET_SO_ENABLE,
    EMC_TRAJ_SET_SPINDLE_SCALE,
    EMC_TRAJ_SET_SPINDLESYNC,
    EMC_TRAJ_SET_TELEOP_ENABLE,
    EMC_TRAJ_SET_TERM_COND,
    EMC_TRAJ_SET_UNITS,
    EMC_TRAJ_SET_VELOCITY,
    EMC_TRAJ_STEP,
)
from nml.emc.constants import EMC_IO_ABORT_REASON_ENUM as Reason
from nml.emc.constants import EMC_TASK_MODE_ENUM as Mode
from nml.emc.constants import EMC_TASK_STATE_ENUM as State
from nml.emc.emcmot import MAX_AIO, MAX_DIO, MotCommand
from nml.message import Message

if TYPE_CHECKING:
    from emctask.task import Task


def check_spindle(task: Task, number: int, *special: int) -> int:
    """A spindle number of a command; Refused when the machine has no such spindle."""
    count = len(task.config.spindles)
    if not 0 <= number < count and number not in special:
        raise Refused(f"there is no spindle {number}; this machine has {count}")
    return number


@command(EMC_TRAJ_SET_SCALE)
def feed_override(task: Task, message: EMC_TRAJ_SET_SCALE) -> None:
    """Feed override, 1 is 100 percent; motion knows the largest."""
    task.motion.send(MotCommand.FEED_SCALE, scale=max(0.0, message.scale))


@command(EMC_TRAJ_SET_RAPID_SCALE)
def rapid_override(task: Task, message: EMC_TRAJ_SET_RAPID_SCALE) -> None:
    """Rapid override, 0 to 1."""
    task.motion.send(MotCommand.RAPID_SCALE, scale=min(max(0.0, message.scale), 1.0))


@command(EMC_TRAJ_SET_SPINDLE_SCALE)
def spindle_override(task: Task, message: EMC_TRAJ_SET_SPINDLE_SCALE) -> None:
    """Spindle override, 1 is 100 percent."""
    spindle = check_spindle(task, message.spindle)
    task.motion.send(MotCommand.SPINDLE_SCALE, spindle=spindle, scale=max(0.0, message.scale))


@command(EMC_TRAJ_SET_FO_ENABLE)
def enable_feed_override(task: Task, message: EMC_TRAJ_SET_FO_ENABLE) -> None:
    """The feed override acts, or does not."""
    task.motion.send(MotCommand.FS_ENABLE, mode=message.mode)


@command(EMC_TRAJ_SET_SO_ENABLE)
def enable_spindle_override(task: Task, message: EMC_TRAJ_SET_SO_ENABLE) -> None:
    """The spindle override acts, or does not."""
    spindle = check_spindle(task, message.spindle)
    task.motion.send(MotCommand.SS_ENABLE, spindle=spindle, mode=message.mode)


@command(EMC_TRAJ_SET_FH_ENABLE)
def enable_feed_hold(task: Task, message: EMC_TRAJ_SET_FH_ENABLE) -> None:
    """The feed hold pin acts, or does not."""
    task.motion.send(MotCommand.FH_ENABLE, mode=message.mode)


@command(EMC_MOTION_ADAPTIVE)
def enable_adaptive_feed(task: Task, message: EMC_MOTION_ADAPTIVE) -> None:
    """The adaptive feed pin acts, or does not."""
    task.motion.send(MotCommand.AF_ENABLE, mode=message.status)


@command(EMC_TRAJ_SET_MAX_VELOCITY)
def set_max_velocity(task: Task, message: EMC_TRAJ_SET_MAX_VELOCITY) -> None:
    """No move is faster than this along its path; never above the INI file's maximum."""
    velocity = min(max(0.0, message.velocity), task.config.max_velocity)
    task.motion.send(MotCommand.SET_VEL_LIMIT, vel=velocity)


@command(EMC_TRAJ_SET_VELOCITY)
def set_velocity(task: Task, message: EMC_TRAJ_SET_VELOCITY) -> None:
    """Velocity of moves that bring none of their own."""
    task.motion.send(MotCommand.SET_VEL, vel=message.velocity, ini_maxvel=message.ini_maxvel)


@command(EMC_TRAJ_SET_ACCELERATION, EMC_TRAJ_SET_MAX_ACCELERATION)
def set_acceleration(task: Task, message: EMC_TRAJ_SET_ACCELERATION) -> None:
    """Largest path acceleration; never above the INI file's maximum."""
    acceleration = min(message.acceleration, task.config.max_acceleration)
    if acceleration <= 0.0:
        raise Refused(f"an acceleration of {message.acceleration:g} never moves; a number above 0 is needed")
    task.motion.send(MotCommand.SET_ACC, acc=acceleration)


@command(EMC_TRAJ_SET_TELEOP_ENABLE, idle=True)
def teleop(task: Task, message: EMC_TRAJ_SET_TELEOP_ENABLE) -> None:
    """Jog axes, or single joints: manual mode."""
    task.mode = Mode.MANUAL
    transitions.choose_jogs(task, axes=bool(message.enable))


@command(EMC_TRAJ_SET_MODE, on=True, modes=NEVER)
def set_mode(task: Task, message: EMC_TRAJ_SET_MODE) -> None:
    """Refused in every mode, as in LinuxCNC: the mode of motion follows task's, and TELEOP_ENABLE."""


@command(EMC_TRAJ_CLEAR_PROBE_TRIPPED_FLAG)
def clear_probe(task: Task, message: EMC_TRAJ_CLEAR_PROBE_TRIPPED_FLAG) -> None:
    """Forget that the probe has tripped."""
    task.motion.send(MotCommand.CLEAR_PROBE_FLAGS)


@command(EMC_TRAJ_ABORT, EMC_MOTION_ABORT, urgent=always)
def abort(task: Task, message: Message) -> None:
    """Stop motion; the program that commands it cannot go on without it."""
    task.runner.abort(Reason.TASK_ABORT)


@command(EMC_TRAJ_PAUSE)
def pause(task: Task, message: EMC_TRAJ_PAUSE) -> None:
    """Hold motion."""
    task.runner.pause()


@command(EMC_TRAJ_RESUME)
def resume(task: Task, message: EMC_TRAJ_RESUME) -> None:
    """Let motion go on."""
    task.runner.resume()


@command(EMC_TRAJ_STEP)
def step(task: Task, message: EMC_TRAJ_STEP) -> None:
    """Let motion go on to the end of a move."""
    task.runner.step()


@command(EMC_TRAJ_ENABLE)
def enable(task: Task, message: EMC_TRAJ_ENABLE) -> None:
    """Switch motion on, if the machine is not in E-stop."""
    if task.state is State.ESTOP:
        raise Refused("motion cannot be switched on in E-stop; reset the E-stop first")
    task.motion.send(MotCommand.ENABLE)


@command(EMC_TRAJ_DISABLE)
def disable(task: Task, message: EMC_TRAJ_DISABLE) -> None:
    """Switch motion off."""
    task.motion.send(MotCommand.DISABLE)


@command(EMC_MOTION_SET_DOUT, unless=UNDER_WAY)
def set_digital(task: Task, message: EMC_MOTION_SET_DOUT) -> None:
    """Set a digital output."""
    if message.index >= MAX_DIO:
        raise PassedOver(f"there is no digital output {message.index}; 0 to {MAX_DIO - 1} are")
    fields = {"now": message.now, "out": message.index, "start": message.start, "end": message.end}
    task.motion.send(MotCommand.SET_DOUT, **fields)


@command(EMC_MOTION_SET_AOUT, unless=UNDER_WAY)
def set_analog(task: Task, message: EMC_MOTION_SET_AOUT) -> None:
    """Set an analog output."""
    if message.index >= MAX_AIO:
        raise PassedOver(f"there is no analog output {message.index}; 0 to {MAX_AIO - 1} are")
    task.motion.send(
        MotCommand.SET_AOUT, now=message.now, out=message.index, minLimit=message.start, maxLimit=message.end
    )


@command(EMC_TRAJ_SET_HOME)
def set_world_home(task: Task, message: EMC_TRAJ_SET_HOME) -> None:
    """Where the machine is, in world coordinates, when its joints are homed."""
    task.motion.send(MotCommand.SET_WORLD_HOME, pos=message.home)


@command(EMC_TRAJ_INIT, EMC_TRAJ_HALT, EMC_MOTION_INIT, EMC_MOTION_HALT)
def nothing(task: Task, message: Message) -> None:
    """Motion begins and ends with the machine."""


refuse(
    [EMC_TRAJ_SET_AXES, EMC_TRAJ_SET_UNITS, EMC_TRAJ_SET_CYCLE_TIME],
    "axes, units and cycle time come from the INI file",
)
refuse(
    [
        EMC_TRAJ_CIRCULAR_MOVE,
        EMC_TRAJ_DELAY,
        EMC_TRAJ_LINEAR_MOVE,
        EMC_TRAJ_PROBE,
        EMC_TRAJ_RIGID_TAP,
        EMC_TRAJ_SET_G5X,
        EMC_TRAJ_SET_G92,
        EMC_TRAJ_SET_MOTION_ID,
        EMC_TRAJ_SET_OFFSET,
        EMC_TRAJ_SET_ROTATION,
        EMC_TRAJ_SET_SPINDLESYNC,
        EMC_TRAJ_SET_TERM_COND,
    ],
    "the interpreter alone makes it, so that it knows where the machine is; use MDI",
)
