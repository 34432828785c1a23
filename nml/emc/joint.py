"""Joints: limits, homing, activation and the status of one joint. Manual, chapter 4.2."""

from __future__ import annotations

from nml.emc.constants import LINELEN
from nml.message import Command, Status, char, double, integer, uchar


class EMC_JOINT_CMD_MSG(Command):
    """A command to one joint."""

    joint = integer(doc="joint index")


class EMC_JOINT_SET_JOINT(EMC_JOINT_CMD_MSG, type_id=101):
    """Declare a joint and its kind."""

    jointType = uchar(doc="EmcJointType")


class EMC_JOINT_SET_UNITS(EMC_JOINT_CMD_MSG, type_id=102):
    """Set a joint's units."""

    units = double(doc="units per mm, or per degree")


class EMC_JOINT_SET_MIN_POSITION_LIMIT(EMC_JOINT_CMD_MSG, type_id=107):
    """Set the negative soft limit."""

    limit = double(unit="lu, deg")


class EMC_JOINT_SET_MAX_POSITION_LIMIT(EMC_JOINT_CMD_MSG, type_id=108):
    """Set the positive soft limit."""

    limit = double(unit="lu, deg")


class EMC_JOINT_SET_FERROR(EMC_JOINT_CMD_MSG, type_id=111):
    """Set the following error that is allowed at the joint's largest velocity."""

    ferror = double(unit="lu, deg")


class EMC_JOINT_SET_HOMING_PARAMS(EMC_JOINT_CMD_MSG, type_id=112):
    """Set how a joint homes."""

    home = double(unit="lu, deg", doc="position to be at after homing")
    offset = double(unit="lu, deg", doc="position of the switch or index pulse")
    home_final_vel = double(unit="lu/s, deg/s", doc="negative: rapid")
    search_vel = double(unit="lu/s, deg/s", doc="signed; 0: no switch")
    latch_vel = double(unit="lu/s, deg/s", doc="signed")
    use_index = integer()
    encoder_does_not_reset = integer(local=True)
    ignore_limits = integer()
    is_shared = integer(doc="the home switch is shared with other joints", local=True)
    home_sequence = integer(doc="-1: not in home-all; negative ones move together", local=True)
    volatile_home = integer(doc="forgotten when the machine is turned off")
    locking_indexer = integer()
    absolute_encoder = integer(doc="0 no, 1 and 2: which moves to leave out", local=True)


class EMC_JOINT_SET_MIN_FERROR(EMC_JOINT_CMD_MSG, type_id=115):
    """Set the following error that is allowed at rest."""

    ferror = double(unit="lu, deg")


class EMC_JOINT_SET_MAX_VELOCITY(EMC_JOINT_CMD_MSG, type_id=116):
    """Set the largest velocity of a joint."""

    vel = double(unit="lu/s, deg/s")


class EMC_JOINT_INIT(EMC_JOINT_CMD_MSG, type_id=118):
    """Initialise a joint."""


class EMC_JOINT_HALT(EMC_JOINT_CMD_MSG, type_id=119):
    """Shut a joint down."""


class EMC_JOINT_ABORT(EMC_JOINT_CMD_MSG, type_id=120):
    """Stop what a joint is doing."""


class EMC_JOINT_ENABLE(EMC_JOINT_CMD_MSG, type_id=121):
    """Enable a joint's amplifier."""


class EMC_JOINT_DISABLE(EMC_JOINT_CMD_MSG, type_id=122):
    """Disable a joint's amplifier."""


class EMC_JOINT_HOME(EMC_JOINT_CMD_MSG, type_id=123):
    """Home a joint; -1 homes all in their sequence."""


class EMC_JOINT_ACTIVATE(EMC_JOINT_CMD_MSG, type_id=127):
    """Let a joint take part in motion."""


class EMC_JOINT_DEACTIVATE(EMC_JOINT_CMD_MSG, type_id=128):
    """Take a joint out of motion."""


class EMC_JOINT_OVERRIDE_LIMITS(EMC_JOINT_CMD_MSG, type_id=129):
    """Allow jogging off a hard limit until the jog ends; -1 ends the override."""


class EMC_JOINT_LOAD_COMP(EMC_JOINT_CMD_MSG, type_id=131):
    """Load a screw compensation file."""

    file = char(LINELEN, wire=LINELEN + 1, doc="path")
    type = integer(doc="0: nominal, forward, reverse; 1: nominal and the two corrections")


class EMC_JOINT_SET_BACKLASH(EMC_JOINT_CMD_MSG, type_id=134):
    """Set a joint's backlash."""

    backlash = double(unit="lu, deg")


class EMC_JOINT_UNHOME(EMC_JOINT_CMD_MSG, type_id=135):
    """Forget that a joint is homed; -1: all, -2: the volatile ones."""


class EMC_JOINT_STAT_MSG(Status):
    """What the status of a joint begins with."""

    joint = integer(doc="joint index")


class EMC_JOINT_STAT(EMC_JOINT_STAT_MSG, type_id=198):
    """The status of one joint."""

    jointType = uchar(doc="EmcJointType")
    units = double(doc="units per mm, or per degree")
    backlash = double(unit="lu, deg")
    minPositionLimit = double(unit="lu, deg")
    maxPositionLimit = double(unit="lu, deg")
    maxFerror = double(unit="lu, deg")
    minFerror = double(unit="lu, deg")
    ferrorCurrent = double(unit="lu, deg")
    ferrorHighMark = double(unit="lu, deg", doc="largest since the machine was turned on")
    output = double(unit="lu, deg", doc="commanded position")
    input = double(unit="lu, deg", doc="position fed back")
    velocity = double(unit="lu/s, deg/s", doc="commanded")
    inpos = uchar(doc="not moving")
    homing = uchar()
    homed = uchar()
    fault = uchar(doc="amplifier fault")
    enabled = uchar()
    minSoftLimit = uchar(doc="at the negative soft limit")
    maxSoftLimit = uchar(doc="at the positive soft limit")
    minHardLimit = uchar(doc="on the negative switch")
    maxHardLimit = uchar(doc="on the positive switch")
    overrideLimits = uchar(doc="hard limits are being overridden")
