"""Lubrication. Manual, chapter 4.12."""

from __future__ import annotations

from nml.message import Command, Status, integer


class EMC_LUBE_CMD_MSG(Command):
    """A command to the lubrication."""


class EMC_LUBE_ON(EMC_LUBE_CMD_MSG, type_id=1504):
    """Lubrication on."""


class EMC_LUBE_OFF(EMC_LUBE_CMD_MSG, type_id=1505):
    """Lubrication off."""


class EMC_LUBE_STAT_MSG(Status):
    """What the status of the lubrication begins with."""


class EMC_LUBE_STAT(EMC_LUBE_STAT_MSG, type_id=1599):
    """The status of the lubrication."""

    on = integer()
    level = integer(doc="1: enough oil")
