"""Jogs of joints (free mode) and axes (teleop mode). Manual, chapter 4.4."""

from __future__ import annotations

from nml.message import Command, double, integer


class EMC_JOG_CMD_MSG(Command):
    """A jog of a joint or an axis."""

    joint_or_axis = integer(doc="index of the joint, or of the axis (0 to 8: x y z a b c u v w)")


class EMC_JOG_CONT(EMC_JOG_CMD_MSG, type_id=124):
    """Jog until told to stop, or a limit is reached."""

    vel = double(unit="lu/s, deg/s", doc="signed")
    jjogmode = integer(doc="1: a joint jog, 0: an axis jog")


class EMC_JOG_INCR(EMC_JOG_CMD_MSG, type_id=125):
    """Jog by a distance."""

    incr = double(unit="lu, deg")
    vel = double(unit="lu/s, deg/s", doc="signed: which way")
    jjogmode = integer(doc="1: a joint jog, 0: an axis jog")


class EMC_JOG_ABS(EMC_JOG_CMD_MSG, type_id=126):
    """Jog to a position."""

    pos = double(unit="lu, deg")
    vel = double(unit="lu/s, deg/s")
    jjogmode = integer(doc="1: a joint jog, 0: an axis jog")


class EMC_JOG_STOP(EMC_JOG_CMD_MSG, type_id=136):
    """Stop a jog."""

    jjogmode = integer(doc="1: a joint jog, 0: an axis jog")
