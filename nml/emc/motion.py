"""Motion as a whole: synchronised inputs and outputs, and the status of everything that moves. Manual, chapter 4.6."""

from __future__ import annotations

from nml.emc.axis import EMC_AXIS_STAT
from nml.emc.constants import MAX_AIO, MAX_AXES, MAX_DIO, MAX_JOINTS, MAX_MISC_ERROR, MAX_SPINDLES
from nml.emc.joint import EMC_JOINT_STAT
from nml.emc.spindle import EMC_SPINDLE_STAT
from nml.emc.structs import EmcPose
from nml.emc.traj import EMC_TRAJ_STAT
from nml.message import Command, Status, boolean, double, integer, struct, uchar, uint


class EMC_MOTION_CMD_MSG(Command):
    """A command to motion as a whole."""


class EMC_MOTION_INIT(EMC_MOTION_CMD_MSG, type_id=301):
    """Initialise motion."""


class EMC_MOTION_HALT(EMC_MOTION_CMD_MSG, type_id=302):
    """Shut motion down."""


class EMC_MOTION_ABORT(EMC_MOTION_CMD_MSG, type_id=303):
    """Stop all motion."""


class EMC_MOTION_SET_AOUT(EMC_MOTION_CMD_MSG, type_id=304):
    """Set an analogue output, at once or in step with motion (M67, M68)."""

    index = uchar(doc="output number")
    start = double(doc="value at the start of the next move, or at once")
    end = double(doc="value at its end")
    now = uchar(doc="1: at once")


class EMC_MOTION_SET_DOUT(EMC_MOTION_CMD_MSG, type_id=305):
    """Set a digital output, at once or in step with motion (M62 to M65)."""

    index = uchar(doc="output number")
    start = uchar(doc="value at the start of the next move, or at once")
    end = uchar(doc="value at its end")
    now = uchar(doc="1: at once")


class EMC_MOTION_ADAPTIVE(EMC_MOTION_CMD_MSG, type_id=306):
    """Turn adaptive feed on or off (M52)."""

    status = uchar(doc="1: on")


class EMC_MOTION_STAT_MSG(Status):
    """What the status of motion begins with."""

    heartbeat = uint(doc="counts cycles")


class EMC_MOTION_STAT(EMC_MOTION_STAT_MSG, type_id=399):
    """The status of everything that moves."""

    traj = struct(EMC_TRAJ_STAT)
    joint = struct(EMC_JOINT_STAT, MAX_JOINTS)
    axis = struct(EMC_AXIS_STAT, MAX_AXES, local=True)
    spindle = struct(EMC_SPINDLE_STAT, MAX_SPINDLES, local=True)
    synch_di = integer(MAX_DIO, doc="motion.digital-in-NN", local=True)
    synch_do = integer(MAX_DIO, doc="motion.digital-out-NN", local=True)
    analog_input = double(MAX_AIO, doc="motion.analog-in-NN", local=True)
    analog_output = double(MAX_AIO, doc="motion.analog-out-NN", local=True)
    misc_error = integer(MAX_MISC_ERROR, doc="motion.misc-error-NN", local=True)
    debug = integer(doc="EMC_DEBUG_FLAGS")
    on_soft_limit = integer(local=True)
    external_offsets_applied = integer(local=True)
    eoffset_pose = struct(EmcPose, unit="lu, deg", doc="external offsets in force", local=True)
    numExtraJoints = integer(local=True)
    jogging_active = boolean(local=True)
