"""The messages between task and motion: one command record, the status of every servo period, and error texts.

Buffers: ``emcmotCommand`` (queue, written by task, read by the servo thread), ``emcmotStatus`` (single slot, written by
the servo thread each period) and ``emcmotError`` (queue, written by the servo thread). The layout is the C compiler's
natural one; ``nml.cheader`` turns these very declarations into the Cython declarations that motion is compiled with.

Command codes and their meaning: Developer Manual, chapter 3.8; numbers as in LinuxCNC 2.9's ``motion.h``.
"""

from __future__ import annotations

from enum import IntEnum, IntFlag

from nml.emc.structs import EmcPose, PmCartesian
from nml.message import Command, Status, Struct, char, double, integer, long, struct, uchar

MAX_JOINTS = 16
MAX_AXES = 9
MAX_SPINDLES = 8
MAX_DIO = 64
MAX_AIO = 64


class MotCommand(IntEnum):
    """What motion is told to do (``EMCMOT_COMMAND.command``)."""

    ABORT = 1
    ENABLE = 2
    DISABLE = 3
    PAUSE = 4
    REVERSE = 5
    FORWARD = 6
    RESUME = 7
    STEP = 8
    FREE = 9
    COORD = 10
    TELEOP = 11
    SPINDLE_SCALE = 12
    SS_ENABLE = 13
    FEED_SCALE = 14
    RAPID_SCALE = 15
    FS_ENABLE = 16
    FH_ENABLE = 17
    AF_ENABLE = 18
    OVERRIDE_LIMITS = 19
    SET_LINE = 20
    SET_CIRCLE = 21
    SET_TELEOP_VECTOR = 22
    CLEAR_PROBE_FLAGS = 23
    PROBE = 24
    RIGID_TAP = 25
    SET_VEL = 26
    SET_VEL_LIMIT = 27
    SET_ACC = 28
    SET_TERM_COND = 29
    SET_NUM_JOINTS = 30
    SET_NUM_SPINDLES = 31
    SET_WORLD_HOME = 32
    SET_DEBUG = 33
    SET_DOUT = 34
    SET_AOUT = 35
    SET_SPINDLESYNC = 36
    SPINDLE_ON = 37
    SPINDLE_OFF = 38
    SPINDLE_INCREASE = 39
    SPINDLE_DECREASE = 40
    SPINDLE_BRAKE_ENGAGE = 41
    SPINDLE_BRAKE_RELEASE = 42
    SPINDLE_ORIENT = 43
    SET_OFFSET = 44
    SET_MAX_FEED_OVERRIDE = 45
    SETUP_ARC_BLENDS = 46
    SET_PROBE_ERR_INHIBIT = 47
    ENABLE_WATCHDOG = 48
    DISABLE_WATCHDOG = 49
    JOG_CONT = 50
    JOG_INCR = 51
    JOG_ABS = 52
    JOG_ABORT = 53
    JOINT_ACTIVATE = 54
    JOINT_DEACTIVATE = 55
    JOINT_ENABLE_AMPLIFIER = 56
    JOINT_DISABLE_AMPLIFIER = 57
    JOINT_HOME = 58
    JOINT_UNHOME = 59
    SET_JOINT_POSITION_LIMITS = 60
    SET_JOINT_BACKLASH = 61
    SET_JOINT_MIN_FERROR = 62
    SET_JOINT_MAX_FERROR = 63
    SET_JOINT_VEL_LIMIT = 64
    SET_JOINT_ACC_LIMIT = 65
    SET_JOINT_HOMING_PARAMS = 66
    UPDATE_JOINT_HOMING_PARAMS = 67
    SET_JOINT_MOTOR_OFFSET = 68
    SET_JOINT_COMP = 69
    SET_AXIS_POSITION_LIMITS = 70
    SET_AXIS_VEL_LIMIT = 71
    SET_AXIS_ACC_LIMIT = 72
    SET_AXIS_LOCKING_JOINT = 73
    SET_SPINDLE_PARAMS = 74
    SET_HEARTBEAT_TIMEOUT = 100  # ours: `timeout` s without a command or HEARTBEAT from task stops the machine; 0: off
    HEARTBEAT = 101  # ours: task is alive; does nothing else
    SET_UNITS = 102  # ours: `scale` millimetres are one lu; for the pins motion.feed-mm-per-minute and their like
    SET_JERK = 103  # these four are LinuxCNC 2.10's, which has no fixed numbers yet
    SET_PLANNER_TYPE = 104
    SET_JOINT_JERK_LIMIT = 105
    SET_AXIS_JERK_LIMIT = 106


