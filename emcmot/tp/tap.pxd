"""Rigid tapping: in with the spindle, out with the spindle, back to the start."""

from emcmot.tp.model cimport Segment, TpState

cdef int tap(TpState* tp, const Segment* seg) noexcept nogil
cdef int at_rest(const TpState* tp) noexcept nogil
