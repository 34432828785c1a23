"""The whole controller: its status as clients see it, and messages to all of it. Manual, chapter 4.14."""

from __future__ import annotations

from nml.emc.constants import SYSTEM_CMD_LEN
from nml.emc.io import EMC_IO_STAT
from nml.emc.motion import EMC_MOTION_STAT
from nml.emc.task import EMC_TASK_STAT
from nml.message import Command, Status, char, integer, struct


class EMC_NULL(Command, type_id=21):
    """Do nothing; a client that wants to know whether task reacts sends it."""


class EMC_SET_DEBUG(Command, type_id=22):
    """Set what is logged."""

    debug = integer(doc="EMC_DEBUG_FLAGS")


class EMC_SYSTEM_CMD(Command, type_id=30):
    """Run a program (M100 to M199)."""

    string = char(SYSTEM_CMD_LEN, doc="the command line")


class EMC_CMD_MSG(Command):
    """A command to the whole controller."""


class EMC_INIT(EMC_CMD_MSG, type_id=1901):
    """Initialise everything."""


class EMC_HALT(EMC_CMD_MSG, type_id=1902):
    """Shut everything down."""


class EMC_ABORT(EMC_CMD_MSG, type_id=1903):
    """Stop everything."""


class EMC_EXEC_PLUGIN_CALL(EMC_CMD_MSG, type_id=1112):
    """Call into a task plug-in."""

    len = integer(doc="bytes used of call", local=True)
    call = char(900, doc="pickled call", local=True)


class EMC_IO_PLUGIN_CALL(EMC_CMD_MSG, type_id=1113):
    """Call into an I/O plug-in."""

    len = integer(doc="bytes used of call", local=True)
    call = char(900, doc="pickled call", local=True)


class EMC_STAT_MSG(Status):
    """What the status of the controller begins with."""


class EMC_STAT(EMC_STAT_MSG, type_id=1999):
    """The status of the whole controller, written to emcStatus by task."""

    task = struct(EMC_TASK_STAT)
    motion = struct(EMC_MOTION_STAT)
    io = struct(EMC_IO_STAT)
    debug = integer(doc="EMC_DEBUG_FLAGS")


class RCS_GENERIC_CMD(Command, type_id=1000000):
    """A command that carries only a number."""

    gen_id = integer()


class RCS_GENERIC_STATUS(Status, type_id=2000000):
    """A status without members of its own."""