class MotCommandStatus(IntEnum):
    """What became of a command (``EMCMOT_STATUS.commandStatus``)."""

    OK = 0
    UNKNOWN_COMMAND = 1
    INVALID_COMMAND = 2
    INVALID_PARAMS = 3
    BAD_EXEC = 4


class MotionState(IntEnum):
    DISABLED = 0
    FREE = 1
    TELEOP = 2
    COORD = 3


class TermCond(IntEnum):
    """How a queued move ends."""

    STOP = 1
    BLEND = 2
    TANGENT = 3


class MotionFlag(IntFlag):
    ENABLE = 0x0001
    INPOS = 0x0002
    COORD = 0x0004
    ERROR = 0x0008
    TELEOP = 0x0010


class JointFlag(IntFlag):
    ENABLE = 0x0001
    ACTIVE = 0x0002
    INPOS = 0x0004
    ERROR = 0x0008
    MAX_HARD_LIMIT = 0x0010
    MIN_HARD_LIMIT = 0x0020
    FERROR = 0x0040
    FAULT = 0x0080


class Enables(IntFlag):
    """Which overrides act (``enables_new``, ``enables_queued``)."""

    SS = 0x01
    FS = 0x02
    AF = 0x04
    FH = 0x08


class EMCMOT_COMMAND(Command, type_id=3001):
    """One command to motion. Which fields count depends on ``command``; the rest are zero.

    ``serial_number`` comes back as ``EMCMOT_STATUS.commandNumEcho`` when the servo thread has taken the command.
    """

    command = integer(doc="MotCommand")
    joint = integer(doc="joint index; -1: all, where the command allows it")
    axis = integer(doc="axis index 0..8 (x y z a b c u v w)")
    spindle = integer(doc="spindle index; -1: all, where the command allows it")
    id = long(doc="motion id of a queued move; never 0 for a move")
    pos = struct(EmcPose, unit="lu, deg", doc="end point of a move")
    center = struct(PmCartesian, unit="lu", doc="SET_CIRCLE")
    normal = struct(PmCartesian, doc="SET_CIRCLE: axis of the arc")
    turn = integer(doc="SET_CIRCLE: full turns, as EMC_TRAJ_CIRCULAR_MOVE; RIGID_TAP, SET_LINE: locking joint or -1")
    motion_type = integer(doc="EMC_MOTION_TYPE_*")
    vel = double(unit="lu/s", doc="requested path velocity before override; jog velocity (signed)")
    ini_maxvel = double(unit="lu/s", doc="path velocity that no override may exceed")
    acc = double(unit="lu/s^2", doc="largest path acceleration")
    jerk = double(unit="lu/s^3", doc="largest path jerk; 0: none")
    termCond = integer(doc="TermCond, for this move and the following ones")
    mode = integer(
        doc="on or off of an enable command; joint jog (1) or axis jog (0) of a jog command; planner type; "
        "of a move: the program's units, 1 inch, 2 mm, 3 cm, 0 machine units, for the pin motion.feed-upm"
    )
    tolerance = double(unit="lu", doc="largest path deviation (G64 P)")
    spindlesync = double(unit="lu/rev", doc="SET_SPINDLESYNC")
    scale = double(doc="override factor, or scale of a RIGID_TAP retract")
    offset = double(unit="lu, deg", doc="jog distance or target; home offset")
    minLimit = double(unit="lu, deg")
    maxLimit = double(unit="lu, deg")
    minFerror = double(unit="lu, deg")
    maxFerror = double(unit="lu, deg")
    backlash = double(unit="lu, deg")
    motor_offset = double(unit="lu, deg")
    home = double(unit="lu, deg")
    home_final_vel = double(unit="lu/s, deg/s")
    search_vel = double(unit="lu/s, deg/s")
    latch_vel = double(unit="lu/s, deg/s")
    flags = integer(doc="homing flags, or other booleans")
    home_sequence = integer()
    volatile_home = integer()
    comp_nominal = double(unit="lu, deg")
    comp_forward = double(unit="lu, deg")
    comp_reverse = double(unit="lu, deg")
    now = uchar(doc="SET_DOUT, SET_AOUT: at once (1) or with the next move (0)")
    out = uchar(doc="SET_DOUT, SET_AOUT: index")
    start = uchar(doc="SET_DOUT: value at the start of the move")
    end = uchar(doc="SET_DOUT: value at its end")
    probe_type = uchar(doc="bit 0: no error when nothing was found; bit 1: away from contact")
    wait_for_spindle_at_speed = uchar()
    direction = uchar()
    reserved = uchar()
    minSpeed = double(unit="rpm", doc="SET_SPINDLE_PARAMS")
    maxSpeed = double(unit="rpm", doc="SET_SPINDLE_PARAMS")
    orientation = double(unit="deg")
    timeout = double(unit="s")
    state = integer(doc="spindle state")
    debug = integer()
    ext_offset_vel = double(unit="lu/s")
    ext_offset_acc = double(unit="lu/s^2")
    tool_offset = struct(EmcPose, unit="lu, deg")
    line = integer(doc="line of the program, for the pin motion.program-line; 0: none")


