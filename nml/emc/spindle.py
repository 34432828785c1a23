"""Spindles. Manual, chapter 4.10."""

from __future__ import annotations

from nml.message import Command, Status, boolean, double, integer


class EMC_SPINDLE_CMD_MSG(Command):
    """A command to a spindle. LinuxCNC's base class has a spindle number of its own that nobody uses."""

    base_spindle = integer(doc="unused", local=True)


class EMC_SPINDLE_ON(EMC_SPINDLE_CMD_MSG, type_id=1304):
    """Turn a spindle (M3, M4)."""

    spindle = integer(doc="spindle index", local=True)
    speed = double(unit="rpm", doc="signed, as commanded")
    factor = double(doc="constant surface speed: surface speed factor, 0: constant rpm")
    xoffset = double(unit="lu", doc="constant surface speed: X of the axis of rotation")
    wait_for_spindle_at_speed = integer()


class EMC_SPINDLE_OFF(EMC_SPINDLE_CMD_MSG, type_id=1305):
    """Stop a spindle (M5)."""

    spindle = integer(doc="spindle index", local=True)


class EMC_SPINDLE_INCREASE(EMC_SPINDLE_CMD_MSG, type_id=1309):
    """Turn faster."""

    spindle = integer(doc="spindle index", local=True)
    speed = double(unit="rpm", doc="signed, as commanded")


class EMC_SPINDLE_DECREASE(EMC_SPINDLE_CMD_MSG, type_id=1310):
    """Turn slower."""

    spindle = integer(doc="spindle index", local=True)
    speed = double(unit="rpm", doc="signed, as commanded")


class EMC_SPINDLE_CONSTANT(EMC_SPINDLE_CMD_MSG, type_id=1311):
    """Stop changing the speed."""

    spindle = integer(doc="spindle index", local=True)
    speed = double(unit="rpm", doc="signed, as commanded")


class EMC_SPINDLE_BRAKE_RELEASE(EMC_SPINDLE_CMD_MSG, type_id=1312):
    """Release the brake."""

    spindle = integer(doc="spindle index", local=True)


class EMC_SPINDLE_BRAKE_ENGAGE(EMC_SPINDLE_CMD_MSG, type_id=1313):
    """Engage the brake."""

    spindle = integer(doc="spindle index", local=True)


class EMC_SPINDLE_SPEED(EMC_SPINDLE_CMD_MSG, type_id=1316):
    """Change the speed of a turning spindle (S)."""

    spindle = integer(doc="spindle index", local=True)
    speed = double(unit="rpm", doc="signed, as commanded")
    factor = double(doc="constant surface speed: surface speed factor, 0: constant rpm")
    xoffset = double(unit="lu", doc="constant surface speed: X of the axis of rotation")


class EMC_SPINDLE_ORIENT(EMC_SPINDLE_CMD_MSG, type_id=1317):
    """Turn to an angle and hold it (M19)."""

    spindle = integer(doc="spindle index", local=True)
    orientation = double(unit="deg")
    mode = integer(doc="0 shortest way, 1 clockwise, 2 counterclockwise")


class EMC_SPINDLE_WAIT_ORIENT_COMPLETE(EMC_SPINDLE_CMD_MSG, type_id=1318):
    """Wait until the angle is reached."""

    spindle = integer(doc="spindle index", local=True)
    timeout = double(unit="s")


class EMC_SPINDLE_STAT_MSG(Status):
    """What the status of a spindle begins with."""


class EMC_SPINDLE_STAT(EMC_SPINDLE_STAT_MSG, type_id=1399):
    """The status of one spindle."""

    speed = double(unit="rpm", doc="signed, as commanded")
    spindle_scale = double(doc="override", local=True)
    css_maximum = double(unit="rpm", local=True)
    css_factor = double(local=True)
    state = integer(local=True)
    direction = integer(doc="-1, 0 or 1")
    brake = integer()
    increasing = integer(doc="-1, 0 or 1")
    enabled = integer()
    orient_state = integer(doc="EMCMOT_ORIENT_STATE")
    orient_fault = integer(doc="fault number")
    spindle_override_enabled = boolean(local=True)
    homed = boolean(local=True)
