"""Tools: preparing, changing, offsets, and the status of the changer. Manual, chapter 4.8."""

from __future__ import annotations

from nml.emc.constants import LINELEN
from nml.emc.structs import CANON_TOOL_TABLE, EmcPose
from nml.message import Command, Status, char, double, integer, struct


class EMC_TOOL_CMD_MSG(Command):
    """A command to the tool changer."""


class EMC_TOOL_INIT(EMC_TOOL_CMD_MSG, type_id=1101):
    """Initialise the changer."""


class EMC_TOOL_HALT(EMC_TOOL_CMD_MSG, type_id=1102):
    """Shut the changer down."""


class EMC_TOOL_ABORT(EMC_TOOL_CMD_MSG, type_id=1103):
    """Stop what the changer is doing."""

    reason = integer(doc="EMC_IO_ABORT_REASON_ENUM", local=True)


class EMC_TOOL_PREPARE(EMC_TOOL_CMD_MSG, type_id=1104):
    """Get a tool ready (T)."""

    tool = integer(doc="tool number")


class EMC_TOOL_LOAD(EMC_TOOL_CMD_MSG, type_id=1105):
    """Put the prepared tool into the spindle (M6)."""


class EMC_TOOL_UNLOAD(EMC_TOOL_CMD_MSG, type_id=1106):
    """Empty the spindle."""


class EMC_TOOL_LOAD_TOOL_TABLE(EMC_TOOL_CMD_MSG, type_id=1107):
    """Read the tool table again."""

    file = char(LINELEN, wire=LINELEN + 1, doc="path")


class EMC_TOOL_SET_OFFSET(EMC_TOOL_CMD_MSG, type_id=1108):
    """Change an entry of the tool table (G10 L1, L10, L11)."""

    pocket = integer(doc="pocket or table index")
    toolno = integer(doc="tool number")
    offset = struct(EmcPose, unit="lu, deg")
    diameter = double(unit="lu")
    frontangle = double(unit="deg")
    backangle = double(unit="deg")
    orientation = integer(doc="0 to 9, of a lathe tool")


class EMC_TOOL_SET_NUMBER(EMC_TOOL_CMD_MSG, type_id=1109):
    """Say which tool is in the spindle (M61)."""

    tool = integer(doc="tool number")


class EMC_TOOL_START_CHANGE(EMC_TOOL_CMD_MSG, type_id=1110):
    """A tool change begins."""


class EMC_TOOL_STAT_MSG(Status):
    """What the status of the changer begins with."""


class EMC_TOOL_STAT(EMC_TOOL_STAT_MSG, type_id=1199):
    """The status of the tool changer."""

    pocketPrepped = integer(doc="table index, -1: none")
    toolInSpindle = integer(doc="tool number, 0: none")
    toolFromPocket = integer(doc="where the tool in the spindle came from")
    toolTableCurrent = struct(CANON_TOOL_TABLE, doc="entry of the tool in the spindle", local=True)
