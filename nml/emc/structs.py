"""Structures that messages share: points, poses and the tool table's record. LinuxCNC's names and order."""

from __future__ import annotations

from nml.message import Struct, double, integer, real32, struct, ulong


class PmCartesian(Struct):
    """A point or a vector."""

    x = double()
    y = double()
    z = double()


class EmcPose(Struct):
    """A position of all nine axes."""

    tran = struct(PmCartesian, unit="lu", doc="x, y, z")
    a = double(unit="deg")
    b = double(unit="deg")
    c = double(unit="deg")
    u = double(unit="lu")
    v = double(unit="lu")
    w = double(unit="lu")


class CANON_TOOL_TABLE(Struct):
    """One entry of the tool table. Entry 0 is the tool in the spindle."""

    toolno = integer(default=-1, doc="tool number; -1: no tool")
    pocketno = integer(local=True)
    offset = struct(EmcPose, unit="lu, deg", doc="tool offset")
    diameter = double(unit="lu")
    frontangle = double(unit="deg", doc="of a lathe tool")
    backangle = double(unit="deg", doc="of a lathe tool")
    orientation = integer(local=True, doc="0 to 9, of a lathe tool")


class StateTag(Struct):
    """What the interpreter's state was where a move was programmed."""

    fields_float = real32(5, doc="line number, feed, speed, path tolerance, naive-cam tolerance")
    fields = integer(8, doc="line number, G mode 0, cutter compensation, motion mode, plane, M modes 4, origin, tool")
    packed_flags = ulong(doc="flags of the interpreter's modes")
    flags = ulong(doc="the same, as C++ keeps them")
