"""How far an arc reaches between its end points."""

from emcmot.tp.tp cimport TpSegment

cdef void arc_box(const double* start, const TpSegment* s, double* low, double* high) noexcept nogil
