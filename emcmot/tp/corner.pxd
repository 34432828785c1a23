"""The blend that replaces the corner between two segments: its size and its spans."""

from emcmot.tp.model cimport Segment, Span, TpState

ctypedef struct Corner:
    int stop                 # the corner can only be passed at rest
    double trim              # u of the earlier segment that a blend takes; 0: none
    double ratio             # du of the later segment per du of the earlier one, where the blend ends

cdef double TANGENT          # difference of unit tangents that needs no blend

cdef int must_stop(const Segment* a, const Segment* b) noexcept nogil
cdef double corner_ratio(const Segment* a, const Segment* b, const double* t1, const double* t2) noexcept nogil
cdef double corner_tolerance(const Segment* a, const Segment* b, double sharpness) noexcept nogil
cdef Corner decide_corner(const TpState* tp, const Segment* a, const Segment* b, double room) noexcept nogil
cdef int blend_spans(const Segment* a, const Segment* b, const Corner* corner) noexcept nogil
cdef void blend_position(const Segment* a, const Segment* b, double trim, double u, double* q) noexcept nogil
cdef void blend_derivatives(
    const Segment* a, const Segment* b, const Corner* corner, double u, double* dq, double* ddq) noexcept nogil
