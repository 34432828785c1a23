"""The joint controller: feedback, following error and switches in; compensation and motor commands out.

Inline is what the controller does in every period, here as in its neighbours: a servo cycle begins with cold caches,
and calls from module to module would take it longer than the work.
"""

from libc.math cimport fabs

from emcmot.homing cimport homing_ignores_limits, take_index
from emcmot.state cimport Joint, Motion

cdef void correct(Joint* joint, double dt) noexcept nogil
cdef void jog_bounds(const Joint* joint, double* low, double* high) noexcept nogil
cdef void set_joint_position(Joint* joint, double pos) noexcept nogil


cdef inline void limit_own_moves(Joint* joint, double share) noexcept nogil:
    """The acceleration (a share of the joint's) and the jerk of jogs and homing."""
    joint.free.acc_limit = share * joint.acc_limit
    joint.free.jerk_limit = joint.jerk_net


cdef inline void read_joints(Motion* m) noexcept nogil:
    """Take the feedback and the switches of this period; note what is wrong, judge nothing."""
    cdef int n
    cdef Joint* joint
    cdef int ignore
    cdef double tolerance = 1e-7  # lu or deg: what rounding may add to an end point on the limit
    for n in range(m.num_joints):
        joint = &m.joint[n]
        if joint.home.index_armed and not joint.index_enable:
            take_index(joint)
        joint.pos_fb = joint.motor_pos_fb - joint.correction.pos - joint.motor_offset
        joint.ferror = joint.pos_cmd - joint.pos_fb
        if n >= m.num_joints - m.num_extra_joints and joint.home.homed:
            joint.ferror = 0.0
        joint.ferror_limit = joint.max_ferror * fabs(joint.vel_cmd) / joint.vel_limit if joint.vel_limit > 0.0 else 0.0
        if joint.ferror_limit < joint.min_ferror:
            joint.ferror_limit = joint.min_ferror
        if fabs(joint.ferror) > joint.ferror_high_mark:
            joint.ferror_high_mark = fabs(joint.ferror)
        # written so that a feedback that is not a number is an error too
        joint.ferrored = joint.active and not (fabs(joint.ferror) <= joint.ferror_limit)
        ignore = homing_ignores_limits(joint)
        joint.on_pos_limit = joint.active and joint.pos_lim_sw and not ignore
        joint.on_neg_limit = joint.active and joint.neg_lim_sw and not ignore
        joint.faulted = joint.active and joint.amp_fault_in
        joint.on_soft_pos = joint.home.homed and joint.pos_cmd > joint.max_limit + tolerance
        joint.on_soft_neg = joint.home.homed and joint.pos_cmd < joint.min_limit - tolerance


cdef inline void command_joint(Joint* joint, double pos, double dt) noexcept nogil:
    """Make ``pos`` the commanded position of this period."""
    cdef double vel = (pos - joint.pos_cmd) / dt
    cdef double acc = (vel - joint.vel_cmd) / dt
    joint.jerk_cmd = (acc - joint.acc_cmd) / dt
    joint.acc_cmd = acc
    joint.vel_cmd = vel
    joint.pos_cmd = pos


cdef inline void write_joints(Motion* m) noexcept nogil:
    """From the joint's command to the motor's."""
    cdef int n
    cdef Joint* joint
    for n in range(m.num_joints):
        joint = &m.joint[n]
        if joint.backlash != 0.0 or joint.comp.points > 1 or joint.correction.pos != 0.0:
            correct(joint, m.dt)
        joint.motor_pos_cmd = joint.pos_cmd + joint.correction.pos + joint.motor_offset
        if n >= m.num_joints - m.num_extra_joints and joint.home.homed:
            joint.motor_pos_cmd = joint.posthome_cmd + joint.motor_offset
        joint.inpos = not joint.free.active and not joint.home.homing
