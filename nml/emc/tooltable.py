"""The whole tool table as one message: the slot buffer ``toolTable``, written by io whenever the table changes.

LinuxCNC keeps the same thing in a memory-mapped file; readers are task (for the interpreter) and ``linuxcnc.stat``.
Entry 0 is the tool in the spindle. On a random changer the index of an entry is its pocket; on a nonrandom one the
entries follow each other as the file lists them, and ``pocketno`` is what the file says.
"""

from __future__ import annotations

from nml.emc.structs import CANON_TOOL_TABLE
from nml.message import Status, Struct, char, integer, struct

CANON_POCKETS_MAX = 1001
REMARK_LENGTH = 40


class TOOL_REMARK(Struct):
    """What stands behind the semicolon of a tool's line."""

    text = char(REMARK_LENGTH, cut=True)


class EMC_TOOL_TABLE(Status, type_id=3010):
    """All tools; a toolno of -1 marks an empty entry. Lengths in machine units."""

    random = integer(doc="1: random changer")
    last_index = integer(doc="greatest index in use")
    tools = struct(CANON_TOOL_TABLE, CANON_POCKETS_MAX, doc="0: spindle")
    remarks = struct(TOOL_REMARK, CANON_POCKETS_MAX, doc="of the same entries")
