"""The joint controller: feedback, following error and switches in; compensation and motor commands out."""

from emcmot.state cimport Joint, Motion

cdef void read_joints(Motion* m) noexcept nogil
cdef void write_joints(Motion* m) noexcept nogil
cdef void command_joint(Joint* joint, double pos, double dt) noexcept nogil
cdef void jog_bounds(const Joint* joint, double* low, double* high) noexcept nogil
cdef void set_joint_position(Joint* joint, double pos) noexcept nogil


cdef inline void limit_own_moves(Joint* joint, double share) noexcept nogil:
    """The acceleration (a share of the joint's) and the jerk of jogs and homing."""
    joint.free.acc_limit = share * joint.acc_limit
    joint.free.jerk_limit = joint.jerk_net
