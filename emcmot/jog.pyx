"""Jogs of joints (free mode) and axes (teleop mode), by command and by wheel.

A jog sets target and speed of a free planner; the planner does the rest. Targets are kept within the soft limits, so
that every jog slows down in time. The command handler has checked mode and enable before it calls ``jog_joint`` or
``jog_axis``.
"""

from libc.math cimport fabs
from libc.stdio cimport snprintf

from emcmot._messages cimport MAX_AXES, MotionState_FREE, MotionState_TELEOP
from emcmot.free_planner cimport FreePlanner, free_planner_stop_point, free_planner_stopping_way
from emcmot.joint cimport jog_bounds, limit_own_moves
from emcmot.report cimport TEXT_SIZE, report
from emcmot.state cimport Axis, Joint, Motion
from emcmot.world cimport AXIS_NAMES, limit_axis_moves

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))

cdef double FAR = 1e6           # lu or deg: how far a jog without limits goes
cdef double AT_LIMIT = 1e-9     # lu or deg: closer than this to a limit is on it


cdef double within(double value, double low, double high) noexcept nogil:
    return low if value < low else high if value > high else value


cdef int aim(FreePlanner* p, int kind, double vel, double offset, double low, double high, int jogging) noexcept nogil:
    """Set the target of a jog within ``low`` and ``high``; -1 where it is at that limit or beyond it already.

    Increments add up: a second one counts from the target of the first. A jog that goes on may be given another speed.
    """
    cdef double origin = p.target if kind == JOG_INCREMENT and jogging and p.enabled else p.pos
    cdef double target
    if kind == JOG_CONTINUOUS:
        target = high if vel > 0.0 else low
    elif kind == JOG_INCREMENT:
        target = origin + offset if vel > 0.0 else origin - offset
    else:
        target = offset
    # outside of the limits only the way back is open
    if target >= high or target <= low:
        target = within(target, min(low, origin), max(high, origin))
        if fabs(target - origin) <= AT_LIMIT:
            return -1
    p.target = target
    p.enabled = 1
    p.active = 1
    return 0


cdef int makes_a_limit_worse(const Motion* m, const Joint* joint, int up) noexcept nogil:
    """Whether the switch on that side is closed. Of two that share a wire, an override lets either way open."""
    if joint.on_pos_limit and joint.on_neg_limit and m.override_limits:
        return 0
    return joint.on_pos_limit if up else joint.on_neg_limit


cdef int jog_joint(Motion* m, int number, int kind, double vel, double offset) noexcept nogil:
    cdef Joint* joint = &m.joint[number]
    cdef double low, high
    cdef int up = (vel > 0.0) == (offset >= 0.0) if kind == JOG_INCREMENT else vel > 0.0
    if kind == JOG_ABSOLUTE:
        up = offset > joint.free.pos
    if joint.home.sequence < 0:
        snprintf(
            report(m, number), TEXT_SIZE,
            b"Cannot jog joint %d because home_sequence is synchronized (%d)", number, joint.home.sequence,
        )
        return -1
    if locks_an_axis(m, number):
        snprintf(report(m, number), TEXT_SIZE, b"Can't jog locking joint_num=%d", number)
        return -1
    if makes_a_limit_worse(m, joint, up):
        snprintf(
            report(m, number), TEXT_SIZE, b"Can't jog joint %d further past %s hard limit.", number,
            b"max" if up else b"min",
        )
        return -1
    jog_bounds(joint, &low, &high)
    low = within(low, joint.free.pos - FAR, 1e300)
    high = within(high, -1e300, joint.free.pos + FAR)
    if aim(&joint.free, kind, vel, offset, low, high, joint.kb_jog) != 0:
        snprintf(
            report(m, number), TEXT_SIZE, b"Can't jog joint %d further past %s soft limit. It is at %.4f, limit %.4f",
            number, b"max" if up else b"min", joint.free.pos, high if up else low,
        )
        return -1
    joint.jog_vel = fabs(vel)
    limit_own_moves(joint, 1.0)
    joint.kb_jog = 1
    joint.wheel_jog = 0
    m.overriding_jog = m.override_limits != 0
    return 0


cdef int locks_an_axis(Motion* m, int joint) noexcept nogil:
    """Whether this joint is the locking indexer of an axis: it moves in programs only."""
    cdef int n
    for n in range(MAX_AXES):
        if m.axis[n].locking_joint == joint:
            return 1
    return 0


cdef int synchronised_joint(Motion* m, int number) noexcept nogil:
    """A joint of this axis that is not homed and must home together with others; -1: none."""
    cdef int n
    for n in range(m.kins.joints):
        if m.kins.axis_of_joint[n] == number and m.joint[n].home.sequence < 0 and not m.joint[n].home.homed:
            return n
    return -1


cdef int may_jog_axis(Motion* m, int number) noexcept nogil:
    """1, or 0 with a report of what speaks against it."""
    cdef int joint = m.axis[number].locking_joint
    if joint >= 0:
        snprintf(
            report(m), TEXT_SIZE, b"Cannot jog a locking indexer AXIS_%c,joint_num=%d", AXIS_NAMES[number], joint
        )
        return 0
    joint = synchronised_joint(m, number)
    if joint >= 0:
        snprintf(
            report(m, joint), TEXT_SIZE,
            b"Homing is REQUIRED to jog requested coordinate because joint (%d) home_sequence is synchronized (%d)",
            joint, m.joint[joint].home.sequence,
        )
        return 0
    return 1


