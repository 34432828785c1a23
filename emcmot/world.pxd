"""Between axes and joints: kinematics, soft limits in Cartesian space, and the planner's axis limits."""

from emcmot.state cimport Axis, Motion

cdef enum Chase:         # Motion.chasing
    CHASE_BEHIND = 1     # a joint is a little behind its Cartesian command
    CHASE_LOST = 2       # by more than MIN_FERROR

cdef int forward(Motion* m, double* joints, double* pose) noexcept nogil
cdef int inverse(Motion* m, double* joints, double* pose) noexcept nogil
cdef void update_world_feedback(Motion* m) noexcept nogil
cdef int world_from_joints(Motion* m) noexcept nogil
cdef int command_world(Motion* m, double* pose) noexcept nogil
cdef int align_joints(Motion* m) noexcept nogil
cdef int check_end_point(Motion* m, const char* what, long move_id, double* pose) noexcept nogil
cdef int check_box(Motion* m, const char* what, long move_id, const double* low, const double* high) noexcept nogil
cdef void refresh_planner_limits(Motion* m) noexcept nogil
cdef void limit_axis_moves(Axis* axis, double share) noexcept nogil
cdef int kinematics_usable(Motion* m) noexcept nogil
cdef const char* AXIS_NAMES
