"""External offsets: a shift of each axis by HAL (torch height control, adaptive compensation), on top of the
planners.

Each axis follows counts * scale with a planner of its own, whose limits are the share of the axis limits that the
INI's OFFSET_AV_RATIO leaves to it; task has lowered the planner's limits by the same share. Offsets act in teleop
and coordinated mode of a homed machine, and come to rest before the mode changes or the machine is off.
"""

from emcmot._messages cimport MAX_AXES
from emcmot.free_planner cimport free_planner_rest_at, free_planner_step
from emcmot.state cimport Axis, Motion

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))


cdef void follow(Motion* m, Axis* axis, int allowed) noexcept nogil:
    """One period of one axis."""
    cdef double target
    if axis.eoffset_enable and allowed:
        axis.eoffset_register += axis.eoffset_counts - axis.eoffset_last_counts
    axis.eoffset_last_counts = axis.eoffset_counts
    if axis.eoffset_clear:
        axis.eoffset_register = 0.0
    axis.eoffset_request = axis.eoffset_register * axis.eoffset_scale
    target = axis.eoffset_request
    if axis.pos_cmd + target > axis.max_limit:
        target = axis.max_limit - axis.pos_cmd
        m.eoffset_limited = 1
    elif axis.pos_cmd + target < axis.min_limit:
        target = axis.min_limit - axis.pos_cmd
        m.eoffset_limited = 1
    axis.eoffset.target = target
    axis.eoffset.vel_limit = axis.eoffset_vel_limit
    axis.eoffset.acc_limit = axis.eoffset_acc_limit
    axis.eoffset.jerk_limit = axis.eoffset_jerk_limit
    axis.eoffset.enabled = allowed
    free_planner_step(&axis.eoffset, m.dt)


cdef void forget_eoffsets(Motion* m) noexcept nogil:
    """When the drives are switched on, the joints are where they are, and every offset begins at 0."""
    cdef int n
    for n in range(MAX_AXES):
        m.eoffset[n] = 0.0
        m.axis[n].eoffset_register = 0.0
        free_planner_rest_at(&m.axis[n].eoffset, 0.0)
