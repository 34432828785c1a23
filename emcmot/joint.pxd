"""The joint controller: feedback, following error and switches in; compensation and motor commands out."""

from emcmot.state cimport Joint, Motion

cdef void read_joints(Motion* m) noexcept nogil
cdef void write_joints(Motion* m) noexcept nogil
cdef void command_joint(Joint* joint, double pos, double dt) noexcept nogil
cdef void jog_bounds(const Joint* joint, double* low, double* high) noexcept nogil
cdef void set_joint_position(Joint* joint, double pos) noexcept nogil
