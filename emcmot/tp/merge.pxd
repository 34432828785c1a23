"""From raws to segments: runs of short moves become chords."""

from emcmot.tp.model cimport Segment, TpState

cdef int can_join(const Segment* before, const Segment* raw) noexcept nogil
cdef int take_segment(TpState* tp, int urgent) noexcept nogil
