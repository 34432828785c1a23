"""Coordinated motion: moves, offsets, overrides, probing and the planner's status. Manual, chapter 4.5."""

from __future__ import annotations

from nml.emc.structs import EmcPose, PmCartesian, StateTag
from nml.message import Command, Status, boolean, double, integer, struct, uchar


class EMC_TRAJ_CMD_MSG(Command):
    """A command to coordinated motion, with the interpreter's state at that point of the program."""

    tag = struct(StateTag, doc="interpreter state that the move was programmed under", local=True)


class EMC_TRAJ_SET_AXES(EMC_TRAJ_CMD_MSG, type_id=201):
    """Set which axes there are."""

    axes = integer(doc="bit mask")


class EMC_TRAJ_SET_UNITS(EMC_TRAJ_CMD_MSG, type_id=202):
    """Set the machine's units."""

    linearUnits = double(doc="units per mm")
    angularUnits = double(doc="units per degree")


class EMC_TRAJ_SET_CYCLE_TIME(EMC_TRAJ_CMD_MSG, type_id=203):
    """Set the planner's period."""

    cycleTime = double(unit="s")


class EMC_TRAJ_SET_MODE(EMC_TRAJ_CMD_MSG, type_id=204):
    """Change between free, coordinated and teleop mode."""

    mode = integer(doc="EMC_TRAJ_MODE_ENUM")


class EMC_TRAJ_SET_VELOCITY(EMC_TRAJ_CMD_MSG, type_id=205):
    """Set the velocity of moves that bring none of their own."""

    velocity = double(unit="lu/s")
    ini_maxvel = double(unit="lu/s", doc="largest velocity that the INI file allows for this move")


class EMC_TRAJ_SET_ACCELERATION(EMC_TRAJ_CMD_MSG, type_id=206):
    """Set the acceleration along the path."""

    acceleration = double(unit="lu/s^2")


class EMC_TRAJ_SET_MAX_VELOCITY(EMC_TRAJ_CMD_MSG, type_id=207):
    """Set the velocity that no override may exceed (the display's MV slider)."""

    velocity = double(unit="lu/s")


class EMC_TRAJ_SET_MAX_ACCELERATION(EMC_TRAJ_CMD_MSG, type_id=208):
    """Set the acceleration that no move may exceed."""

    acceleration = double(unit="lu/s^2")


class EMC_TRAJ_SET_SCALE(EMC_TRAJ_CMD_MSG, type_id=209):
    """Set the feed override."""

    scale = double(doc="1.0: as programmed")


class EMC_TRAJ_SET_RAPID_SCALE(EMC_TRAJ_CMD_MSG, type_id=238):
    """Set the rapid override."""

    scale = double(doc="1.0: as programmed")


class EMC_TRAJ_SET_MOTION_ID(EMC_TRAJ_CMD_MSG, type_id=210):
    """Set the id of the moves to come."""

    id = integer(doc="number of the moves to come")


class EMC_TRAJ_INIT(EMC_TRAJ_CMD_MSG, type_id=211):
    """Initialise coordinated motion."""


class EMC_TRAJ_HALT(EMC_TRAJ_CMD_MSG, type_id=212):
    """Shut coordinated motion down."""


class EMC_TRAJ_ENABLE(EMC_TRAJ_CMD_MSG, type_id=213):
    """Enable motion."""


class EMC_TRAJ_DISABLE(EMC_TRAJ_CMD_MSG, type_id=214):
    """Disable motion."""


class EMC_TRAJ_ABORT(EMC_TRAJ_CMD_MSG, type_id=215):
    """Stop, and forget queued moves."""


class EMC_TRAJ_PAUSE(EMC_TRAJ_CMD_MSG, type_id=216):
    """Stop on the path."""


class EMC_TRAJ_STEP(EMC_TRAJ_CMD_MSG, type_id=217):
    """Go on for one move."""


class EMC_TRAJ_RESUME(EMC_TRAJ_CMD_MSG, type_id=218):
    """Go on after a pause."""


class EMC_TRAJ_DELAY(EMC_TRAJ_CMD_MSG, type_id=219):
    """Wait (G4)."""

    delay = double(unit="s")


