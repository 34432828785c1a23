"""Between axes and joints: kinematics, soft limits in Cartesian space, and the planner's axis limits."""

from libc.math cimport isfinite

from emcmot._messages cimport MAX_AXES, MAX_JOINTS
from emcmot.kins.kinematics cimport KINEMATICS_IDENTITY, KINEMATICS_INVERSE_ONLY
from emcmot.state cimport Axis, Motion

cdef enum Chase:         # Motion.chasing
    CHASE_BEHIND = 1     # a joint is a little behind its Cartesian command
    CHASE_LOST = 2       # by more than MIN_FERROR

cdef int inverse(Motion* m, double* joints, double* pose) noexcept nogil
cdef int world_home_reached(Motion* m) noexcept nogil
cdef int command_world(Motion* m, double* pose) noexcept nogil
cdef int align_joints(Motion* m) noexcept nogil
cdef int check_end_point(Motion* m, const char* what, long move_id, double* pose) noexcept nogil
cdef int check_box(Motion* m, const char* what, long move_id, const double* low, const double* high) noexcept nogil
cdef void refresh_planner_limits(Motion* m) noexcept nogil
cdef void limit_axis_moves(Axis* axis, double share) noexcept nogil
cdef const char* AXIS_NAMES


cdef inline int all_finite(const double* values, int count) noexcept nogil:
    cdef int i
    for i in range(count):
        if not isfinite(values[i]):
            return 0
    return 1


cdef inline int forward(Motion* m, double* joints, double* pose) noexcept nogil:
    """0 and the pose of these joints, or -1."""
    cdef double result[MAX_AXES]
    cdef int i
    if m.kins.forward == NULL or m.kins.type == KINEMATICS_INVERSE_ONLY:
        return -1
    for i in range(MAX_AXES):
        result[i] = pose[i]
    if m.kins.forward(m.kins, joints, result) != 0 or not all_finite(result, MAX_AXES):
        return -1
    for i in range(MAX_AXES):
        pose[i] = result[i]
    return 0


cdef inline int kinematics_usable(Motion* m) noexcept nogil:
    """Whether joint positions mean something to the kinematics: identity always does, others when all is homed."""
    return m.kins.type == KINEMATICS_IDENTITY or m.all_homed


cdef inline void update_world_feedback(Motion* m) noexcept nogil:
    """carte_pos_fb: forward kinematics where they work, the command where there are none, else left alone."""
    cdef double joints[MAX_JOINTS]
    cdef int n
    if m.kins.forward == NULL or m.kins.type == KINEMATICS_INVERSE_ONLY:
        for n in range(MAX_AXES):
            m.pos_fb[n] = m.pos_cmd[n]
        m.pos_fb_ok = m.pos_cmd_ok
        return
    if not kinematics_usable(m):
        m.pos_fb_ok = 0
        return
    for n in range(m.num_joints):
        joints[n] = m.joint[n].pos_fb
    m.pos_fb_ok = forward(m, joints, m.pos_fb) == 0


cdef inline int world_from_joints(Motion* m) noexcept nogil:
    """carte_pos_cmd of the joints' commands, in free mode; -1 where it cannot be known."""
    cdef double joints[MAX_JOINTS]
    cdef int n
    if not kinematics_usable(m):
        m.pos_cmd_ok = 0
        return -1
    if m.kins.forward == NULL or m.kins.type == KINEMATICS_INVERSE_ONLY:
        m.pos_cmd_ok = world_home_reached(m)
        return 0 if m.pos_cmd_ok else -1
    for n in range(m.num_joints):
        joints[n] = m.joint[n].pos_cmd
    m.pos_cmd_ok = forward(m, joints, m.pos_cmd) == 0
    return 0 if m.pos_cmd_ok else -1
