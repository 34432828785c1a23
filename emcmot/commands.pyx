"""The command handler: one table from command to what it requires and what it does.

``run`` checks a record in this order: is it whole, is the command known, are its numbers finite and within reason,
do the indices exist, is motion in the right state; only then the handler runs. Whatever is refused leaves the state
as it was, with a text for the operator. ``COMMANDS`` is the same table for the documentation (docs/motion.md) and
the tests.
"""

from libc.math cimport fabs
from libc.stdio cimport snprintf

from emcmot._messages cimport (
    EMCMOT_COMMAND,
    EMCMOT_COMMAND_TYPE,
    MAX_AXES,
    MotCommandStatus_INVALID_COMMAND,
    MotCommandStatus_INVALID_PARAMS,
    MotCommandStatus_OK,
    MotCommandStatus_UNKNOWN_COMMAND,
    MotCommand_ABORT,
    MotCommand_AF_ENABLE,
    MotCommand_CLEAR_PROBE_FLAGS,
    MotCommand_COORD,
    MotCommand_DISABLE,
    MotCommand_DISABLE_WATCHDOG,
    MotCommand_ENABLE,
    MotCommand_ENABLE_WATCHDOG,
    MotCommand_FEED_SCALE,
    MotCommand_FH_ENABLE,
    MotCommand_FORWARD,
    MotCommand_FREE,
    MotCommand_FS_ENABLE,
    MotCommand_HEARTBEAT,
    MotCommand_JOG_ABORT,
    MotCommand_JOG_ABS,
    MotCommand_JOG_CONT,
    MotCommand_JOG_INCR,
    MotCommand_JOINT_ACTIVATE,
    MotCommand_JOINT_DEACTIVATE,
    MotCommand_JOINT_DISABLE_AMPLIFIER,
    MotCommand_JOINT_ENABLE_AMPLIFIER,
    MotCommand_JOINT_HOME,
    MotCommand_JOINT_UNHOME,
    MotCommand_OVERRIDE_LIMITS,
    MotCommand_PAUSE,
    MotCommand_PROBE,
    MotCommand_RAPID_SCALE,
    MotCommand_RESUME,
    MotCommand_REVERSE,
    MotCommand_RIGID_TAP,
    MotCommand_SETUP_ARC_BLENDS,
    MotCommand_SET_ACC,
    MotCommand_SET_AOUT,
    MotCommand_SET_AXIS_ACC_LIMIT,
    MotCommand_SET_AXIS_JERK_LIMIT,
    MotCommand_SET_AXIS_LOCKING_JOINT,
    MotCommand_SET_AXIS_POSITION_LIMITS,
    MotCommand_SET_AXIS_VEL_LIMIT,
    MotCommand_SET_CIRCLE,
    MotCommand_SET_DEBUG,
    MotCommand_SET_DOUT,
    MotCommand_SET_HEARTBEAT_TIMEOUT,
    MotCommand_SET_JERK,
    MotCommand_SET_JOINT_ACC_LIMIT,
    MotCommand_SET_JOINT_BACKLASH,
    MotCommand_SET_JOINT_COMP,
    MotCommand_SET_JOINT_HOMING_PARAMS,
    MotCommand_SET_JOINT_JERK_LIMIT,
    MotCommand_SET_JOINT_MAX_FERROR,
    MotCommand_SET_JOINT_MIN_FERROR,
    MotCommand_SET_JOINT_MOTOR_OFFSET,
    MotCommand_SET_JOINT_POSITION_LIMITS,
    MotCommand_SET_JOINT_VEL_LIMIT,
    MotCommand_SET_LINE,
    MotCommand_SET_MAX_FEED_OVERRIDE,
    MotCommand_SET_NUM_JOINTS,
    MotCommand_SET_NUM_SPINDLES,
    MotCommand_SET_OFFSET,
    MotCommand_SET_PLANNER_TYPE,
    MotCommand_SET_PROBE_ERR_INHIBIT,
    MotCommand_SET_SPINDLESYNC,
    MotCommand_SET_SPINDLE_PARAMS,
    MotCommand_SET_TELEOP_VECTOR,
    MotCommand_SET_TERM_COND,
    MotCommand_SET_UNITS,
    MotCommand_SET_VEL,
    MotCommand_SET_VEL_LIMIT,
    MotCommand_SET_WORLD_HOME,
    MotCommand_SPINDLE_BRAKE_ENGAGE,
    MotCommand_SPINDLE_BRAKE_RELEASE,
    MotCommand_SPINDLE_DECREASE,
    MotCommand_SPINDLE_INCREASE,
    MotCommand_SPINDLE_OFF,
    MotCommand_SPINDLE_ON,
    MotCommand_SPINDLE_ORIENT,
    MotCommand_SPINDLE_SCALE,
    MotCommand_SS_ENABLE,
    MotCommand_STEP,
    MotCommand_TELEOP,
    MotCommand_UPDATE_JOINT_HOMING_PARAMS,
    MotionState_COORD,
    MotionState_FREE,
)
from emcmot.handlers cimport (
    Handler,
    abort,
    activate_joint,
    coord_mode,
    deactivate_joint,
    disable,
    disable_amplifier,
    enable,
    enable_amplifier,
    enable_override,
    feed_scale,
    forward,
    free_mode,
    home,
    jog,
    jog_abort,
    nothing,
    override_limits,
    pause,
    rapid_scale,
    resume,
    reverse,
    set_joint_comp,
    set_motor_offset,
    set_num_joints,
    set_num_spindles,
    set_probe_err_inhibit,
    spindle_brake_engage,
    spindle_brake_release,
    spindle_decrease,
    spindle_increase,
    spindle_off,
    spindle_on,
    spindle_orient,
    spindle_scale,
    step,
    teleop_mode,
    teleop_vector,
    unhome,
)
from emcmot.moves cimport (
    clear_probe_flags,
    probe,
    rigid_tap,
    set_aout,
    set_circle,
    set_dout,
    set_line,
    set_spindle_sync,
)
from emcmot.parameters cimport set_parameters
from emcmot.report cimport TEXT_SIZE, report
from emcmot.state cimport Motion

