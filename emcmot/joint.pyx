"""The joint controller of the architecture's block diagram: one for each joint, independent of kinematics and mode.

Positions: pos_cmd (+ correction + motor_offset) = motor_pos_cmd; motor_pos_fb (- correction - motor_offset) = pos_fb.
Called by the controller: ``read_joints`` first in a period, ``write_joints`` last.
"""

from libc.math cimport fabs

from emcmot.free_planner cimport free_planner_rest_at, free_planner_step
from emcmot.homing cimport homing_ignores_limits, take_index
from emcmot.state cimport Compensation, Joint, Motion

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))

# The share of a joint's own limits that backlash and screw compensation may add to the motor's speed and acceleration.
cdef double CORRECTION_SHARE = 0.5
cdef double SOFT_LIMIT_TOLERANCE = 1e-7  # lu or deg: what rounding may add to an end point on the limit


cdef void read_joints(Motion* m) noexcept nogil:
    """Take the feedback and the switches of this period; note what is wrong, judge nothing."""
    cdef int n
    cdef Joint* joint
    cdef int ignore
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
        joint.on_soft_pos = joint.home.homed and joint.pos_cmd > joint.max_limit + SOFT_LIMIT_TOLERANCE
        joint.on_soft_neg = joint.home.homed and joint.pos_cmd < joint.min_limit - SOFT_LIMIT_TOLERANCE


cdef void command_joint(Joint* joint, double pos, double dt) noexcept nogil:
    """Make ``pos`` the commanded position of this period."""
    cdef double vel = (pos - joint.pos_cmd) / dt
    cdef double acc = (vel - joint.vel_cmd) / dt
    joint.jerk_cmd = (acc - joint.acc_cmd) / dt
    joint.acc_cmd = acc
    joint.vel_cmd = vel
    joint.pos_cmd = pos


cdef void set_joint_position(Joint* joint, double pos) noexcept nogil:
    """Stand still at ``pos`` from now on, without a move: for a joint whose drive is off, or a new motor offset."""
    joint.pos_cmd = pos
    joint.coarse_pos = pos
    joint.vel_cmd = 0.0
    joint.acc_cmd = 0.0
    joint.jerk_cmd = 0.0
    free_planner_rest_at(&joint.free, pos)


cdef double interpolate(const double* x, const double* y, int points, double at) noexcept nogil:
    """Linear between the points, constant beyond them."""
    cdef int low = 0
    cdef int high = points - 1
    cdef int middle
    if at <= x[0]:
        return y[0]
    if at >= x[high]:
        return y[high]
    while high - low > 1:
        middle = (low + high) // 2
        if x[middle] <= at:
            low = middle
        else:
            high = middle
    return y[low] + (y[high] - y[low]) * (at - x[low]) / (x[high] - x[low])


cdef void correct(Joint* joint, double dt) noexcept nogil:
    """Backlash or screw error: what the motor must do besides, smoothly."""
    cdef Compensation* comp = &joint.comp
    if joint.vel_cmd != 0.0:
        if comp.points > 1:
            joint.backlash_corr = interpolate(
                &comp.nominal[0], &comp.forward[0] if joint.vel_cmd > 0.0 else &comp.reverse[0], comp.points,
                joint.pos_cmd,
            )
        else:
            joint.backlash_corr = 0.5 * joint.backlash if joint.vel_cmd > 0.0 else -0.5 * joint.backlash
    joint.correction.target = joint.backlash_corr
    joint.correction.vel_limit = CORRECTION_SHARE * joint.vel_limit
    joint.correction.acc_limit = CORRECTION_SHARE * joint.acc_limit
    joint.correction.jerk_limit = CORRECTION_SHARE * joint.jerk_net
    joint.correction.enabled = 1
    free_planner_step(&joint.correction, dt)


cdef void write_joints(Motion* m) noexcept nogil:
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


cdef void jog_bounds(const Joint* joint, double* low, double* high) noexcept nogil:
    """How far a jog may take the joint: its soft limits, or its whole travel either way while it is not homed."""
    cdef double travel = joint.max_limit - joint.min_limit
    if joint.home.homed:
        low[0] = joint.min_limit
        high[0] = joint.max_limit
    else:
        low[0] = joint.pos_fb - travel
        high[0] = joint.pos_fb + travel
