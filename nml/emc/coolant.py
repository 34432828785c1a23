"""Mist and flood coolant. Manual, chapter 4.11."""

from __future__ import annotations

from nml.message import Command, Status, integer


class EMC_COOLANT_CMD_MSG(Command):
    """A command to the coolant."""


class EMC_COOLANT_MIST_ON(EMC_COOLANT_CMD_MSG, type_id=1404):
    """Mist on (M7)."""


class EMC_COOLANT_MIST_OFF(EMC_COOLANT_CMD_MSG, type_id=1405):
    """Mist off (M9)."""


class EMC_COOLANT_FLOOD_ON(EMC_COOLANT_CMD_MSG, type_id=1406):
    """Flood on (M8)."""


class EMC_COOLANT_FLOOD_OFF(EMC_COOLANT_CMD_MSG, type_id=1407):
    """Flood off (M9)."""


class EMC_COOLANT_STAT_MSG(Status):
    """What the status of the coolant begins with."""


class EMC_COOLANT_STAT(EMC_COOLANT_STAT_MSG, type_id=1499):
    """The status of the coolant."""

    mist = integer()
    flood = integer()
