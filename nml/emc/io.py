"""The I/O controller as a whole. Manual, chapter 4.13."""

from __future__ import annotations

from nml.emc.auxiliary import EMC_AUX_STAT
from nml.emc.coolant import EMC_COOLANT_STAT
from nml.emc.lube import EMC_LUBE_STAT
from nml.emc.tool import EMC_TOOL_STAT
from nml.message import Command, Status, double, integer, struct, uint


class EMC_IO_CMD_MSG(Command):
    """A command to the I/O controller as a whole."""


class EMC_IO_INIT(EMC_IO_CMD_MSG, type_id=1601):
    """Initialise the I/O controller."""


class EMC_IO_HALT(EMC_IO_CMD_MSG, type_id=1602):
    """Shut the I/O controller down."""


class EMC_IO_ABORT(EMC_IO_CMD_MSG, type_id=1603):
    """Stop what the I/O controller is doing."""


class EMC_IO_SET_CYCLE_TIME(EMC_IO_CMD_MSG, type_id=1604):
    """Set its period."""

    cycleTime = double(unit="s")


class EMC_IO_STAT_MSG(Status):
    """What the status of the I/O controller begins with."""

    heartbeat = uint(doc="counts cycles")


class EMC_IO_STAT(EMC_IO_STAT_MSG, type_id=1699):
    """The status of the I/O controller."""

    cycleTime = double(unit="s")
    debug = integer(doc="EMC_DEBUG_FLAGS")
    reason = integer(doc="of a changer's fault, iocontrol.0.toolchanger-reason", local=True)
    fault = integer(doc="the changer reports a fault", local=True)
    tool = struct(EMC_TOOL_STAT)
    coolant = struct(EMC_COOLANT_STAT)
    aux = struct(EMC_AUX_STAT)
    lube = struct(EMC_LUBE_STAT)
