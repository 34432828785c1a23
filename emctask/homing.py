"""The homing cycle that a program asks for (G28.2): out of coordinated motion, home, and back.

Motion homes joints only in joint mode, so it is taken there for as long as that lasts; task's own mode stays. A cycle
that fails leaves motion in joint mode, and the program is aborted; whatever runs next begins in coordinated mode again.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from emctask.config import JointConfig
from emctask.interplist import ExecutionError
from emctask.motion import MotionClient
from nml.emc.emcmot import MotCommand, MotionState

ALL = -1
FIRST_EXCLUDED_SEQUENCE = 100  # joints with this HOME_SEQUENCE or above do not home with the others

Homing = Iterator[None]
"""Goes on by one look at motion each time; over when motion is where it was and the joints are homed."""


def home(motion: MotionClient, joints: Sequence[JointConfig], joint: int) -> Homing:
    """Home a joint with those that home together with it, or all (-1); ExecutionError when that cannot be."""
    return _cycle(motion, _wanted(joints, joint), joint)


def _wanted(joints: Sequence[JointConfig], joint: int) -> list[int]:
    """The joints that must be homed afterwards."""
    if joint != ALL:
        if joint < len(joints):
            return [joint]
        raise ExecutionError(
            f"there is no joint {joint} to home; this machine has joints 0 to {len(joints) - 1}, and P-1 homes them all"
        )
    wanted = [number for number, each in enumerate(joints) if abs(each.home_sequence) < FIRST_EXCLUDED_SEQUENCE]
    if not wanted:
        raise ExecutionError("G28.2 P-1 cannot home the joints: none of them has a HOME_SEQUENCE")
    return wanted


def _cycle(motion: MotionClient, wanted: list[int], joint: int) -> Homing:
    motion.send(MotCommand.FREE)
    while not motion.echoed or motion.state is not MotionState.FREE:
        yield
    motion.send(MotCommand.JOINT_HOME, joint=joint)
    while not motion.settled or motion.homing:
        yield
    missing = [number for number in wanted if not motion.status.joint_status[number].homed]
    if missing:
        raise ExecutionError(f"G28.2: joint {missing[0]} is not homed; the program cannot go on")
    motion.send(MotCommand.COORD)
    while not motion.echoed or motion.state is not MotionState.COORD:
        yield
