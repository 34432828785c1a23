"""Joints that are not axes, in the look-ahead: their limits as further rows of a span.

Along a curve q(u) the joints are a curve as well, theta(u) = inverse(q(u)). Its derivatives by u, by differences of the inverse
kinematics, limit du/dt just as those of the axes do; so a joint is used as fully as an axis, on any kinematics. Only their
change inside a span is not known: what linear interpolation misses in its middle is taken off the accelerations.
Called by path for every span that it builds.
"""

from libc.math cimport fabs, fmax, fmin

from emcmot.tp.corner cimport blend_position
from emcmot.tp.cubic cimport cubic_position
from emcmot.tp.geometry cimport position
from emcmot.tp.model cimport AXES, Span, TpState
from emcmot.tp.joint_map cimport TP_JOINTS

cdef double STEP = 1e-3              # u between the poses that a derivative is taken of
cdef double SHARE_OF_CURVE = 0.25    # the same on short curves
cdef double MISS_SPREAD = 1.3        # what a span misses at most, per what it misses in its middle
cdef double LEAST_SHARE = 0.2        # of an acceleration that a span uses, however much it misses

ctypedef struct Rates:               # derivatives of the joints by u
    double first[TP_JOINTS]
    double second[TP_JOINTS]


cdef inline int _joints(const TpState* tp, const Curve* curve, double u, double* out) noexcept nogil:
    cdef double pose[AXES]
    if curve.cubic != NULL:
        cubic_position(curve.cubic, u, pose)
    elif curve.before != NULL:
        blend_position(curve.before, curve.seg, curve.trim, u, pose)
    else:
        position(curve.seg, u, pose)
    return tp.inverse(tp.kins, out, pose)


cdef int _rates(const TpState* tp, const Curve* curve, double u, Rates* rates) noexcept nogil:
    """Derivatives at u; 0 where the kinematics has no solution. Next to an end of the curve the second is that of near by."""
    cdef double before[TP_JOINTS]
    cdef double here[TP_JOINTS]
    cdef double after[TP_JOINTS]
    cdef double step = fmin(STEP, SHARE_OF_CURVE * curve.length)
    cdef double at = fmax(step, fmin(curve.length - step, u))
    cdef int k
    for k in range(TP_JOINTS):
        before[k] = here[k] = after[k] = 0.0
    if _joints(tp, curve, at, here):
        return 0
    for k in range(TP_JOINTS):
        before[k] = after[k] = here[k]
    if _joints(tp, curve, at - step, before) or _joints(tp, curve, at + step, after):
        return 0
    for k in range(tp.joints):
        rates.second[k] = (after[k] - 2.0 * here[k] + before[k]) / (step * step)
        rates.first[k] = 0.5 * (after[k] - before[k]) / step + (u - at) * rates.second[k]
    return 1


cdef void _reach_ends(const TpState* tp, const Curve* curve, Rates* start, Rates* end) noexcept nogil:
    """Take the second derivatives from where they were found to the ends of the curve: third ones come from their difference."""
    cdef double step = fmin(STEP, SHARE_OF_CURVE * curve.length), more
    cdef int k
    for k in range(tp.joints):
        more = (end.second[k] - start.second[k]) * step / (curve.length - 2.0 * step)
        start.second[k] -= more
        end.second[k] += more


cdef void add_joints(const TpState* tp, const Curve* curve, Span* span) noexcept nogil:
    """Add the joints' rows to a span that has those of the axes; where there is no solution, motion says so when it is there."""
    cdef Rates start, middle, end
    cdef double miss = 0.0, rate, w, a = span.acc, limit
    cdef int k, n = span.n
    cdef double u0 = 0.0 if curve.cubic != NULL else span.u0
    if not _rates(tp, curve, u0, &start) or not _rates(tp, curve, u0 + 0.5 * span.h, &middle):
        return
    if not _rates(tp, curve, u0 + span.h, &end):
        return
    if curve.cubic != NULL:
        _reach_ends(tp, curve, &start, &end)
    for k in range(tp.joints):
        rate = fmax(fabs(start.first[k]), fmax(fabs(middle.first[k]), fabs(end.first[k])))
        if rate == 0.0:
            continue
        span.axis[n] = AXES + k
        span.dq0[n] = start.first[k]
        span.dq1[n] = end.first[k]
        span.ddq0[n] = start.second[k]
        span.ddq1[n] = end.second[k]
        n += 1
        span.cap = fmin(span.cap, (tp.vmax[AXES + k] / rate) ** 2)
        a = fmin(a, tp.amax[AXES + k] / rate)
    w = span.cap
    for k in range(tp.joints):
        rate = fmax(fabs(start.second[k]), fabs(end.second[k]))
        if rate > 0.0:
            w = fmin(w, tp.amax[AXES + k] / rate)
    for k in range(tp.joints):
        limit = tp.amax[AXES + k]
        miss = fmax(miss, a / limit * fabs(middle.first[k] - 0.5 * (start.first[k] + end.first[k])))
        miss = fmax(miss, w / limit * fabs(middle.second[k] - 0.5 * (start.second[k] + end.second[k])))
    span.n = n
    miss *= MISS_SPREAD
    miss = fmin(miss, 1.0 - LEAST_SHARE)
    span.tight = fmin(span.tight, 1.0 - miss)
    span.cap *= (1.0 - miss) * (1.0 - miss)
