"""The SET_xxx family of commands: each row says which field of the command becomes which member of the state.

A command may have several rows; all of its values are checked before the first is taken. ``PARAMETERS`` lists them
for the documentation.
"""

from libc.math cimport isfinite
from libc.stddef cimport size_t
from libc.stdio cimport snprintf

from emcmot._messages cimport (
    EMCMOT_COMMAND,
    MAX_AXES,
    MotCommand_SET_ACC,
    MotCommand_SET_AXIS_ACC_LIMIT,
    MotCommand_SET_AXIS_JERK_LIMIT,
    MotCommand_SET_AXIS_LOCKING_JOINT,
    MotCommand_SET_AXIS_POSITION_LIMITS,
    MotCommand_SET_AXIS_VEL_LIMIT,
    MotCommand_SET_HEARTBEAT_TIMEOUT,
    MotCommand_SET_JERK,
    MotCommand_SET_JOINT_ACC_LIMIT,
    MotCommand_SET_JOINT_BACKLASH,
    MotCommand_SET_JOINT_HOMING_PARAMS,
    MotCommand_SET_JOINT_JERK_LIMIT,
    MotCommand_SET_JOINT_MAX_FERROR,
    MotCommand_SET_JOINT_MIN_FERROR,
    MotCommand_SET_JOINT_POSITION_LIMITS,
    MotCommand_SET_JOINT_VEL_LIMIT,
    MotCommand_SET_MAX_FEED_OVERRIDE,
    MotCommand_SET_OFFSET,
    MotCommand_SET_PLANNER_TYPE,
    MotCommand_SET_SPINDLE_PARAMS,
    MotCommand_SET_TERM_COND,
    MotCommand_SET_UNITS,
    MotCommand_SET_VEL,
    MotCommand_SET_VEL_LIMIT,
    MotCommand_SET_WORLD_HOME,
    MotCommandStatus_INVALID_PARAMS,
    MotCommandStatus_OK,
    MotCommand_UPDATE_JOINT_HOMING_PARAMS,
)
from emcmot.report cimport TEXT_SIZE, report
from emcmot.state cimport Axis, Joint, Motion, Spindle
from emcmot.world cimport refresh_planner_limits

from emcmot.layout import same_size
from nml.emc.emcmot import EMCMOT_COMMAND as CommandMessage
from nml.emc.emcmot import MotCommand

same_size(__name__, "Motion", sizeof(Motion))

cdef enum Owner:
    OF_JOINT
    OF_AXIS
    OF_SPINDLE
    OF_MOTION

cdef enum Rule:
    ANY
    NOT_NEGATIVE
    POSITIVE
    NOT_BELOW_PREVIOUS   # an upper limit after its lower one
    INTEGER
    ZERO_OR_ONE

ctypedef struct Row:
    int code
    int owner
    int rule
    size_t source
    size_t target

cdef enum:
    MAX_ROWS = 80

cdef Row ROWS[MAX_ROWS]
cdef int row_count = 0
cdef EMCMOT_COMMAND C      # these four stand for any such record: only the distances in them count
cdef Joint J
cdef Axis A
cdef Spindle S
cdef Motion M

cdef const char** RULE_TEXTS = [
    "a number",
    "a number that is not negative",
    "a number above 0",
    "not below the lower limit",
    "an integer",
    "0 or 1",
]
OWNERS = ("joint", "axis", "spindle", "machine")
PARAMETERS: list[tuple[str, str, str, str]] = []   # command, of what, field of the command, what it takes


cdef int acceptable(int rule, double value, double previous) noexcept nogil:
    if not isfinite(value):
        return 0
    if rule == NOT_NEGATIVE:
        return value >= 0.0
    if rule == POSITIVE:
        return value > 0.0
    if rule == ZERO_OR_ONE:
        return value == 0.0 or value == 1.0
    if rule == NOT_BELOW_PREVIOUS:
        return value >= previous
    return 1


cdef int is_integer(int rule) noexcept nogil:
    return rule == INTEGER or rule == ZERO_OR_ONE


cdef double value_of(const char* source, int rule) noexcept nogil:
    return (<int*>source)[0] if is_integer(rule) else (<double*>source)[0]


