"""Enabling, disabling, and the changes between free, teleop and coordinated mode."""

from emcmot.state cimport Motion

cdef int resting(Motion* m) noexcept nogil
cdef void stop_all(Motion* m) noexcept nogil
cdef void set_mode(Motion* m) noexcept nogil
cdef void fall_to_free(Motion* m) noexcept nogil
cdef void switch_kinematics(Motion* m) noexcept nogil
