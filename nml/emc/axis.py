"""The status of one axis. Manual, chapter 4.3."""

from __future__ import annotations

from nml.message import Status, double, integer


class EMC_AXIS_STAT_MSG(Status):
    """What the status of an axis begins with."""

    axis = integer(doc="axis index 0 to 8", local=True)


class EMC_AXIS_STAT(EMC_AXIS_STAT_MSG, type_id=199):
    """The status of one axis."""

    minPositionLimit = double(unit="lu, deg", local=True)
    maxPositionLimit = double(unit="lu, deg", local=True)
    velocity = double(unit="lu/s, deg/s", doc="of a teleop jog", local=True)
