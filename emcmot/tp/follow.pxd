"""Moves that follow a spindle: threads (position) and feed per revolution (velocity)."""

from emcmot.tp.model cimport Segment, TpState

cdef int follows_position(const Segment* seg) noexcept nogil
cdef int follows_velocity(const Segment* seg) noexcept nogil
cdef int waits_for_index(TpState* tp, const Segment* seg) noexcept nogil
cdef double spindle_speed(TpState* tp, const Segment* seg) noexcept nogil
cdef void count_way(TpState* tp, const Segment* seg, double way) noexcept nogil
