"""What the commands do that are no moves and no parameters; the table is in ``commands.pyx``, which checks first.

A handler returns a MotCommandStatus; where it refuses, it has reported why.
"""

from libc.stdio cimport snprintf

from emcmot._messages cimport (
    EMCMOT_COMMAND,
    Enables_AF,
    Enables_FH,
    Enables_FS,
    Enables_SS,
    MAX_AXES,
    MotCommand_AF_ENABLE,
    MotCommand_FH_ENABLE,
    MotCommand_FS_ENABLE,
    MotCommand_JOG_ABS,
    MotCommand_JOG_CONT,
    MotCommandStatus_BAD_EXEC,
    MotCommandStatus_INVALID_COMMAND,
    MotCommandStatus_INVALID_PARAMS,
    MotCommandStatus_OK,
    MotionState_COORD,
    MotionState_FREE,
    MotionState_TELEOP,
)
from emcmot.homing cimport HOME_IDLE, SEQUENCE_IDLE, rename_position
from emcmot.jog cimport (
    JOG_ABSOLUTE,
    JOG_CONTINUOUS,
    JOG_INCREMENT,
    jog_axis,
    jog_joint,
    stop_axis_jog,
    stop_jogs,
    stop_joint_jog,
)
from emcmot.kins.kinematics cimport KINEMATICS_INVERSE_ONLY
from emcmot.modes cimport resting, stop_all
from emcmot.report cimport TEXT_SIZE, report
from emcmot.spindle cimport orient_spindle, stop_spindle
from emcmot.state cimport COMP_POINTS, Compensation, Joint, Motion, Spindle
from emcmot.tp.tp cimport TP_OK
from emcmot.world cimport kinematics_usable

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))

cdef const char* JOG_INHIBITED = b"Cannot jog while jog-inhibit is active."
cdef double SPINDLE_STEP = 100.0  # rpm, of SPINDLE_INCREASE and SPINDLE_DECREASE


cdef int refuse(Motion* m, const char* text) noexcept nogil:
    snprintf(report(m), TEXT_SIZE, b"%s", text)
    return MotCommandStatus_INVALID_COMMAND