from emcmot.layout import same_size
from nml.emc.emcmot import EMCMOT_COMMAND as CommandMessage
from nml.emc.emcmot import MotCommand

same_size(__name__, "Motion", sizeof(Motion))

cdef enum Requirement:
    ENABLED = 1          # motion is enabled
    COORD = 2            # in coordinated mode
    FREE = 4             # in joint (free) mode
    JOINT = 8            # joint 0 .. num_joints - 1
    JOINT_OR_ALL = 16    # joint, -1 (all) or -2 (the volatile ones, of UNHOME)
    AXIS = 32            # axis 0 .. 8
    JOINT_OR_AXIS = 64   # joint where mode is 1, axis where it is 0
    SPINDLE = 128        # spindle 0 .. num_spindles - 1, or -1: all
    DIGITAL_OUT = 256    # out 0 .. num_dio - 1
    ANALOG_OUT = 512     # out 0 .. num_aio - 1
    MOVE = 1024          # id not 0, position within reason
    STILL_OFF = 2048     # motion is not enabled

REQUIREMENT_TEXTS = {
    ENABLED: "motion enabled",
    COORD: "coordinated mode",
    FREE: "joint mode",
    JOINT: "an existing joint",
    JOINT_OR_ALL: "an existing joint, or -1",
    AXIS: "an axis from 0 to 8",
    JOINT_OR_AXIS: "an existing joint (mode 1) or axis (mode 0)",
    SPINDLE: "an existing spindle, or -1",
    DIGITAL_OUT: "an existing digital output",
    ANALOG_OUT: "an existing analog output",
    MOVE: "a motion id and a position within 1e9",
    STILL_OFF: "motion disabled",
}

cdef double REASONABLE = 1e9   # lu or deg: no machine is larger

cdef enum:
    MAX_CODE = 128
    MAX_NUMBERS = 96

ctypedef struct Entry:
    const char* name
    const char* refusal      # what the operator is told in another state than it needs; NULL: which it needs
    int needs
    Handler handler

cdef Entry TABLE[MAX_CODE]
cdef size_t NUMBERS[MAX_NUMBERS]   # where the doubles of a command are
cdef int number_count = 0
TEXTS: list[bytes] = []            # keeps the texts that TABLE points to
COMMANDS: list[tuple[str, int, list[str], str]] = []


cdef int refuse(Motion* m, int code, const char* why, int status) noexcept nogil:
    if status == MotCommandStatus_INVALID_COMMAND and TABLE[code].refusal != NULL:
        snprintf(report(m), TEXT_SIZE, b"%s", TABLE[code].refusal)
    else:
        snprintf(report(m), TEXT_SIZE, b"%s refused: %s", TABLE[code].name, why)
    return status


