"""EMCMOT_STATUS out of the state of motion."""

from emcmot.state cimport Motion

cdef void fill_status(Motion* m) noexcept nogil
