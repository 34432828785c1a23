"""One servo period of motion."""

from emcmot.state cimport Motion

cdef void controller(Motion* m) noexcept nogil
