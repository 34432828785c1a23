"""The joint controller of the architecture's block diagram: one for each joint, independent of kinematics and mode.

Positions: pos_cmd (+ correction + motor_offset) = motor_pos_cmd; motor_pos_fb (- correction - motor_offset) = pos_fb.
Called by the controller: ``read_joints`` first in a period, ``write_joints`` last.
"""

from emcmot.free_planner cimport free_planner_rest_at, free_planner_step
from emcmot.state cimport Compensation, Joint, Motion

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))

# The share of a joint's own limits that backlash and screw compensation may add to the motor's speed and acceleration.
cdef double CORRECTION_SHARE = 0.5


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


cdef void jog_bounds(const Joint* joint, double* low, double* high) noexcept nogil:
    """How far a jog may take the joint: its soft limits, or its whole travel either way while it is not homed."""
    cdef double travel = joint.max_limit - joint.min_limit
    if joint.home.homed:
        low[0] = joint.min_limit
        high[0] = joint.max_limit
    else:
        low[0] = joint.pos_fb - travel
        high[0] = joint.pos_fb + travel