class EMCMOT_JOINT_STATUS(Struct):
    """What the status tells of one joint."""

    flag = integer(doc="JointFlag")
    homed = uchar()
    homing = uchar()
    on_soft_limit_neg = uchar()
    on_soft_limit_pos = uchar()
    pos_cmd = double(unit="lu, deg", doc="commanded joint position")
    pos_fb = double(unit="lu, deg", doc="feedback, compensation and motor offset removed")
    vel_cmd = double(unit="lu/s, deg/s")
    acc_cmd = double(unit="lu/s^2, deg/s^2")
    ferror = double(unit="lu, deg")
    ferror_high_mark = double(unit="lu, deg")
    motor_pos_cmd = double(unit="lu, deg")
    motor_pos_fb = double(unit="lu, deg")
    motor_offset = double(unit="lu, deg")
    backlash = double(unit="lu, deg")
    max_pos_limit = double(unit="lu, deg")
    min_pos_limit = double(unit="lu, deg")
    min_ferror = double(unit="lu, deg")
    max_ferror = double(unit="lu, deg")
    vel_limit = double(unit="lu/s, deg/s")
    acc_limit = double(unit="lu/s^2, deg/s^2")
    jerk_limit = double(unit="lu/s^3, deg/s^3", doc="0: none")


class EMCMOT_AXIS_STATUS(Struct):
    """What the status tells of one axis."""

    teleop_vel_cmd = double(unit="lu/s, deg/s")
    max_pos_limit = double(unit="lu, deg")
    min_pos_limit = double(unit="lu, deg")
    vel_limit = double(unit="lu/s, deg/s")
    acc_limit = double(unit="lu/s^2, deg/s^2")
    jerk_limit = double(unit="lu/s^3, deg/s^3", doc="0: none")


class EMCMOT_SPINDLE_STATUS(Struct):
    """What the status tells of one spindle."""

    speed = double(unit="rpm", doc="commanded, signed, before override")
    scale = double(doc="override")
    net_scale = double(doc="override in force, 0 when inhibited")
    css_factor = double()
    css_maximum = double(unit="rpm")
    xoffset = double(unit="lu")
    state = integer()
    direction = integer(doc="-1, 0, 1")
    brake = integer()
    locked = integer()
    orient_fault = integer()
    orient_state = integer()
    index_enable = integer()
    at_speed = integer()
    fault = integer()
    increasing = integer(doc="-1, 0, 1")
    revs = double(unit="rev", doc="feedback position")
    speed_in = double(unit="rpm", doc="feedback speed")