cdef int check_indices(Motion* m, const EMCMOT_COMMAND* c, int needs) noexcept nogil:
    """0, or the status of the refusal."""
    cdef int bad = MotCommandStatus_INVALID_PARAMS
    cdef int by_joint = needs & JOINT or (needs & JOINT_OR_AXIS and c.mode)
    if by_joint and not 0 <= c.joint < m.num_joints:
        return refuse(m, c.command, b"there is no such joint", bad)
    if needs & JOINT_OR_ALL and not -2 <= c.joint < m.num_joints:
        return refuse(m, c.command, b"there is no such joint", bad)
    if (needs & AXIS or (needs & JOINT_OR_AXIS and not c.mode)) and not 0 <= c.axis < MAX_AXES:
        return refuse(m, c.command, b"there is no such axis", bad)
    if needs & SPINDLE and not -1 <= c.spindle < m.num_spindles:
        return refuse(m, c.command, b"there is no such spindle", bad)
    if needs & DIGITAL_OUT and not c.out < m.num_dio:
        return refuse(m, c.command, b"there is no such digital output", bad)
    if needs & ANALOG_OUT and not c.out < m.num_aio:
        return refuse(m, c.command, b"there is no such analog output", bad)
    return 0


cdef int check_numbers(Motion* m, const EMCMOT_COMMAND* c, int needs) noexcept nogil:
    """0, or the status of the refusal."""
    cdef int n
    cdef double value
    cdef const double* pos = <const double*>&c.pos
    for n in range(number_count):
        value = (<const double*>(<const char*>c + NUMBERS[n]))[0]
        if not fabs(value) < 1e300:  # also where it is not a number
            return refuse(
                m, c.command, b"it holds a value that is infinite or not a number", MotCommandStatus_INVALID_PARAMS
            )
    if needs & MOVE:
        if c.id == 0:
            return refuse(m, c.command, b"a move needs an id that is not 0", MotCommandStatus_INVALID_PARAMS)
        for n in range(MAX_AXES):
            if not fabs(pos[n]) <= REASONABLE:
                return refuse(m, c.command, b"its position is beyond any machine", MotCommandStatus_INVALID_PARAMS)
    return 0


cdef int check_state(Motion* m, const EMCMOT_COMMAND* c, int needs) noexcept nogil:
    """0, or the status of the refusal."""
    cdef int bad = MotCommandStatus_INVALID_COMMAND
    if needs & ENABLED and (not (m.enabled and m.enable_wanted) or m.task_lost):
        return refuse(m, c.command, b"motion is not enabled", bad)
    if needs & STILL_OFF and (m.enabled or m.enable_wanted):
        return refuse(m, c.command, b"motion must be disabled", bad)
    if needs & COORD and m.mode != MotionState_COORD:
        return refuse(m, c.command, b"motion is not in coordinated mode", bad)
    if needs & COORD and m.mode_wanted != MotionState_COORD:
        return refuse(m, c.command, b"motion is leaving coordinated mode", bad)
    if needs & COORD and m.stopping:
        return refuse(m, c.command, b"motion is stopping", bad)
    if needs & FREE and (m.mode != MotionState_FREE or m.mode_wanted != MotionState_FREE):
        return refuse(m, c.command, b"motion is not in joint mode", bad)
    return 0


cdef int execute(Motion* m, const EMCMOT_COMMAND* c, const Entry* entry) noexcept nogil:
    """Run the handler; for each spindle where the command is for all."""
    cdef EMCMOT_COMMAND single
    cdef int n
    cdef int result = MotCommandStatus_OK
    if not entry.needs & SPINDLE or c.spindle >= 0:
        return entry.handler(m, c)
    single = c[0]
    for n in range(m.num_spindles):
        single.spindle = n
        result = entry.handler(m, &single)
    return result


