"""How long spans are where jerk is limited."""

from emcmot.tp.model cimport Segment, Span, TpState

cdef double piece(const TpState* tp, const Segment* seg, double begin, double way) noexcept nogil
cdef double turn(const Span* span) noexcept nogil
