"""Jogs of joints (free mode) and axes (teleop mode), by command and by wheel."""

from emcmot._messages cimport Enables_FS, MAX_AXES, MotionState_FREE
from emcmot.state cimport Axis, Joint, Motion

cdef enum JogKind:
    JOG_CONTINUOUS = 0
    JOG_INCREMENT = 1
    JOG_ABSOLUTE = 2

cdef int jog_joint(Motion* m, int number, int kind, double vel, double offset) noexcept nogil   # 0, or -1 and a report
cdef int jog_axis(Motion* m, int number, int kind, double vel, double offset) noexcept nogil
cdef void joint_wheel(Motion* m, Joint* joint, int number, int homing) noexcept nogil
cdef void axis_wheel(Motion* m, Axis* axis, int number) noexcept nogil
cdef void stop_jogs(Motion* m) noexcept nogil
cdef void stop_joint_jog(Joint* joint) noexcept nogil
cdef void stop_axis_jog(Axis* axis) noexcept nogil


cdef inline void jog_cycle(Motion* m) noexcept nogil:
    """Before the planners' step: stop pins, wheels, and speeds under the feed override."""
    cdef int n
    cdef int homing = 0
    cdef double scale = min(m.feed_scale, m.max_feed_scale) if m.enables & Enables_FS else 1.0
    cdef Joint* joint
    cdef Axis* axis
    if m.jog_active and (m.jog_stop or m.jog_stop_immediate):
        stop_jogs(m)
    for n in range(m.num_joints):
        homing |= m.joint[n].home.homing
    for n in range(m.num_joints):
        joint = &m.joint[n]
        if joint.jog_counts != joint.wheel_counts:
            joint_wheel(m, joint, n, homing)
        if not joint.home.homing and m.mode == MotionState_FREE:
            joint.free.vel_limit = min(joint.jog_vel, joint.vel_limit * scale)
    for n in range(MAX_AXES):
        axis = &m.axis[n]
        axis.wheel_refused &= axis.jog_enable
        if axis.jog_counts != axis.wheel_counts:
            axis_wheel(m, axis, n)
        axis.teleop.vel_limit = min(axis.jog_vel, axis.vel_net * scale)


cdef inline void end_jogs(Motion* m) noexcept nogil:
    """After the planners' step: which jogs have ended, and with them the override of limits."""
    cdef int n
    cdef Joint* joint
    cdef Axis* axis
    m.jog_active = 0
    for n in range(m.num_joints):
        joint = &m.joint[n]
        if not joint.free.active:
            joint.kb_jog = 0
            joint.wheel_jog = 0
        m.jog_active |= joint.kb_jog or joint.wheel_jog
    for n in range(MAX_AXES):
        axis = &m.axis[n]
        if not axis.teleop.active:
            axis.teleop.target = axis.teleop.pos
            axis.kb_jog = 0
            axis.wheel_jog = 0
        m.jog_active |= axis.kb_jog or axis.wheel_jog
    if m.overriding_jog and not m.jog_active and m.at_rest:
        m.override_limits = 0
        m.overriding_jog = 0