cdef int jog_axis(Motion* m, int number, int kind, double vel, double offset) noexcept nogil:
    cdef Axis* axis = &m.axis[number]
    cdef double low = within(axis.min_limit, axis.teleop.pos - FAR, 1e300)
    cdef double high = within(axis.max_limit, -1e300, axis.teleop.pos + FAR)
    cdef int up = (vel > 0.0) == (offset >= 0.0) if kind == JOG_INCREMENT else vel > 0.0
    if kind == JOG_ABSOLUTE:
        up = offset > axis.teleop.pos
    if axis.vel_net <= 0.0 or axis.acc_net <= 0.0:
        snprintf(report(m), TEXT_SIZE, b"Can't jog axis %c: this machine has none", AXIS_NAMES[number])
        return -1
    if not may_jog_axis(m, number):
        return -1
    if aim(&axis.teleop, kind, vel, offset, low, high, axis.kb_jog) != 0:
        snprintf(
            report(m), TEXT_SIZE, b"Can't jog axis %c further past %s soft limit. It is at %.4f, limit %.4f",
            AXIS_NAMES[number], b"max" if up else b"min", axis.teleop.pos, high if up else low,
        )
        return -1
    axis.jog_vel = fabs(vel)
    limit_axis_moves(axis, 1.0)
    axis.kb_jog = 1
    axis.wheel_jog = 0
    m.overriding_jog = m.override_limits != 0
    return 0


cdef void stop_joint_jog(Joint* joint) noexcept nogil:
    joint.free.enabled = 0
    joint.kb_jog = 0
    joint.wheel_jog = 0


cdef void stop_axis_jog(Axis* axis) noexcept nogil:
    axis.teleop.enabled = 0
    axis.kb_jog = 0
    axis.wheel_jog = 0


cdef void stop_jogs(Motion* m) noexcept nogil:
    """Every jog comes to rest; homing moves go on."""
    cdef int n
    for n in range(m.num_joints):
        if not m.joint[n].home.homing:
            stop_joint_jog(&m.joint[n])
    for n in range(MAX_AXES):
        stop_axis_jog(&m.axis[n])


cdef void turn(FreePlanner* p, double way, int velocity_mode, double low, double high, double dt) noexcept nogil:
    """Move the target by what the wheel was turned; in velocity mode no further than where it can stop at once."""
    cdef double lead
    cdef double target = (p.target if p.enabled else free_planner_stop_point(p, dt)) + way
    if velocity_mode:
        lead = free_planner_stopping_way(p)
        target = within(target, p.pos - lead, p.pos + lead)
    if target > high:
        target = high if p.pos <= high else p.pos
    elif target < low:
        target = low if p.pos >= low else p.pos
    p.target = target
    p.enabled = 1
    p.active = 1


cdef double fraction(double value) noexcept nogil:
    """jog-accel-fraction counts from 0 (not included) to 1."""
    return value if 0.0 < value <= 1.0 else 1.0


cdef int may_wheel_jog_joint(Motion* m, Joint* joint, int number) noexcept nogil:
    """1, or 0 with a report, once, of what speaks against it."""
    if joint.home.sequence < 0:
        if not joint.wheel_refused:
            snprintf(
                report(m, number), TEXT_SIZE, b"Cannot wheel jog joint %d because home_sequence synchronized (%d)", number,
                joint.home.sequence,
            )
        return 0
    if locks_an_axis(m, number):
        if not joint.wheel_refused:
            snprintf(report(m, number), TEXT_SIZE, b"Can't wheel jog locking joint_num=%d", number)
        return 0
    return 1


cdef void joint_wheel(Motion* m, Joint* joint, int number, int homing) noexcept nogil:
    cdef double low, high
    cdef int counts = joint.jog_counts - joint.wheel_counts
    joint.wheel_counts = joint.jog_counts
    if not joint.jog_enable or m.mode != MotionState_FREE or homing:
        return
    if not m.enabled or m.jog_inhibit or m.jog_stop or joint.kb_jog or not joint.active:
        return
    if makes_a_limit_worse(m, joint, (counts > 0) == (joint.jog_scale > 0.0)):
        return
    if not may_wheel_jog_joint(m, joint, number):
        joint.wheel_refused = 1
        return
    joint.wheel_refused = 0
    jog_bounds(joint, &low, &high)
    joint.jog_vel = joint.vel_limit
    joint.free.vel_limit = joint.vel_limit
    limit_own_moves(joint, fraction(joint.jog_accel_fraction))
    turn(&joint.free, counts * joint.jog_scale, joint.jog_vel_mode, low, high, m.dt)
    joint.wheel_jog = 1
    m.overriding_jog = m.override_limits != 0


cdef void axis_wheel(Motion* m, Axis* axis, int number) noexcept nogil:
    cdef int counts = axis.jog_counts - axis.wheel_counts
    axis.wheel_counts = axis.jog_counts
    if not axis.jog_enable or m.mode != MotionState_TELEOP or not m.enabled:
        return
    if m.jog_inhibit or m.jog_stop or axis.kb_jog or axis.vel_net <= 0.0 or axis.wheel_refused:
        return
    if not may_jog_axis(m, number):
        axis.wheel_refused = 1
        return
    axis.jog_vel = axis.vel_net
    axis.teleop.vel_limit = axis.vel_net
    limit_axis_moves(axis, fraction(axis.jog_accel_fraction))
    turn(&axis.teleop, counts * axis.jog_scale, axis.jog_vel_mode, axis.min_limit, axis.max_limit, m.dt)
    axis.wheel_jog = 1