class EMC_TRAJ_LINEAR_MOVE(EMC_TRAJ_CMD_MSG, type_id=220):
    """Queue a straight move."""

    wire_order = ("end", "type", "vel", "ini_maxvel", "acc", "feed_mode", "indexer_jnum")

    type = integer(doc="EMC_MOTION_TYPE")
    end = struct(EmcPose, unit="lu, deg", doc="end point")
    vel = double(unit="lu/s", doc="requested feed, before override")
    ini_maxvel = double(unit="lu/s", doc="largest velocity that the INI file allows for this move")
    acc = double(unit="lu/s^2", doc="largest acceleration on the path")
    feed_mode = integer(doc="1: inverse time or per revolution")
    indexer_jnum = integer(doc="locking joint to unlock for the move, -1: none")


class EMC_TRAJ_CIRCULAR_MOVE(EMC_TRAJ_CMD_MSG, type_id=221):
    """Queue an arc or a helix."""

    end = struct(EmcPose, unit="lu, deg", doc="end point")
    center = struct(PmCartesian, unit="lu")
    normal = struct(PmCartesian, doc="axis of the arc; its length does not matter")
    turn = integer(doc="full turns beyond the first; negative: clockwise")
    type = integer(doc="EMC_MOTION_TYPE")
    vel = double(unit="lu/s", doc="requested feed, before override")
    ini_maxvel = double(unit="lu/s", doc="largest velocity that the INI file allows for this move")
    acc = double(unit="lu/s^2", doc="largest acceleration on the path")
    feed_mode = integer(doc="1: inverse time or per revolution")


class EMC_TRAJ_SET_TERM_COND(EMC_TRAJ_CMD_MSG, type_id=222):
    """Set how moves end (G61, G61.1, G64)."""

    cond = integer(doc="EMC_TRAJ_TERM_COND")
    tolerance = double(unit="lu", doc="largest deviation from the path (G64 P)")


class EMC_TRAJ_SET_OFFSET(EMC_TRAJ_CMD_MSG, type_id=223):
    """Set the tool offset."""

    offset = struct(EmcPose, unit="lu, deg")


class EMC_TRAJ_SET_G5X(EMC_TRAJ_CMD_MSG, type_id=224):
    """Set the offset of a coordinate system (G54 to G59.3)."""

    g5x_index = integer(doc="1: G54 to 9: G59.3")
    origin = struct(EmcPose, unit="lu, deg")


class EMC_TRAJ_SET_HOME(EMC_TRAJ_CMD_MSG, type_id=225):
    """Set the position of the home point."""

    home = struct(EmcPose, unit="lu, deg")


class EMC_TRAJ_SET_ROTATION(EMC_TRAJ_CMD_MSG, type_id=226):
    """Set the rotation of the coordinate system about Z."""

    rotation = double(unit="deg")


class EMC_TRAJ_SET_G92(EMC_TRAJ_CMD_MSG, type_id=227):
    """Set the G92 offset."""

    origin = struct(EmcPose, unit="lu, deg")


class EMC_TRAJ_CLEAR_PROBE_TRIPPED_FLAG(EMC_TRAJ_CMD_MSG, type_id=228):
    """Forget that the probe has tripped."""


class EMC_TRAJ_PROBE(EMC_TRAJ_CMD_MSG, type_id=229):
    """Move until the probe trips (G38)."""

    pos = struct(EmcPose, unit="lu, deg", doc="end of the search")
    type = integer(doc="EMC_MOTION_TYPE")
    vel = double(unit="lu/s", doc="requested feed, before override")
    ini_maxvel = double(unit="lu/s", doc="largest velocity that the INI file allows for this move")
    acc = double(unit="lu/s^2", doc="largest acceleration on the path")
    probe_type = uchar(doc="bit 0: no error when nothing was found; bit 1: away from contact")


class EMC_TRAJ_SET_TELEOP_ENABLE(EMC_TRAJ_CMD_MSG, type_id=230):
    """Turn teleop mode on or off."""

    enable = integer()


