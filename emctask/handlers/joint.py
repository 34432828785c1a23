"""JOINT: homing, limits and the settings of single joints. Manual, chapter 4.2."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from emctask.commandtable import ANY, MANUAL, PassedOver, Refused, command, passed_over, refuse
from emctask.compensation import read_compensation
from emctask.config import HOME_IGNORE_LIMITS, HOME_UNLOCK_FIRST, HOME_USE_INDEX
from emctask.setup import send_compensation, send_homing
from nml.emc import (
    EMC_JOINT_ABORT,
    EMC_JOINT_ACTIVATE,
    EMC_JOINT_DEACTIVATE,
    EMC_JOINT_DISABLE,
    EMC_JOINT_ENABLE,
    EMC_JOINT_HALT,
    EMC_JOINT_HOME,
    EMC_JOINT_INIT,
    EMC_JOINT_LOAD_COMP,
    EMC_JOINT_OVERRIDE_LIMITS,
    EMC_JOINT_SET_BACKLASH,
    EMC_JOINT_SET_FERROR,
    EMC_JOINT_SET_HOMING_PARAMS,
    EMC_JOINT_SET_JOINT,
    EMC_JOINT_SET_MAX_POSITION_LIMIT,
    EMC_JOINT_SET_MAX_VELOCITY,
    EMC_JOINT_SET_MIN_FERROR,
    EMC_JOINT_SET_MIN_POSITION_LIMIT,
    EMC_JOINT_SET_UNITS,
    EMC_JOINT_UNHOME,
)
from nml.emc.constants import EMC_TASK_MODE_ENUM as Mode
from nml.emc.emcmot import MotCommand
from nml.errors import ConfigError
from nml.message import Message

if TYPE_CHECKING:
    from emctask.config import JointConfig
    from emctask.task import Task

ALL = -1
VOLATILE = -2


def _joint(task: Task, number: int, *special: int) -> int:
    count = len(task.config.joints)
    if not 0 <= number < count and number not in special:
        raise PassedOver(f"there is no joint {number}; this machine has joints 0 to {count - 1}")
    return number


@command(EMC_JOINT_HOME, on=True, modes=MANUAL)
def home(task: Task, message: EMC_JOINT_HOME) -> None:
    """Home a joint, or all in their sequence (-1)."""
    task.motion.send(MotCommand.JOINT_HOME, joint=_joint(task, message.joint, ALL))
    task.supervisor.homing_ordered()
    task.plan.must_synch = True


@command(EMC_JOINT_UNHOME, modes=MANUAL, refusal=passed_over)
def unhome(task: Task, message: EMC_JOINT_UNHOME) -> None:
    """Forget where a joint is; -1: all, -2: those with a volatile home."""
    task.motion.send(MotCommand.JOINT_UNHOME, joint=_joint(task, message.joint, ALL, VOLATILE))


@command(EMC_JOINT_OVERRIDE_LIMITS, modes=MANUAL)
def override_limits(task: Task, message: EMC_JOINT_OVERRIDE_LIMITS) -> None:
    """Let the next jog move off a limit switch; below 0: no longer."""
    task.motion.send(MotCommand.OVERRIDE_LIMITS, joint=message.joint)


@command(EMC_JOINT_ABORT)
def abort(task: Task, message: EMC_JOINT_ABORT) -> None:
    """Stop a joint that jogs or homes."""
    task.motion.send(MotCommand.JOG_ABORT, joint=_joint(task, message.joint), axis=-1, mode=1)


@command(EMC_JOINT_ACTIVATE)
def activate(task: Task, message: EMC_JOINT_ACTIVATE) -> None:
    """Let motion look after a joint."""
    task.motion.send(MotCommand.JOINT_ACTIVATE, joint=_joint(task, message.joint))


@command(EMC_JOINT_DEACTIVATE)
def deactivate(task: Task, message: EMC_JOINT_DEACTIVATE) -> None:
    """Let motion ignore a joint."""
    task.motion.send(MotCommand.JOINT_DEACTIVATE, joint=_joint(task, message.joint))


@command(EMC_JOINT_ENABLE, on=True)
def enable(task: Task, message: EMC_JOINT_ENABLE) -> None:
    """Switch a joint's amplifier on."""
    task.motion.send(MotCommand.JOINT_ENABLE_AMPLIFIER, joint=_joint(task, message.joint))