cdef int checked(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """Check and run a command; no move is taken behind one that was refused, until an abort: it would cut a corner."""
    cdef const Entry* entry = &TABLE[c.command]
    cdef int result
    if entry.needs & MOVE and m.coord_error:
        return MotCommandStatus_INVALID_COMMAND
    result = check_numbers(m, c, entry.needs)
    if not result:
        result = check_indices(m, c, entry.needs)
    if not result:
        result = check_state(m, c, entry.needs)
    if not result:
        result = execute(m, c, entry)
    if result and entry.needs & MOVE:
        m.coord_error = 1
    return result


cdef void sign_of_life(Motion* m) noexcept nogil:
    """Task is there. Once it was missed the machine is switched off all the same."""
    m.last_command = m.host_now
    if not m.enabled:
        m.task_lost = 0


cdef void sign_texts(Motion* m, int first, int serial) noexcept nogil:
    """Mark the texts from the first one on as those of a command."""
    cdef int n
    for n in range(first, m.error_count):
        m.errors[n].echo_serial_number = serial


cdef void run(Motion* m, const EMCMOT_COMMAND* c, size_t size) noexcept nogil:
    """Take one command record of ``size`` bytes."""
    cdef int texts = m.error_count
    if size != sizeof(EMCMOT_COMMAND) or c.nml_type != EMCMOT_COMMAND_TYPE:
        m.command_status = MotCommandStatus_UNKNOWN_COMMAND
        snprintf(report(m), TEXT_SIZE, b"motion refused a record of %zu bytes that is no command", size)
        return
    sign_of_life(m)
    m.command_echo = c.command
    m.command_num_echo = c.serial_number
    if not 0 < c.command < MAX_CODE or TABLE[c.command].handler == NULL:
        m.command_status = MotCommandStatus_UNKNOWN_COMMAND
        snprintf(report(m), TEXT_SIZE, b"unknown motion command %d", c.command)
    else:
        m.command_status = checked(m, c)
    sign_texts(m, texts, c.serial_number)


cdef char* kept(str text) except? NULL:
    TEXTS.append(text.encode())
    return TEXTS[len(TEXTS) - 1]


cdef void command(int code, int needs, Handler handler, str doc, str refusal=None) except *:
    name = MotCommand(code).name
    TABLE[code].name = kept(name)
    TABLE[code].refusal = kept(refusal) if refusal else NULL
    TABLE[code].needs = needs
    TABLE[code].handler = handler
    COMMANDS.append((name, code, [text for bit, text in REQUIREMENT_TEXTS.items() if needs & bit], doc))


def _find_numbers():
    global number_count
    for field in CommandMessage.FIELDS:
        if field.c_type == "double" or hasattr(field, "struct"):
            for offset in range(field.offset, field.offset + field.size, 8):
                NUMBERS[number_count] = offset
                number_count += 1


JOG_WHILE_OFF = "Can't jog joint when not enabled."

_find_numbers()
command(MotCommand_ABORT, 0, abort, "Stop all motion under its limits; drop queued moves, jogs and homing.")
command(
    MotCommand_ENABLE, 0, enable,
    "Switch the drives of all active joints on. Refused while motion.enable is false.",
)
command(MotCommand_DISABLE, 0, disable, "Switch the drives off; commands ramp to rest; spindles stop.")
command(MotCommand_PAUSE, 0, pause, "Come to rest on the path; no effect outside of coordinated mode.")
command(MotCommand_REVERSE, 0, reverse, "Run the path backwards from now on; only while paused.")
command(MotCommand_FORWARD, 0, forward, "Run the path forwards again; only while paused.")
command(MotCommand_RESUME, 0, resume, "Go on after PAUSE or STEP.")
command(MotCommand_STEP, 0, step, "Go on until the next move begins, then pause.")
command(MotCommand_FREE, 0, free_mode, "Joint mode: each joint for itself. Refused while the machine is moving.")
command(
    MotCommand_COORD, 0, coord_mode,
    "Coordinated mode. Refused while moving, and for other than identity kinematics until all is homed.",
)
command(MotCommand_TELEOP, 0, teleop_mode, "Teleop mode, jogs of axes. Refused as COORD is.")
command(MotCommand_SPINDLE_SCALE, SPINDLE, spindle_scale, "Spindle override: factor `scale`.")
command(MotCommand_SS_ENABLE, 0, enable_override, "Spindle override acts (`mode` 1) or not.")
command(MotCommand_FEED_SCALE, 0, feed_scale, "Feed override: factor `scale`; it acts up to SET_MAX_FEED_OVERRIDE.")
command(MotCommand_RAPID_SCALE, 0, rapid_scale, "Rapid override: factor `scale`, 0 to 1.")
command(MotCommand_FS_ENABLE, 0, enable_override, "Feed override acts on the moves to come (`mode` 1) or not.")
command(MotCommand_FH_ENABLE, 0, enable_override, "Feed hold acts on the moves to come (`mode` 1) or not.")
command(MotCommand_AF_ENABLE, 0, enable_override, "Adaptive feed acts on the moves to come (`mode` 1) or not.")
command(
    MotCommand_OVERRIDE_LIMITS, 0, override_limits,
    "Ignore the closed limit switches until the next jog has ended; `joint` < 0: no more.",
)
command(
    MotCommand_SET_LINE, ENABLED | COORD | MOVE, set_line, "Queue a straight move.",
    "need to be enabled, in coord mode for linear move",
)
command(
    MotCommand_SET_CIRCLE, ENABLED | COORD | MOVE, set_circle, "Queue an arc or helix.",
    "need to be enabled, in coord mode for circular move",
)
command(MotCommand_SET_TELEOP_VECTOR, ENABLED, teleop_vector, "Jog all axes with the velocity vector `pos`.")
command(MotCommand_CLEAR_PROBE_FLAGS, 0, clear_probe_flags, "Forget the last probe result.")
command(
    MotCommand_PROBE, ENABLED | COORD | MOVE, probe, "Queue a straight probing move (G38.n).",
    "need to be enabled, in coord mode for probe move",
)
command(
    MotCommand_RIGID_TAP, ENABLED | COORD | MOVE, rigid_tap,
    "Queue a rigid tap with the spindle that the feed follows; `scale`: faster way out.",
    "need to be enabled, in coord mode for rigid tap move",
)
command(MotCommand_SET_VEL, 0, set_parameters, "Speed of the moves that name none.")
command(MotCommand_SET_VEL_LIMIT, 0, set_parameters, "Cap on the speed of the tool tip, 0: none.")
command(MotCommand_SET_ACC, 0, set_parameters, "Acceleration of the moves that name none.")
command(MotCommand_SET_TERM_COND, 0, set_parameters, "How the moves end that do not say it.")
command(MotCommand_SET_NUM_JOINTS, STILL_OFF, set_num_joints, "Use `joint` joints of those that motmod was loaded for.")
command(MotCommand_SET_NUM_SPINDLES, 0, set_num_spindles, "Use `spindle` spindles.")
command(MotCommand_SET_WORLD_HOME, 0, set_parameters, "Pose of the machine at home.")
command(MotCommand_SET_DEBUG, 0, nothing, "Taken for compatibility; motion writes no debug output.")
command(MotCommand_SET_DOUT, DIGITAL_OUT, set_dout, "Digital output, at once or with the next move.")
command(MotCommand_SET_AOUT, ANALOG_OUT, set_aout, "Analog output, at once or with the next move.")
command(
    MotCommand_SET_SPINDLESYNC, SPINDLE, set_spindle_sync,
    "Moves to come follow the spindle, `spindlesync` lu per turn; 0: no more.",
)
command(MotCommand_SPINDLE_ON, SPINDLE, spindle_on, "Turn the spindle at `vel` rpm (signed).")
command(MotCommand_SPINDLE_OFF, SPINDLE, spindle_off, "Stop the spindle.")
command(MotCommand_SPINDLE_INCREASE, SPINDLE, spindle_increase, "100 rpm faster.")
command(MotCommand_SPINDLE_DECREASE, SPINDLE, spindle_decrease, "100 rpm slower.")
command(MotCommand_SPINDLE_BRAKE_ENGAGE, SPINDLE, spindle_brake_engage, "Stop the spindle and engage its brake.")
command(MotCommand_SPINDLE_BRAKE_RELEASE, SPINDLE, spindle_brake_release, "Release the brake.")
command(MotCommand_SPINDLE_ORIENT, SPINDLE, spindle_orient, "Turn the spindle to `orientation` and lock it (M19).")
command(MotCommand_SET_OFFSET, 0, set_parameters, "Tool offset, for the pins motion.tooloffset.*.")
command(MotCommand_SET_MAX_FEED_OVERRIDE, 0, set_parameters, "Largest feed override.")
command(MotCommand_SETUP_ARC_BLENDS, 0, nothing, "Taken for compatibility; the planner needs none of it.")
command(
    MotCommand_SET_PROBE_ERR_INHIBIT, 0, set_probe_err_inhibit,
    "No alarm for a probe that trips in a jog (flag 1) or homing (flag 2).",
)
command(MotCommand_ENABLE_WATCHDOG, 0, nothing, "For a hardware watchdog, where one is present; none is.")
command(MotCommand_DISABLE_WATCHDOG, 0, nothing, "For a hardware watchdog, where one is present; none is.")
command(
    MotCommand_JOG_CONT, ENABLED | JOINT_OR_AXIS, jog, "Jog with `vel` until stopped or at a limit.", JOG_WHILE_OFF
)
command(
    MotCommand_JOG_INCR, ENABLED | JOINT_OR_AXIS, jog, "Jog by `offset`, which adds to a running increment.",
    JOG_WHILE_OFF,
)
command(MotCommand_JOG_ABS, ENABLED | JOINT_OR_AXIS, jog, "Jog to `offset`.", JOG_WHILE_OFF)
command(MotCommand_JOG_ABORT, JOINT_OR_AXIS, jog_abort, "Stop the jog of one joint or axis.")
command(MotCommand_JOINT_ACTIVATE, JOINT, activate_joint, "The joint takes part in everything.")
command(MotCommand_JOINT_DEACTIVATE, JOINT, deactivate_joint, "The joint takes part in nothing.")
command(MotCommand_JOINT_ENABLE_AMPLIFIER, JOINT, enable_amplifier, "Set the joint's amp-enable-out, nothing else.")
command(MotCommand_JOINT_DISABLE_AMPLIFIER, JOINT, disable_amplifier, "Clear the joint's amp-enable-out, nothing else.")
command(
    MotCommand_JOINT_HOME, ENABLED | FREE | JOINT_OR_ALL, home, "Home a joint, or all in sequence (-1).",
    "must be in joint mode to home",
)
command(
    MotCommand_JOINT_UNHOME, JOINT_OR_ALL, unhome,
    "Forget the home of a joint, of all (-1), of the volatile ones (-2).",
)
command(MotCommand_SET_JOINT_POSITION_LIMITS, JOINT, set_parameters, "Soft limits.")
command(MotCommand_SET_JOINT_BACKLASH, JOINT, set_parameters, "Backlash.")
command(MotCommand_SET_JOINT_MIN_FERROR, JOINT, set_parameters, "Largest following error at rest.")
command(MotCommand_SET_JOINT_MAX_FERROR, JOINT, set_parameters, "Largest following error at full speed.")
command(MotCommand_SET_JOINT_VEL_LIMIT, JOINT, set_parameters, "Largest velocity.")
command(MotCommand_SET_JOINT_ACC_LIMIT, JOINT, set_parameters, "Largest acceleration.")
command(MotCommand_SET_JOINT_HOMING_PARAMS, JOINT, set_parameters, "The HOME_* entries.")
command(MotCommand_UPDATE_JOINT_HOMING_PARAMS, JOINT, set_parameters, "HOME_OFFSET, HOME and HOME_SEQUENCE only.")
command(MotCommand_SET_JOINT_MOTOR_OFFSET, STILL_OFF | JOINT, set_motor_offset, "Motor position at joint position 0.")
command(MotCommand_SET_JOINT_COMP, JOINT, set_joint_comp, "One more point of the screw compensation.")
command(MotCommand_SET_AXIS_POSITION_LIMITS, AXIS, set_parameters, "Soft limits.")
command(MotCommand_SET_AXIS_VEL_LIMIT, AXIS, set_parameters, "Largest velocity, and that of its external offset.")
command(MotCommand_SET_AXIS_ACC_LIMIT, AXIS, set_parameters, "Largest acceleration, and that of its external offset.")
command(MotCommand_SET_AXIS_LOCKING_JOINT, AXIS, set_parameters, "The joint that must be unlocked for this axis.")
command(MotCommand_SET_SPINDLE_PARAMS, SPINDLE, set_parameters, "Speed limits in both directions.")
command(
    MotCommand_SET_HEARTBEAT_TIMEOUT, 0, set_parameters,
    "Host seconds without a sign of life of task after which motion stops; 0: never.",
)
command(MotCommand_HEARTBEAT, 0, nothing, "Task is alive.")
command(MotCommand_SET_UNITS, 0, set_parameters, "Millimetres per lu, for the feed pins.")
command(MotCommand_SET_JERK, 0, set_parameters, "Cap on the jerk of the path, 0: none.")
command(MotCommand_SET_PLANNER_TYPE, 0, set_parameters, "`mode` 0: acceleration may jump; 1: jerk limits hold.")
command(MotCommand_SET_JOINT_JERK_LIMIT, JOINT, set_parameters, "Largest jerk, 0: none.")
command(MotCommand_SET_AXIS_JERK_LIMIT, AXIS, set_parameters, "Largest jerk, 0: none.")