class EMCMOT_STATUS(Status, type_id=3002):
    """The state of motion, written every servo period."""

    commandEcho = integer(doc="MotCommand taken last")
    commandNumEcho = integer(doc="its serial number")
    commandStatus = integer(doc="MotCommandStatus")
    motion_state = integer(doc="MotionState")
    motionFlag = integer(doc="MotionFlag")
    enables_new = integer(doc="Enables for moves to come")
    enables_queued = integer(doc="Enables of the executing move")
    num_joints = integer()
    num_spindles = integer()
    num_dio = integer()
    num_aio = integer()
    kinematics_type = integer(doc="1 identity, 2 forward only, 3 inverse only, 4 both")
    heartbeat = long(doc="servo periods since start")
    id = long(doc="motion id of the executing move, 0 when idle")
    config_num = integer()
    depth = integer(doc="moves in the planner's queue")
    activeDepth = integer()
    queueFree = integer(doc="moves that still fit into the planner's queue, after every command echoed so far")
    queueFull = integer()
    paused = integer()
    stepping = integer()
    reverse_run = integer()
    planner_type = integer(doc="0 trapezoidal, 1 with limited jerk")
    kinematics_way = integer(doc="type of switchable kinematics in use, as motion.switchkins-type")
    motionType = integer()
    jogging_active = integer()
    on_soft_limit = integer()
    overrideLimitMask = integer()
    probeVal = integer()
    probeTripped = integer()
    probing = integer()
    probe_type = integer()
    atspeed_next_feed = integer()
    spindleSync = integer()
    carte_pos_cmd_ok = integer()
    carte_pos_fb_ok = integer()
    external_offsets_applied = integer()
    task_lost = integer(doc="the heartbeat of task was missed; the machine was stopped")
    feed_scale = double()
    rapid_scale = double()
    adaptive_scale = double()
    net_feed_scale = double()
    max_feed_scale = double()
    vel = double(unit="lu/s", doc="MAX_LINEAR_VELOCITY cap")
    acc = double(unit="lu/s^2")
    jerk = double(unit="lu/s^3", doc="cap on the path's jerk; 0: none")
    current_vel = double(unit="lu/s")
    requested_vel = double(unit="lu/s")
    distance_to_go = double(unit="lu")
    distance_travelled = double(unit="lu", doc="way of the commanded tool position (x y z) since start, never reset")
    servo_period = double(unit="s")
    servo_time = double(unit="s", doc="motion-controller: run time of the last period")
    servo_time_max = double(unit="s")
    dtg = struct(EmcPose, unit="lu, deg")
    carte_pos_cmd = struct(EmcPose, unit="lu, deg")
    carte_pos_fb = struct(EmcPose, unit="lu, deg")
    world_home = struct(EmcPose, unit="lu, deg")
    probedPos = struct(EmcPose, unit="lu, deg")
    tool_offset = struct(EmcPose, unit="lu, deg")
    eoffset_pose = struct(EmcPose, unit="lu, deg")
    joint_status = struct(EMCMOT_JOINT_STATUS, MAX_JOINTS)
    axis_status = struct(EMCMOT_AXIS_STATUS, MAX_AXES)
    spindle_status = struct(EMCMOT_SPINDLE_STATUS, MAX_SPINDLES)
    synch_di = uchar(MAX_DIO)
    synch_do = uchar(MAX_DIO)
    analog_input = double(MAX_AIO)
    analog_output = double(MAX_AIO)


class EMCMOT_ERROR(Status, type_id=3003):
    """A text for the operator from the servo thread; task forwards it as EMC_OPERATOR_ERROR."""

    kind = integer(doc="11 error, 12 text, 13 display: the EMC_OPERATOR_* type to forward it as")
    joint = integer(doc="-1: no particular joint")
    id = long(doc="motion id of the move that the text is about, where it reads `line <id>`; 0: no move")
    text = char(256)
