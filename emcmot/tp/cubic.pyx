"""Cubic spans, of which the path consists where jerk is limited: positions, and about how fast they may be passed.

Along q(u) the velocity of an axis is q' v, its acceleration q' a + q'' v^2 and its jerk q' j + 3 q'' v a + q''' v^3, where v, a
and j are those of u. Each span gets a v, a and j with which hardly an axis or joint breaks a limit, whatever their signs: most of
what an axis can do is for the speed, the rest for changing it. Spans are made, and plans guessed, by these; what
holds is found by equations. Only the cap of w, for velocities, is final.
Called by smooth (limits) and advance (positions).
"""

from libc.math cimport INFINITY, cbrt, fabs, fmax, fmin, sqrt

from emcmot.tp.model cimport AXES, Span, TpState
from emcmot.tp.profile cimport most_rate

cdef double BEND_SHARE = 0.95        # of an axis's acceleration, and
cdef double TWIST_SHARE = 0.4        # of its jerk, for the speed on a bend
cdef double TURN_SHARE = 0.6         # of the rest of the jerk, for changing the speed there
cdef double LEAST_SHARE = 0.02       # of acceleration and jerk, that is left at least

ctypedef struct Extent:              # of an axis or joint on a span: largest derivatives by u
    double rate
    double bend
    double twist


cdef void cubic_position(const Span* span, double u, double* q) noexcept nogil:
    """Position at u, exact at both ends."""
    cdef double x = u if 2.0 * u < span.h else u - span.h, dq, ddq, dddq
    cdef int i, j
    for i in range(AXES):
        q[i] = span.q0[i] if 2.0 * u < span.h else span.q1[i]
    for j in range(span.n):
        i = span.axis[j]
        if i >= AXES:
            break
        dddq = (span.ddq1[j] - span.ddq0[j]) / span.h
        dq = span.dq0[j] if 2.0 * u < span.h else span.dq1[j]
        ddq = span.ddq0[j] if 2.0 * u < span.h else span.ddq1[j]
        q[i] += x * (dq + x * (0.5 * ddq + x * dddq / 6.0))


cdef Extent _extent(const Span* span, int j) noexcept nogil:
    """Largest derivatives of one axis or joint on a span."""
    cdef Extent extent
    cdef double change = span.ddq1[j] - span.ddq0[j]
    extent.rate = fmax(fabs(span.dq0[j]), fabs(span.dq1[j]))
    if span.ddq0[j] * span.ddq1[j] < 0.0:
        extent.rate = fmax(extent.rate, fabs(span.dq0[j] - 0.5 * span.h * span.ddq0[j] * span.ddq0[j] / change))
    extent.bend = fmax(fabs(span.ddq0[j]), fabs(span.ddq1[j]))
    extent.twist = fabs(change) / span.h
    return extent


cdef void limit_cubic(const TpState* tp, Span* span) noexcept nogil:
    """Hard cap of w, and about the speed, acceleration and jerk along a span, whose derivatives, cap and acc are known."""
    cdef double w, v = INFINITY, a = span.acc, jerk = INFINITY, left
    cdef Extent extent
    cdef int j, i
    for j in range(span.n):
        i = span.axis[j]
        extent = _extent(span, j)
        if extent.rate > 0.0:
            v = fmin(v, tp.vmax[i] / (extent.rate * most_rate()))
    span.cap = w = fmin(span.cap, v * v)
    for j in range(span.n):
        i = span.axis[j]
        extent = _extent(span, j)
        if extent.bend > 0.0:
            w = fmin(w, BEND_SHARE * tp.amax[i] * span.tight / extent.bend)
        if extent.twist > 0.0:
            w = fmin(w, cbrt(TWIST_SHARE * tp.jmax[i] / extent.twist) ** 2)
    v = sqrt(w)
    for j in range(span.n):
        i = span.axis[j]
        extent = _extent(span, j)
        if extent.rate > 0.0:
            a = fmin(a, fmax(LEAST_SHARE * tp.amax[i], tp.amax[i] * span.tight - extent.bend * w) / extent.rate)
        if extent.bend > 0.0:
            left = fmax(LEAST_SHARE * tp.jmax[i], tp.jmax[i] - extent.twist * w * v)
            a = fmin(a, TURN_SHARE * left / (3.0 * extent.bend * v))
    for j in range(span.n):
        i = span.axis[j]
        extent = _extent(span, j)
        if extent.rate > 0.0:
            left = tp.jmax[i] - extent.twist * w * v - 3.0 * extent.bend * v * a
            jerk = fmin(jerk, fmax(LEAST_SHARE * tp.jmax[i], left) / extent.rate)
    span.steady = v
    span.push = a
    span.jerk = fmin(jerk, a / tp.dt)        # without a limit: any acceleration within a period


cdef double corner_speed(const TpState* tp, const double* turn, double half) noexcept nogil:
    """Speed at which a corner can be passed whose change of direction is spread over this half-width."""
    cdef double v = INFINITY, sharp
    cdef int i
    for i in range(AXES):
        sharp = fabs(turn[i])
        if sharp > 0.0:
            v = fmin(v, fmin(sqrt(BEND_SHARE * tp.amax[i] * half / sharp), cbrt(TWIST_SHARE * tp.jmax[i] * half * half / sharp)))
    return v


cdef double half_for_speed(const TpState* tp, const double* turn, double speed) noexcept nogil:
    """Half-width at which a corner no longer slows this speed."""
    cdef double half = 0.0, sharp
    cdef int i
    for i in range(AXES):
        sharp = fabs(turn[i])
        half = fmax(half, fmax(speed * speed * sharp / tp.amax[i], sqrt(speed * speed * speed * sharp / tp.jmax[i])))
    return half


cdef double first_speed(const TpState* tp, const double* rate) noexcept nogil:
    """Speed that the first period of a start brings where the first derivative by u is `rate`."""
    cdef double jerk = INFINITY
    cdef int i
    for i in range(AXES):
        if rate[i] != 0.0:
            jerk = fmin(jerk, fmin(tp.jmax[i], tp.amax[i] / tp.dt) / fabs(rate[i]))
    return jerk * tp.dt * tp.dt
