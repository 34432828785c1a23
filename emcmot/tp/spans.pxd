"""Making spans: what those of all kinds have in common."""

from libc.stdint cimport int64_t

from emcmot.tp.model cimport Span, TpState

cdef Span* new_span(TpState* tp, int kind, int64_t seg, double u0, double h) noexcept nogil
cdef void keep_derivatives(
    Span* span, const double* dq0, const double* dq1, const double* ddq0, const double* ddq1) noexcept nogil
cdef void limit_speed(
    const TpState* tp, Span* span, const double* dq0, const double* dq1, double vel_max, int unit) noexcept nogil