cdef int nothing(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    return MotCommandStatus_OK


cdef int abort(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    cdef int n
    stop_all(m)
    m.coord_error = 0
    for n in range(m.num_joints):
        m.joint[n].error = 0
    return MotCommandStatus_OK


cdef int enable(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    if not m.enable_in:
        return refuse(m, b"can't enable motion, enable input is false")
    m.enable_wanted = 1
    if not m.enabled and m.kins.type == KINEMATICS_INVERSE_ONLY:
        m.mode_wanted = MotionState_FREE
    return MotCommandStatus_OK


cdef int disable(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.enable_wanted = 0
    if m.kins.type == KINEMATICS_INVERSE_ONLY:
        m.mode_wanted = MotionState_FREE
    return MotCommandStatus_OK


cdef int want_mode(Motion* m, int mode, const char* name) noexcept nogil:
    """Ask for a mode. It comes at rest; while something moves that nobody stops, the answer is no."""
    if m.mode_wanted == mode and (m.mode == mode or not m.enabled):
        return MotCommandStatus_OK
    if mode != MotionState_FREE and not kinematics_usable(m):
        snprintf(report(m), TEXT_SIZE, b"all joints must be homed before going into %s mode", name)
        return MotCommandStatus_INVALID_COMMAND
    if m.enabled and not m.stopping and not resting(m):
        snprintf(report(m), TEXT_SIZE, b"can't go into %s mode while the machine is moving", name)
        return MotCommandStatus_INVALID_COMMAND
    m.mode_wanted = mode
    return MotCommandStatus_OK


cdef int free_mode(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    return want_mode(m, MotionState_FREE, b"joint")


cdef int teleop_mode(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    return want_mode(m, MotionState_TELEOP, b"teleop")


cdef int coord_mode(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    return want_mode(m, MotionState_COORD, b"coordinated")


cdef int pause(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    if m.mode == MotionState_COORD:
        m.planner.pause(m.tp)
    return MotCommandStatus_OK


cdef int resume(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.planner.resume(m.tp)
    m.stepping = 0
    return MotCommandStatus_OK


cdef int step(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    if m.mode == MotionState_COORD:
        m.planner.step_once(m.tp)
        m.stepping = 1
    return MotCommandStatus_OK


cdef int reverse(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    if not m.tp_status.paused:
        return refuse(m, b"can't run in reverse: pause the program first")
    if m.planner.set_reverse(m.tp, 1) != TP_OK:
        return refuse(m, b"can't run in reverse: the planner does not go back from here")
    m.command_reverse = not m.adaptive_reverse
    return MotCommandStatus_OK


cdef int forward(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    if m.tp_status.reversing and m.planner.set_reverse(m.tp, 0) != TP_OK:
        return refuse(m, b"can't run forward: pause the program first")
    m.command_reverse = m.adaptive_reverse
    return MotCommandStatus_OK


cdef int feed_scale(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.feed_scale = max(c.scale, 0.0)
    return MotCommandStatus_OK


cdef int rapid_scale(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.rapid_scale = min(max(c.scale, 0.0), 1.0)
    return MotCommandStatus_OK


cdef int spindle_scale(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.spindle[c.spindle].scale = max(c.scale, 0.0)
    return MotCommandStatus_OK


cdef int enable_override(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """The four xx_ENABLE commands; they act on the moves to come."""
    cdef int bit = Enables_SS
    if c.command == MotCommand_FS_ENABLE:
        bit = Enables_FS
    elif c.command == MotCommand_FH_ENABLE:
        bit = Enables_FH
    elif c.command == MotCommand_AF_ENABLE:
        bit = Enables_AF
    if c.mode:
        m.enables |= bit
    else:
        m.enables &= ~bit
    return MotCommandStatus_OK


cdef int override_limits(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """Ignore the limit switches that are closed now, until the end of the next jog; joint < 0 takes it back."""
    cdef int n
    m.override_limits = 0
    m.overriding_jog = 0
    if c.joint < 0:
        return MotCommandStatus_OK
    for n in range(m.num_joints):
        if m.joint[n].neg_lim_sw:
            m.override_limits |= 1 << 2 * n
        if m.joint[n].pos_lim_sw:
            m.override_limits |= 2 << 2 * n
    return MotCommandStatus_OK


cdef int jog(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """JOG_CONT, JOG_INCR, JOG_ABS of a joint (mode 1) or an axis (mode 0)."""
    cdef int kind = JOG_INCREMENT
    cdef int result
    if c.command == MotCommand_JOG_CONT:
        kind = JOG_CONTINUOUS
    elif c.command == MotCommand_JOG_ABS:
        kind = JOG_ABSOLUTE
    if m.jog_inhibit or m.jog_stop or m.jog_stop_immediate:
        return refuse(m, JOG_INHIBITED)
    if c.vel == 0.0:
        snprintf(report(m), TEXT_SIZE, b"can't jog at speed 0")
        return MotCommandStatus_INVALID_PARAMS
    if m.homing.is_active(m):
        return refuse(m, b"Can't jog any joints while homing.")
    if c.mode:
        if m.mode == MotionState_TELEOP:
            return refuse(m, b"Mode is TELEOP, cannot jog joint")
        if m.mode != MotionState_FREE:
            return refuse(m, b"can't jog a joint: motion is not in joint mode")
        if not m.joint[c.joint].active:
            return refuse(m, b"can't jog a joint that is not active")
        result = jog_joint(m, c.joint, kind, c.vel, c.offset)
    else:
        if m.mode != MotionState_TELEOP:
            return refuse(m, b"can't jog an axis: motion is not in teleop mode")
        result = jog_axis(m, c.axis, kind, c.vel, c.offset)
    return MotCommandStatus_OK if result == 0 else MotCommandStatus_INVALID_COMMAND


cdef int jog_abort(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    if not c.mode:
        stop_axis_jog(&m.axis[c.axis])
    elif not m.joint[c.joint].home.homing:
        stop_joint_jog(&m.joint[c.joint])
    return MotCommandStatus_OK


cdef int teleop_vector(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """Jog all axes at once: ``pos`` is the velocity vector."""
    cdef const double* velocity = <const double*>&c.pos
    cdef int n
    cdef int result = MotCommandStatus_OK
    if m.mode != MotionState_TELEOP:
        return refuse(m, b"can't move by a teleop vector: motion is not in teleop mode")
    if m.jog_inhibit or m.jog_stop or m.jog_stop_immediate:
        return refuse(m, JOG_INHIBITED)
    for n in range(MAX_AXES):
        if velocity[n] == 0.0:
            stop_axis_jog(&m.axis[n])
        elif jog_axis(m, n, JOG_CONTINUOUS, velocity[n], 0.0) != 0:
            result = MotCommandStatus_INVALID_COMMAND
    return result


cdef int home(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    if m.homing_inhibit:
        snprintf(report(m), TEXT_SIZE, b"Homing denied by motion.homing-inhibit joint=%d", c.joint)
        return MotCommandStatus_INVALID_COMMAND
    if m.home_step != SEQUENCE_IDLE:
        return refuse(m, b"can't home: a home sequence is running already")
    if c.joint < -1:
        return refuse(m, b"can't home: there is no such joint")
    if c.joint >= 0 and not m.joint[c.joint].active:
        return refuse(m, b"can't home a joint that is not active")
    stop_jogs(m)
    if c.joint == -1:
        m.homing.home_all(m)
    elif m.joint[c.joint].home.state != HOME_IDLE:
        return refuse(m, b"can't home: the joint is homing already")
    else:
        m.homing.home_joint(m, c.joint)
    return MotCommandStatus_OK


cdef int unhome(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """One joint, all (-1), or those with VOLATILE_HOME (-2); an extra joint, led by its pin, only while off."""
    cdef int n
    cdef int result = MotCommandStatus_OK
    if m.enabled and not resting(m):
        return refuse(m, b"can't unhome while the machine is moving or homing")
    if m.enabled and m.mode != MotionState_FREE:
        return refuse(m, b"must be in joint mode or disabled to unhome")
    for n in range(m.num_joints):
        if c.joint == n or c.joint == -1 or (c.joint == -2 and m.joint[n].home.is_volatile):
            if m.enabled and n >= m.num_joints - m.num_extra_joints:
                snprintf(report(m, n), TEXT_SIZE, b"Cannot unhome extrajoint <%d> with motion enabled", n)
                result = MotCommandStatus_INVALID_COMMAND
            else:
                m.joint[n].home.homed = 0
    m.homing.update_homed(m)
    return result


cdef int activate_joint(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.joint[c.joint].active = 1
    return MotCommandStatus_OK


cdef int deactivate_joint(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    if m.enabled and not resting(m):
        return refuse(m, b"can't deactivate a joint while the machine is moving")
    m.joint[c.joint].active = 0
    return MotCommandStatus_OK


cdef int enable_amplifier(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.joint[c.joint].amp_enable = 1
    return MotCommandStatus_OK


cdef int disable_amplifier(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.joint[c.joint].amp_enable = 0
    return MotCommandStatus_OK


cdef int set_num_joints(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    if m.enabled or not m.kins.joints <= c.joint <= m.max_joints:
        snprintf(
            report(m), TEXT_SIZE,
            b"can't set the number of joints to %d: motmod has %d, the kinematics need %d, and motion must be off",
            c.joint, m.max_joints, m.kins.joints,
        )
        return MotCommandStatus_INVALID_PARAMS
    m.num_joints = c.joint
    return MotCommandStatus_OK


cdef int set_num_spindles(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    if not 0 <= c.spindle <= m.max_spindles:
        snprintf(
            report(m), TEXT_SIZE, b"can't set the number of spindles to %d: motmod has %d", c.spindle, m.max_spindles
        )
        return MotCommandStatus_INVALID_PARAMS
    m.num_spindles = c.spindle
    return MotCommandStatus_OK


cdef int set_motor_offset(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """Another name for the place where the joint stands; the motor does not move."""
    cdef Joint* joint = &m.joint[c.joint]
    rename_position(joint, joint.motor_offset - c.motor_offset)
    return MotCommandStatus_OK


cdef int set_joint_comp(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """One more point of the joint's screw table; positions must rise."""
    cdef Compensation* comp = &m.joint[c.joint].comp
    if comp.points == COMP_POINTS:
        snprintf(
            report(m, c.joint), TEXT_SIZE, b"joint %d: too many compensation entries, %d fit", c.joint, COMP_POINTS
        )
        return MotCommandStatus_INVALID_PARAMS
    if comp.points and c.comp_nominal <= comp.nominal[comp.points - 1]:
        snprintf(report(m, c.joint), TEXT_SIZE, b"joint %d: compensation values must increase", c.joint)
        return MotCommandStatus_INVALID_PARAMS
    comp.nominal[comp.points] = c.comp_nominal
    comp.forward[comp.points] = c.comp_forward
    comp.reverse[comp.points] = c.comp_reverse
    comp.points += 1
    return MotCommandStatus_OK


cdef int set_probe_err_inhibit(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.probe_jog_inhibit = c.flags & 1
    m.probe_home_inhibit = c.flags >> 1 & 1
    return MotCommandStatus_OK


cdef int spindle_on(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    cdef Spindle* s = &m.spindle[c.spindle]
    stop_spindle(s)
    s.state = 1
    s.speed = c.vel
    s.css_maximum = c.ini_maxvel
    s.css_factor = c.acc
    s.xoffset = c.offset
    s.direction = 1 if c.vel >= 0.0 else -1
    s.brake = 0
    if c.wait_for_spindle_at_speed:
        m.wait_spindles |= 1 << c.spindle
    return MotCommandStatus_OK


cdef int spindle_off(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    stop_spindle(&m.spindle[c.spindle])
    m.wait_spindles &= ~(1 << c.spindle)
    return MotCommandStatus_OK


cdef int change_speed(Spindle* s, double by) noexcept nogil:
    """Faster or slower in the direction that it turns; it never turns the other way by this."""
    if s.state:
        s.speed = max(s.speed + by, 0.0) if s.direction > 0 else min(s.speed - by, 0.0)
        s.increasing = 1 if by > 0.0 else -1
    return MotCommandStatus_OK


cdef int spindle_increase(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    return change_speed(&m.spindle[c.spindle], SPINDLE_STEP)


cdef int spindle_decrease(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    return change_speed(&m.spindle[c.spindle], -SPINDLE_STEP)


cdef int spindle_brake_engage(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    stop_spindle(&m.spindle[c.spindle])
    return MotCommandStatus_OK


cdef int spindle_brake_release(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.spindle[c.spindle].brake = 0
    return MotCommandStatus_OK


cdef int spindle_orient(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    orient_spindle(&m.spindle[c.spindle], c.orientation, c.mode)
    return MotCommandStatus_OK
