"""Motion with limited jerk."""

from emcmot.tp.model cimport TpState


cdef void move_smoothly(TpState* tp) noexcept nogil
