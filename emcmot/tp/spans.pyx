"""Making spans: what those of all kinds have in common. Called by path and by smooth, which lay them."""

from libc.math cimport INFINITY, fabs, fmax, fmin
from libc.stdint cimport int64_t

from emcmot.tp.geometry cimport norm
from emcmot.tp.model cimport AXES, Span, TpState

cdef double RESERVE = 0.98       # of accelerations and jerks, at first


cdef Span* new_span(TpState* tp, int kind, int64_t seg, double u0, double h) noexcept nogil:
    """A span at the end of the path, without limits."""
    cdef Span* span = &tp.spans[tp.span_tail & tp.span_mask]
    tp.span_tail += 1
    span.kind = kind
    span.stop = 0
    span.n = 0
    span.seg = seg
    span.u0 = u0
    span.h = h
    span.trim = 0.0
    span.ratio = 1.0
    span.acc = INFINITY
    span.tight = 1.0
    span.reserve = RESERVE
    span.beta = 0.0
    return span


cdef void keep_derivatives(
    Span* span, const double* dq0, const double* dq1, const double* ddq0, const double* ddq1) noexcept nogil:
    """Store the derivatives of the axes that move."""
    cdef int i
    span.n = 0
    for i in range(AXES):
        if dq0[i] != 0.0 or dq1[i] != 0.0 or ddq0[i] != 0.0 or ddq1[i] != 0.0:
            span.axis[span.n] = i
            span.dq0[span.n] = dq0[i]
            span.dq1[span.n] = dq1[i]
            span.ddq0[span.n] = ddq0[i]
            span.ddq1[span.n] = ddq1[i]
            span.n += 1


cdef void limit_speed(
    const TpState* tp, Span* span, const double* dq0, const double* dq1, double vel_max, int unit) noexcept nogil:
    """Hard cap of w, and what the feed is measured by."""
    cdef double rate, v
    cdef int i
    span.speed = span.speed_before = fmax(norm(dq0, unit), norm(dq1, unit))
    v = vel_max / span.speed
    for i in range(AXES):
        rate = fmax(fabs(dq0[i]), fabs(dq1[i]))
        if rate > 0.0:
            v = fmin(v, tp.vmax[i] * span.tight / rate)
    span.cap = v * v
