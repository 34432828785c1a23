"""Cubic spans, of which the path consists where jerk is limited: positions, and limits along them.

Along q(u) the velocity of an axis is q' v, its acceleration q' a + q'' v^2 and its jerk q' j + 3 q'' v a + q''' v^3, where v, a
and j are those of u. Each span gets a largest v, a and j with which no axis and no joint breaks a limit, whatever their
signs: most of what an axis can do is for the speed, the rest for changing it.
Called by smooth (limits) and advance (positions).
"""

from libc.math cimport INFINITY, cbrt, fabs, fmax, fmin, sqrt

from emcmot.tp.model cimport AXES, Span, TpState

cdef double BEND_SHARE = 0.95        # of an axis's acceleration, and
cdef double TWIST_SHARE = 0.4       # of its jerk, for the speed on a bend
cdef double LEAST_SHARE = 0.02
cdef double TURN_SHARE = 0.6         # of the rest of the jerk, for changing the speed there


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


cdef inline double _rate(const Span* span, int j) noexcept nogil:
    """Largest first derivative of one axis or joint."""
    cdef double rate = fmax(fabs(span.dq0[j]), fabs(span.dq1[j])), change = span.ddq1[j] - span.ddq0[j]
    if span.ddq0[j] * span.ddq1[j] < 0.0:
        rate = fmax(rate, fabs(span.dq0[j] - 0.5 * span.h * span.ddq0[j] * span.ddq0[j] / change))
    return rate


cdef void limit_cubic(const TpState* tp, Span* span) noexcept nogil:
    """Largest speed, acceleration and jerk along a span whose derivatives, cap and acc are known."""
    cdef double w = span.cap, v, a, jerk, rate, bend, twist, left
    cdef int j, i
    v = INFINITY
    for j in range(span.n):
        i = span.axis[j]
        bend = fmax(fabs(span.ddq0[j]), fabs(span.ddq1[j]))
        twist = fabs(span.ddq1[j] - span.ddq0[j]) / span.h
        rate = _rate(span, j)
        if rate * v > tp.vmax[i]:
            v = tp.vmax[i] / rate
            span.cap = fmin(span.cap, v * v)
        if bend > 0.0:
            w = fmin(w, BEND_SHARE * tp.amax[i] * span.tight / bend)
        if twist * v * v * v > TWIST_SHARE * tp.jmax[i]:
            v = cbrt(TWIST_SHARE * tp.jmax[i] / twist)
    v = fmin(v, sqrt(w))
    a = span.acc
    for j in range(span.n):
        i = span.axis[j]
        bend = fmax(fabs(span.ddq0[j]), fabs(span.ddq1[j]))
        twist = (span.ddq1[j] - span.ddq0[j]) / span.h
        rate = _rate(span, j)
        if rate > 0.0:
            a = fmin(a, fmax(LEAST_SHARE * tp.amax[i], tp.amax[i] * span.tight - bend * v * v) / rate)
        if bend > 0.0:
            a = fmin(a, TURN_SHARE * fmax(LEAST_SHARE * tp.jmax[i], tp.jmax[i] - fabs(twist) * v * v * v) / (3.0 * bend * v))
    jerk = INFINITY
    for j in range(span.n):
        i = span.axis[j]
        bend = fmax(fabs(span.ddq0[j]), fabs(span.ddq1[j]))
        twist = (span.ddq1[j] - span.ddq0[j]) / span.h
        rate = _rate(span, j)
        if rate > 0.0:
            left = tp.jmax[i] - fabs(twist) * v * v * v - 3.0 * bend * v * a
            jerk = fmin(jerk, fmax(LEAST_SHARE * tp.jmax[i], left) / rate)
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
