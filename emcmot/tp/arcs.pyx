"""Arcs as cubic splines, where jerk is limited.

Knots are close together about an end, because there the curvature must come and go within the tolerance, and grow apart
between; a chain that begins or ends on an arc, at rest, needs none of that. The spline is exact for parabolas.
Called by smooth.
"""

from libc.math cimport fabs, fmax, fmin, sqrt
from libc.stdint cimport int64_t

from emcmot.tp.geometry cimport derivatives, position
from emcmot.tp.kink cimport add_kink
from emcmot.tp.model cimport AXES, END_OPEN, KNOTS, Kink, Segment, TpState

cdef double END_MISS = 0.045         # an arc's end is off by this times curvature * spacing^2
cdef double END_TWIST = 0.6          # and the third derivative there is this times curvature / spacing
cdef double STEP = 0.1               # rad; spacing of knots
cdef double OPEN_STEPS = 4.0         # of knots before the end of an arc, where that is open
cdef double GROWTH = 2.0             # of one spacing to the next
cdef double SPEED_RESERVE = 1.2      # ends are made for the programmed speed times this,
cdef double WIDER = 2.0              # this much wider
cdef double SAME_PLACE = 1e-9        # of the way


cdef inline Segment* _seg(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.segs[index & tp.seg_mask]


cdef inline double _way(const Segment* seg) noexcept nogil:
    """Length of a segment along its chain."""
    return seg.length / seg.pace


cdef void open_arc(TpState* tp, const Segment* arc, double half) noexcept nogil:
    """Begin the spline of an arc that the chain ends with. `half`: of the corner before it."""
    cdef int k
    tp.arc_open = 1
    tp.arc_step = fmin(STEP / fabs(arc.omega * arc.pace), 0.25 * _way(arc))
    tp.hold = fmin(tp.hold, fmax(2.0 * half, OPEN_STEPS * tp.arc_step))
    for k in range(KNOTS - 1):
        tp.knots[k] = arc.begin + (k - KNOTS + 2) * tp.arc_start
    tp.knots[KNOTS - 1] = arc.begin + fmin(tp.arc_step, tp.arc_start if tp.arc_start > 0.0 else tp.arc_step)


cdef int arc_laid_out(const TpState* tp) noexcept nogil:
    """Whether no more knots can be set before the end of the arc is decided."""
    return tp.body_goal - tp.knots[KNOTS - 1] < OPEN_STEPS * tp.arc_step


cdef double end_spacing(const TpState* tp, const Segment* arc, double u, double tolerance) noexcept nogil:
    """Spacing of the knots about an end of an arc."""
    cdef double dq[AXES]
    cdef double ddq[AXES]
    cdef double curvature = 0.0, speed, spacing = 0.0
    cdef int i
    derivatives(arc, u, dq, ddq)
    speed = SPEED_RESERVE * fmin(arc.vel, arc.vel_max)
    for i in range(AXES):
        curvature += ddq[i] * ddq[i]
        spacing = fmax(spacing, END_TWIST * fabs(ddq[i]) * speed * speed * speed / tp.jmax[i])
    spacing = fmin(WIDER * spacing / arc.pace, 0.25 * _way(arc))
    spacing = fmin(spacing, 0.25 * _way(_seg(tp, tp.seg_built - (u == 0.0))))
    if u > 0.0:
        spacing = fmin(spacing, 0.25 * _seg(tp, tp.seg_built).length / _seg(tp, tp.seg_built).pace)
    else:
        spacing = fmin(spacing, 0.5 * (tp.body_goal - tp.body_end))
    return fmin(spacing, sqrt(tolerance / (END_MISS * sqrt(curvature))) / arc.pace)


cdef void _arc_point(const TpState* tp, const Segment* arc, const double* knots, double* q) noexcept nogil:
    """Control point of a cubic spline for three knots: exact for parabolas, along the arc and its tangents beyond."""
    cdef double dq[AXES]
    cdef double ddq[AXES]
    cdef double place = (knots[0] + knots[1] + knots[2]) / 3.0
    cdef double spread = (
        (knots[1] - knots[0]) ** 2 + (knots[2] - knots[1]) ** 2 + (knots[2] - knots[0]) ** 2) / 18.0
    cdef double u = (place - arc.begin) * arc.pace, least = SAME_PLACE * arc.length, weight = 1.0
    cdef int i
    if u < least:
        weight = 0.5 if u > -least else 0.0
    elif u > arc.length - least:
        weight = 0.5 if u < arc.length + least else 0.0
    weight *= -0.5 * spread * arc.pace * arc.pace
    derivatives(arc, fmax(0.0, fmin(arc.length, u)), dq, ddq)
    position(arc, fmax(0.0, u), q)
    for i in range(AXES):
        q[i] += weight * ddq[i]
        if u < 0.0:
            q[i] += u * dq[i]
        elif u > arc.length:
            q[i] += (u - arc.length) * dq[i]


cdef int spline_arc(TpState* tp) noexcept nogil:
    """Add the next kink of the open arc; 0 where that must wait for the decision on its end."""
    cdef const Segment* arc = _seg(tp, tp.seg_built - 1)
    cdef const double* k = tp.knots
    cdef double before[AXES]
    cdef double behind[AXES]
    cdef double unused[AXES]
    cdef double length, next_length, end = tp.body_goal
    cdef Kink kink
    cdef int i, done
    if tp.end == END_OPEN and arc_laid_out(tp):
        return 0
    kink.sharpness = 0.0
    kink.start, kink.middle, kink.to = k[1], k[2], k[3]
    kink.place = (k[1] + k[2] + k[3]) / 3.0
    done = k[2] >= end - SAME_PLACE and (tp.arc_end == 0.0 or k[1] >= end - SAME_PLACE)
    _arc_point(tp, arc, k, before)
    _arc_point(tp, arc, k + 1, kink.vertex)
    _arc_point(tp, arc, k + 2, behind)
    length = (k[3] - k[0]) / 3.0
    next_length = (k[4] - k[1]) / 3.0
    if done and tp.arc_end > 0.0:
        derivatives(arc, arc.length, kink.out, unused)
        for i in range(AXES):
            kink.out[i] *= arc.pace
    else:
        for i in range(AXES):
            kink.out[i] = (behind[i] - kink.vertex[i]) / next_length
    for i in range(AXES):
        kink.turn[i] = kink.out[i] - (kink.vertex[i] - before[i]) / length if length > 0.0 else 0.0
    add_kink(tp, &kink)
    if done:
        tp.arc_open = 0
        tp.arc_ended = end
        return 1
    for i in range(KNOTS - 1):
        tp.knots[i] = tp.knots[i + 1]
    tp.knots[KNOTS - 1] = _next_knot(tp, end)
    return 1


cdef double _next_knot(const TpState* tp, double end) noexcept nogil:
    """Knots grow apart from the start of an arc on, and come together towards its end."""
    cdef double last = tp.knots[KNOTS - 2], left = end - last
    cdef double step = fmin(GROWTH * (last - tp.knots[KNOTS - 3]), tp.arc_step)
    if left <= SAME_PLACE:
        return last + tp.arc_end if tp.arc_end > 0.0 else end
    if step <= 0.0:
        step = tp.arc_step
    if tp.end != END_OPEN and tp.arc_end > 0.0:
        step = fmin(step, fmax(tp.arc_end, 0.5 * (left + tp.arc_end)))
    return end if left < 1.5 * step else last + step
