"""A simulated three-axis mill in the stepped simulator: limits 100 lu/s, 1000 lu/s2, +-100 lu, immediate homing."""

from __future__ import annotations

from typing import Any

from emcmot.sim import Motion
from nml.emc.emcmot import MotCommand as C

VEL, ACC, LIMIT = 100.0, 1000.0, 100.0


def configure(m: Motion, *, vel: float = VEL, acc: float = ACC, limit: float = LIMIT, axes: int = 3) -> Motion:
    """Tell motion what task tells it at its start."""
    for joint in range(m.kinematics.joints):
        m.send(C.SET_JOINT_POSITION_LIMITS, joint=joint, minLimit=-limit, maxLimit=limit)
        m.send(C.SET_JOINT_VEL_LIMIT, joint=joint, vel=vel)
        m.send(C.SET_JOINT_ACC_LIMIT, joint=joint, acc=acc)
        m.send(C.SET_JOINT_MIN_FERROR, joint=joint, minFerror=0.5)
        m.send(C.SET_JOINT_MAX_FERROR, joint=joint, maxFerror=1.0)
        m.send(C.SET_JOINT_HOMING_PARAMS, joint=joint, home_sequence=joint)
        m.send(C.JOINT_ACTIVATE, joint=joint)
    for axis in range(axes):
        m.send(C.SET_AXIS_POSITION_LIMITS, axis=axis, minLimit=-limit, maxLimit=limit)
        m.send(C.SET_AXIS_VEL_LIMIT, axis=axis, vel=vel)
        m.send(C.SET_AXIS_ACC_LIMIT, axis=axis, acc=acc)
    m.step(2)
    assert m.errors() == []
    return m


def bring_to(m: Motion, state: str) -> Motion:
    """``off``, ``free`` (not homed), ``homed`` (free), ``teleop`` or ``coord``."""
    if state == "off":
        return m
    m.send(C.ENABLE)
    m.step(2)
    if state == "free":
        return m
    m.send(C.JOINT_HOME, joint=-1)
    m.run_until_rest()
    if state in ("teleop", "coord"):
        m.send(C[state.upper()])
        m.step(2)
    assert m.errors() == []
    return m


def line(m: Motion, *pos: float, id: int = 1, vel: float = 30.0, **more: Any) -> int:
    """Queue a straight feed move; the command's status."""
    fields = {"ini_maxvel": VEL, "acc": ACC, "termCond": 2, "motion_type": 2} | more
    return int(m.send(C.SET_LINE, id=id, pos=(*pos, *[0.0] * (9 - len(pos))), vel=vel, **fields))


def mill(state: str = "coord", **limits: float) -> Motion:
    """A configured mill in that state."""
    return bring_to(configure(Motion("xyz"), **limits), state)
