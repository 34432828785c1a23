"""The path where jerk is limited: cubic spans, laid ahead of the machine."""

from emcmot.tp.model cimport TpState

cdef void choose_smoothing(TpState* tp) noexcept nogil
cdef void forget_chain(TpState* tp) noexcept nogil
cdef void extend_smoothly(TpState* tp) noexcept nogil
