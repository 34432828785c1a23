"""Motion along the planned path with limited jerk."""

from emcmot.tp.model cimport TpState

cdef void move_smoothly(TpState* tp) noexcept nogil
cdef void forget_stretches(TpState* tp) noexcept nogil
