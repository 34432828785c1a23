"""Segments as curves: position and derivatives by the segment's own parameter."""

from emcmot.tp.model cimport Segment
from emcmot.tp.tp cimport TpSegment

cdef int shape(Segment* seg, const TpSegment* given, const double* start) noexcept nogil
cdef void position(const Segment* seg, double u, double* q) noexcept nogil
cdef void derivatives(const Segment* seg, double u, double* dq, double* ddq) noexcept nogil
cdef double length(const double* v) noexcept nogil
cdef double norm(const double* v, int unit) noexcept nogil