cdef char* owner_of(Motion* m, int owner, const EMCMOT_COMMAND* c) noexcept nogil:
    if owner == OF_JOINT:
        return <char*>&m.joint[c.joint]
    if owner == OF_AXIS:
        return <char*>&m.axis[c.axis]
    if owner == OF_SPINDLE:
        return <char*>&m.spindle[c.spindle]
    return <char*>m


cdef int set_parameters(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """Take the values of a SET_xxx command; the command table has checked joint, axis and spindle numbers."""
    cdef int i
    cdef double value
    cdef double previous = 0.0
    cdef const char* source = <const char*>c
    cdef char* target
    for i in range(row_count):
        if ROWS[i].code == c.command:
            value = value_of(source + ROWS[i].source, ROWS[i].rule)
            if not acceptable(ROWS[i].rule, value, previous):
                snprintf(
                    report(m), TEXT_SIZE, b"Motion command %d refused: %g is not %s",
                    c.command, value, RULE_TEXTS[ROWS[i].rule],
                )
                return MotCommandStatus_INVALID_PARAMS
            previous = value
    for i in range(row_count):
        if ROWS[i].code == c.command:
            target = owner_of(m, ROWS[i].owner, c) + ROWS[i].target
            if is_integer(ROWS[i].rule):
                (<int*>target)[0] = (<int*>(source + ROWS[i].source))[0]
            else:
                (<double*>target)[0] = (<double*>(source + ROWS[i].source))[0]
    m.config_num += 1
    m.planner.set_vel_limit(m.tp, m.vel_limit)
    m.planner.set_planner_type(m.tp, m.planner_type)
    refresh_planner_limits(m)
    return MotCommandStatus_OK


cdef void row(int code, int owner, int rule, void* source, size_t target) except *:
    global row_count
    cdef size_t at = <char*>source - <char*>&C
    ROWS[row_count] = Row(code, owner, rule, at, target)
    row_count += 1
    field = next(f.name for f in CommandMessage.FIELDS if f.offset <= at < f.offset + f.size)
    PARAMETERS.append((MotCommand(code).name, OWNERS[owner], field, RULE_TEXTS[rule].decode()))


cdef void of_joint(int code, int rule, void* source, void* target) except *:
    row(code, OF_JOINT, rule, source, <char*>target - <char*>&J)


cdef void of_axis(int code, int rule, void* source, void* target) except *:
    row(code, OF_AXIS, rule, source, <char*>target - <char*>&A)


cdef void of_spindle(int code, int rule, void* source, void* target) except *:
    row(code, OF_SPINDLE, rule, source, <char*>target - <char*>&S)


cdef void of_machine(int code, int rule, void* source, void* target) except *:
    row(code, OF_MOTION, rule, source, <char*>target - <char*>&M)


cdef void of_machine_pose(int code, double* source, double* target) except *:
    cdef int n
    for n in range(MAX_AXES):
        of_machine(code, ANY, &source[n], &target[n])


of_joint(MotCommand_SET_JOINT_POSITION_LIMITS, ANY, &C.minLimit, &J.min_limit)
of_joint(MotCommand_SET_JOINT_POSITION_LIMITS, NOT_BELOW_PREVIOUS, &C.maxLimit, &J.max_limit)
of_joint(MotCommand_SET_JOINT_BACKLASH, ANY, &C.backlash, &J.backlash)
of_joint(MotCommand_SET_JOINT_MIN_FERROR, NOT_NEGATIVE, &C.minFerror, &J.min_ferror)
of_joint(MotCommand_SET_JOINT_MAX_FERROR, NOT_NEGATIVE, &C.maxFerror, &J.max_ferror)
of_joint(MotCommand_SET_JOINT_VEL_LIMIT, POSITIVE, &C.vel, &J.vel_limit)
of_joint(MotCommand_SET_JOINT_ACC_LIMIT, POSITIVE, &C.acc, &J.acc_limit)
of_joint(MotCommand_SET_JOINT_JERK_LIMIT, NOT_NEGATIVE, &C.jerk, &J.jerk_limit)
of_joint(MotCommand_SET_JOINT_HOMING_PARAMS, ANY, &C.offset, &J.home.offset)
of_joint(MotCommand_SET_JOINT_HOMING_PARAMS, ANY, &C.home, &J.home.home)
of_joint(MotCommand_SET_JOINT_HOMING_PARAMS, ANY, &C.home_final_vel, &J.home.final_vel)
of_joint(MotCommand_SET_JOINT_HOMING_PARAMS, ANY, &C.search_vel, &J.home.search_vel)
of_joint(MotCommand_SET_JOINT_HOMING_PARAMS, ANY, &C.latch_vel, &J.home.latch_vel)
of_joint(MotCommand_SET_JOINT_HOMING_PARAMS, INTEGER, &C.flags, &J.home.flags)
of_joint(MotCommand_SET_JOINT_HOMING_PARAMS, INTEGER, &C.home_sequence, &J.home.sequence)
of_joint(MotCommand_SET_JOINT_HOMING_PARAMS, INTEGER, &C.volatile_home, &J.home.is_volatile)
of_joint(MotCommand_UPDATE_JOINT_HOMING_PARAMS, ANY, &C.offset, &J.home.offset)
of_joint(MotCommand_UPDATE_JOINT_HOMING_PARAMS, ANY, &C.home, &J.home.home)
of_joint(MotCommand_UPDATE_JOINT_HOMING_PARAMS, INTEGER, &C.home_sequence, &J.home.sequence)
of_axis(MotCommand_SET_AXIS_POSITION_LIMITS, ANY, &C.minLimit, &A.min_limit)
of_axis(MotCommand_SET_AXIS_POSITION_LIMITS, NOT_BELOW_PREVIOUS, &C.maxLimit, &A.max_limit)
of_axis(MotCommand_SET_AXIS_VEL_LIMIT, NOT_NEGATIVE, &C.vel, &A.vel_limit)
of_axis(MotCommand_SET_AXIS_VEL_LIMIT, NOT_NEGATIVE, &C.ext_offset_vel, &A.eoffset_vel_limit)
of_axis(MotCommand_SET_AXIS_ACC_LIMIT, NOT_NEGATIVE, &C.acc, &A.acc_limit)
of_axis(MotCommand_SET_AXIS_ACC_LIMIT, NOT_NEGATIVE, &C.ext_offset_acc, &A.eoffset_acc_limit)
of_axis(MotCommand_SET_AXIS_JERK_LIMIT, NOT_NEGATIVE, &C.jerk, &A.jerk_limit)
of_axis(MotCommand_SET_AXIS_LOCKING_JOINT, INTEGER, &C.joint, &A.locking_joint)
of_spindle(MotCommand_SET_SPINDLE_PARAMS, NOT_NEGATIVE, &C.minSpeed, &S.min_speed)
of_spindle(MotCommand_SET_SPINDLE_PARAMS, NOT_NEGATIVE, &C.maxSpeed, &S.max_speed)
of_spindle(MotCommand_SET_SPINDLE_PARAMS, ANY, &C.maxLimit, &S.min_reverse_speed)
of_spindle(MotCommand_SET_SPINDLE_PARAMS, ANY, &C.minLimit, &S.max_reverse_speed)
of_machine(MotCommand_SET_VEL, NOT_NEGATIVE, &C.vel, &M.next_vel)
of_machine(MotCommand_SET_VEL, NOT_NEGATIVE, &C.ini_maxvel, &M.next_vel_max)
of_machine(MotCommand_SET_VEL_LIMIT, NOT_NEGATIVE, &C.vel, &M.vel_limit)
of_machine(MotCommand_SET_ACC, NOT_NEGATIVE, &C.acc, &M.acc_limit)
of_machine(MotCommand_SET_JERK, NOT_NEGATIVE, &C.jerk, &M.jerk_limit)
of_machine(MotCommand_SET_PLANNER_TYPE, ZERO_OR_ONE, &C.mode, &M.planner_type)
of_machine(MotCommand_SET_TERM_COND, INTEGER, &C.termCond, &M.term_cond)
of_machine(MotCommand_SET_TERM_COND, NOT_NEGATIVE, &C.tolerance, &M.term_tolerance)
of_machine(MotCommand_SET_MAX_FEED_OVERRIDE, NOT_NEGATIVE, &C.scale, &M.max_feed_scale)
of_machine(MotCommand_SET_HEARTBEAT_TIMEOUT, NOT_NEGATIVE, &C.timeout, &M.heartbeat_timeout)
of_machine(MotCommand_SET_UNITS, POSITIVE, &C.scale, &M.mm_per_unit)
of_machine_pose(MotCommand_SET_WORLD_HOME, <double*>&C.pos, M.world_home)
of_machine_pose(MotCommand_SET_OFFSET, <double*>&C.tool_offset, M.tool_offset)