class EMC_TRAJ_SET_SPINDLESYNC(EMC_TRAJ_CMD_MSG, type_id=232):
    """Tie the moves to come to the spindle's rotation (G33, G95)."""

    spindle = integer(doc="spindle index", local=True)
    feed_per_revolution = double(unit="lu/rev", doc="0 ends it")
    velocity_mode = boolean(doc="follow the spindle's speed, not its angle")


class EMC_TRAJ_SET_SPINDLE_SCALE(EMC_TRAJ_CMD_MSG, type_id=233):
    """Set the spindle override."""

    spindle = integer(doc="spindle index", local=True)
    scale = double(doc="1.0: as programmed")


class EMC_TRAJ_SET_FO_ENABLE(EMC_TRAJ_CMD_MSG, type_id=234):
    """Allow the feed override (M50)."""

    mode = uchar(doc="1: allowed")


class EMC_TRAJ_SET_SO_ENABLE(EMC_TRAJ_CMD_MSG, type_id=235):
    """Allow the spindle override (M51)."""

    spindle = integer(doc="spindle index", local=True)
    mode = uchar(doc="1: allowed")


class EMC_TRAJ_SET_FH_ENABLE(EMC_TRAJ_CMD_MSG, type_id=236):
    """Allow feed hold (M53)."""

    mode = uchar(doc="1: allowed")


class EMC_TRAJ_RIGID_TAP(EMC_TRAJ_CMD_MSG, type_id=237):
    """Tap in step with the spindle and come back (G33.1)."""

    pos = struct(EmcPose, unit="lu, deg", doc="bottom of the hole")
    vel = double(unit="lu/s", doc="requested feed, before override")
    ini_maxvel = double(unit="lu/s", doc="largest velocity that the INI file allows for this move")
    acc = double(unit="lu/s^2", doc="largest acceleration on the path")
    scale = double(doc="of the velocity on the way back", local=True)


class EMC_TRAJ_STAT_MSG(Status):
    """What the status of coordinated motion begins with."""


class EMC_TRAJ_STAT(EMC_TRAJ_STAT_MSG, type_id=299):
    """The status of coordinated motion."""

    linearUnits = double(doc="units per mm")
    angularUnits = double(doc="units per degree")
    cycleTime = double(unit="s")
    joints = integer(doc="number of joints", local=True)
    spindles = integer(doc="number of spindles", local=True)
    axis_mask = integer(doc="bit n: axis n exists")
    mode = integer(doc="EMC_TRAJ_MODE_ENUM")
    enabled = boolean()
    inpos = boolean(doc="not moving")
    queue = integer(doc="moves in the planner's queue")
    activeQueue = integer(doc="moves being executed, 2 while blending")
    queueFull = boolean()
    id = integer(doc="number of the executing move")
    paused = boolean()
    scale = double(doc="1.0: as programmed")
    rapid_scale = double(doc="1.0: as programmed", local=True)
    position = struct(EmcPose, unit="lu, deg", doc="commanded")
    actualPosition = struct(EmcPose, unit="lu, deg", doc="fed back")
    velocity = double(unit="lu/s", doc="default of moves without one")
    acceleration = double(unit="lu/s^2")
    maxVelocity = double(unit="lu/s", doc="what no override may exceed")
    maxAcceleration = double(unit="lu/s^2")
    probedPosition = struct(EmcPose, unit="lu, deg", doc="where the probe tripped")
    probe_tripped = boolean()
    probing = boolean()
    probeval = integer(doc="the probe's input")
    kinematics_type = integer(doc="KINEMATICS_TYPE")
    motion_type = integer(doc="EMC_MOTION_TYPE of the executing move")
    distance_to_go = double(unit="lu", local=True)
    dtg = struct(EmcPose, unit="lu, deg", doc="distance to go by axis", local=True)
    current_vel = double(unit="lu/s", local=True)
    feed_override_enabled = boolean(local=True)
    adaptive_feed_enabled = boolean(local=True)
    feed_hold_enabled = boolean(local=True)
    tag = struct(StateTag, doc="interpreter state that the move was programmed under", local=True)
