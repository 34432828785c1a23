"""Running back along the executed path, and forwards again; see the module."""

from emcmot.tp.model cimport TpState

cdef int turn_back(TpState* tp) noexcept nogil
cdef void turn_forward(TpState* tp) noexcept nogil