@command(EMC_JOINT_DISABLE)
def disable(task: Task, message: EMC_JOINT_DISABLE) -> None:
    """Switch a joint's amplifier off."""
    task.motion.send(MotCommand.JOINT_DISABLE_AMPLIFIER, joint=_joint(task, message.joint))


def _setting(
    message_type: type[Message],
    source: str,
    attribute: str,
    send: Callable[[Task, int, JointConfig], None],
    modes: frozenset[Mode] = ANY,
) -> None:
    """A command that changes one value of a joint: remembered, and sent to motion with its companions.

    One that is for some modes only is for a machine that is on.
    """

    def handler(task: Task, message: Any) -> None:
        number = _joint(task, message.joint)
        joint = task.config.joints[number]
        setattr(joint, attribute, getattr(message, source))
        send(task, number, joint)

    handler.__doc__ = f"Set {attribute} of a joint."
    command(message_type, on=modes is not ANY, modes=modes)(handler)


def _send_limits(task: Task, number: int, joint: JointConfig) -> None:
    if joint.min_limit >= joint.max_limit:
        raise Refused(f"joint {number}: the limits {joint.min_limit:g} and {joint.max_limit:g} leave no room")
    fields = {"minLimit": joint.min_limit, "maxLimit": joint.max_limit}
    task.motion.send(MotCommand.SET_JOINT_POSITION_LIMITS, joint=number, **fields)


_setting(EMC_JOINT_SET_MIN_POSITION_LIMIT, "limit", "min_limit", _send_limits, MANUAL)
_setting(EMC_JOINT_SET_MAX_POSITION_LIMIT, "limit", "max_limit", _send_limits, MANUAL)


def _sender(order: MotCommand, field: str, attribute: str) -> Callable[[Task, int, JointConfig], None]:
    def send(task: Task, number: int, joint: JointConfig) -> None:
        task.motion.send(order, joint=number, **{field: getattr(joint, attribute)})

    return send


for _message, _source, _attribute, _order, _field in (
    (EMC_JOINT_SET_FERROR, "ferror", "ferror", MotCommand.SET_JOINT_MAX_FERROR, "maxFerror"),
    (EMC_JOINT_SET_MIN_FERROR, "ferror", "min_ferror", MotCommand.SET_JOINT_MIN_FERROR, "minFerror"),
    (EMC_JOINT_SET_BACKLASH, "backlash", "backlash", MotCommand.SET_JOINT_BACKLASH, "backlash"),
    (EMC_JOINT_SET_MAX_VELOCITY, "vel", "max_velocity", MotCommand.SET_JOINT_VEL_LIMIT, "vel"),
):
    _setting(_message, _source, _attribute, _sender(_order, _field, _attribute))


@command(EMC_JOINT_SET_HOMING_PARAMS)
def set_homing(task: Task, message: EMC_JOINT_SET_HOMING_PARAMS) -> None:
    """Change how a joint homes; what the message does not carry stays as it was."""
    number = _joint(task, message.joint)
    joint = task.config.joints[number]
    joint.home, joint.home_offset = message.home, message.offset
    joint.home_final_vel = message.home_final_vel
    joint.home_search_vel, joint.home_latch_vel = message.search_vel, message.latch_vel
    joint.volatile_home = bool(message.volatile_home)
    switches = (
        (HOME_USE_INDEX, message.use_index),
        (HOME_IGNORE_LIMITS, message.ignore_limits),
        (HOME_UNLOCK_FIRST, message.locking_indexer),
    )
    for bit, on in switches:
        joint.home_flags = joint.home_flags | bit if on else joint.home_flags & ~bit
    send_homing(task.motion, number, joint)


@command(EMC_JOINT_LOAD_COMP)
def load_compensation(task: Task, message: EMC_JOINT_LOAD_COMP) -> None:
    """Read a screw compensation file."""
    number = _joint(task, message.joint)
    try:
        rows = read_compensation(Path(message.file), message.type)
    except ConfigError as error:
        raise Refused(str(error)) from None
    send_compensation(task.motion, number, rows)


@command(EMC_JOINT_INIT, EMC_JOINT_HALT)
def nothing(task: Task, message: Message) -> None:
    """Joints begin and end with the machine."""


refuse([EMC_JOINT_SET_JOINT, EMC_JOINT_SET_UNITS], "a joint's type and units come from the INI file")
