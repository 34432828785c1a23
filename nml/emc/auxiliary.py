"""E-stop and waiting for inputs (AUX). Manual, chapter 4.9."""

from __future__ import annotations

from nml.message import Command, Status, double, integer


class EMC_AUX_CMD_MSG(Command):
    """A command to the auxiliary functions."""


class EMC_AUX_ESTOP_ON(EMC_AUX_CMD_MSG, type_id=1206):
    """Stop everything: set E-stop."""


class EMC_AUX_ESTOP_OFF(EMC_AUX_CMD_MSG, type_id=1207):
    """Take E-stop back."""


class EMC_AUX_ESTOP_RESET(EMC_AUX_CMD_MSG, type_id=1208):
    """Ask the E-stop chain to reset."""


class EMC_AUX_INPUT_WAIT(EMC_AUX_CMD_MSG, type_id=1209):
    """Wait for an input (M66)."""

    index = integer(doc="input number")
    input_type = integer(doc="1 analogue, 2 digital")
    wait_type = integer(doc="0 immediate, 1 rise, 2 fall, 3 high, 4 low")
    timeout = double(unit="s")


class EMC_AUX_STAT_MSG(Status):
    """What the status of the auxiliary functions begins with."""


class EMC_AUX_STAT(EMC_AUX_STAT_MSG, type_id=1299):
    """The status of E-stop."""

    estop = integer(doc="1: in E-stop")
