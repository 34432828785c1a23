"""Arcs as cubic splines, where jerk is limited."""

from emcmot.tp.model cimport Segment, TpState

cdef void open_arc(TpState* tp, const Segment* arc, double half) noexcept nogil
cdef int arc_laid_out(const TpState* tp) noexcept nogil
cdef double end_spacing(const TpState* tp, const Segment* arc, double u, double tolerance) noexcept nogil
cdef int spline_arc(TpState* tp) noexcept nogil
