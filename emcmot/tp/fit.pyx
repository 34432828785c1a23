"""A spline through runs of short moves, where jerk is limited: as wide apart as the tolerance allows.

Short moves stand for a curve. Were each of their corners rounded by itself, the path would bend as often as there are moves; so a
*run* of them is laid as one cubic spline: hats between knots (see kink), whose control points are those that a parabola through
three places of the moves has [de Boor, Fix, Spline approximation by quasiinterpolants, 1973]. Such a spline does not fall short of the curve
on its inner side, as averages do. Knots begin close together on the first move, grow apart until the path would leave the
tolerance, and come together on the last move: outside of a run the path is straight there.

Each knot is tried with the two that would follow it at the same distance; the path between the last knots is compared with the moves,
at their ends and middles. Called by smooth.
"""

from libc.math cimport fmax, fmin
from libc.stdint cimport int64_t

from emcmot.tp.corner cimport corner_tolerance, must_stop
from emcmot.tp.geometry cimport length
from emcmot.tp.kink cimport add_kink
from emcmot.tp.model cimport AXES, END_STOP, KINKS, KNOTS, Kink, Segment, TpState
from emcmot.tp.tp cimport TP_LINE, TP_TERM_BLEND

cdef enum:
    LEAST_RUN = 4                # corners with which a run begins
    MOVES_APART = 24             # at most, between two knots
    TRIED = 3                    # intervals that a new knot is tried on; as many knots are supposed as that needs
    NARROWINGS = 24

cdef double SHARPEST = 0.3           # rad; corner of a run
cdef double HAT = 6.0                # tolerances by which a hat is wide that takes all of one, at a corner of 1 rad
cdef double SHORT = 0.05             # s that a move of a run takes at most
cdef double APART = 0.02             # s between knots, at most
cdef double GROWTH = 2.0             # of one spacing to the next
cdef double NARROWER = 0.7
cdef double STARTS = 0.25            # of the way before the first corner: spacing of the first knots,
cdef double ENDS = 0.3               # and of that behind the last one
cdef double FREE = 0.3               # of the first move must not be in another hat
cdef double SPEED_RESERVE = 1.2
cdef double[3] SHARES = [1.0, 0.9, 0.8]      # of the tolerance, on intervals that what follows changes less and more
cdef double SAME_PLACE = 1e-9        # of the way


cdef inline Segment* _seg(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.segs[index & tp.seg_mask]


cdef inline double _way(const Segment* seg) noexcept nogil:
    return seg.length / seg.pace


# --- which moves are a run --------------------------------------------------------------------------------------------

cdef int _crowded(const Segment* a, const Segment* b) noexcept nogil:
    """Whether two moves are of one curve: short ones, which their corner would fill, were it rounded by itself."""
    cdef double turn[AXES]
    cdef double sharpness, tolerance, shorter = fmin(a.length, b.length)
    cdef int i
    if a.kind != TP_LINE or b.kind != TP_LINE or must_stop(a, b) or a.unit != b.unit:
        return 0
    if a.term != TP_TERM_BLEND or b.term != TP_TERM_BLEND or a.tolerance <= 0.0 or b.tolerance <= 0.0:
        return 0
    for i in range(AXES):
        turn[i] = b.rate[i] - a.rate[i]
    sharpness = length(turn)
    tolerance = corner_tolerance(a, b, sharpness)
    return sharpness <= SHARPEST and HAT * tolerance > 0.5 * sharpness * shorter and shorter < SHORT * fmin(a.vel, b.vel)


cdef int run_goes_on(const TpState* tp) noexcept nogil:
    """Whether the corner at the end of the chain belongs to the run."""
    return _crowded(_seg(tp, tp.seg_built - 1), _seg(tp, tp.seg_built))


cdef int run_ahead(const TpState* tp, int64_t index) noexcept nogil:
    """Whether a run may begin with the corner before segment `index`: as far as is known."""
    cdef int64_t k
    for k in range(index, min(index + LEAST_RUN, tp.seg_tail)):
        if not _crowded(_seg(tp, k - 1), _seg(tp, k)):
            return 0
    return index < tp.seg_tail


cdef int run_begins(const TpState* tp) noexcept nogil:
    """Whether the corner at the end of the chain is the first of a run."""
    cdef double free = tp.body_goal - _free_from(tp)
    return free >= FREE * _way(_seg(tp, tp.seg_built - 1)) and run_ahead(tp, tp.seg_built)


cdef double _free_from(const TpState* tp) noexcept nogil:
    """Place from which on the last move of the chain is laid straight."""
    cdef double place = fmax(tp.body_end, fmax(tp.arc_ended, _seg(tp, tp.seg_built - 1).begin))
    return fmax(place, tp.kinks[(tp.kink_tail - 1) % KINKS].to)


cdef void begin_run(TpState* tp) noexcept nogil:
    """Set the first knots, on the last move of the chain."""
    cdef const Segment* seg = _seg(tp, tp.seg_built - 1)
    cdef double step, place = _free_from(tp)
    cdef Kink kink
    cdef int i
    step = fmin(STARTS * (tp.body_goal - place), _widest(seg))
    place = tp.body_goal - step / STARTS
    tp.fitting = 1
    tp.fit_closed = 0
    tp.fit_first = tp.fit_near = tp.seg_built - 1
    tp.fit_from = place
    for i in range(KNOTS):
        tp.knots[i] = place + (i - 2) * step
    kink.place = kink.middle = place
    kink.start = place - step
    kink.to = place + step
    kink.sharpness = 0.0
    for i in range(AXES):
        kink.turn[i] = 0.0
        kink.out[i] = seg.rate[i] * seg.pace
    _moves_at(tp, place, kink.vertex)
    add_kink(tp, &kink)


cdef void close_run(TpState* tp) noexcept nogil:
    """The last move of the chain is the last of the run: half of it, or all before a stop, is straight."""
    cdef const Segment* last = _seg(tp, tp.seg_built - 1)
    tp.fit_closed = 1
    tp.arc_ended = last.begin + (1.0 if tp.end == END_STOP else 0.5) * _way(last)


# --- knots ------------------------------------------------------------------------------------------------------------

cdef double _widest(const Segment* seg) noexcept nogil:
    return APART * SPEED_RESERVE * fmin(seg.vel, seg.vel_max) / seg.pace


cdef void _moves_at(const TpState* tp, double place, double* q) noexcept nogil:
    """Position on the moves of the run; beyond them, on their first and last lines."""
    cdef int64_t k = tp.fit_near
    cdef const Segment* seg
    cdef int i
    while k + 1 < tp.seg_built and _seg(tp, k + 1).begin <= place:
        k += 1
    while k > tp.fit_first and _seg(tp, k).begin > place:
        k -= 1
    seg = _seg(tp, k)
    for i in range(AXES):
        q[i] = seg.start[i] + seg.rate[i] * seg.pace * (place - seg.begin)


cdef void _control(const TpState* tp, const double* k, double* q) noexcept nogil:
    """Control point for three knots."""
    cdef double before[AXES]
    cdef double behind[AXES]
    cdef double place = (k[0] + k[1] + k[2]) / 3.0, reach = 0.5 * (k[2] - k[0])
    cdef double weight = ((k[1] - k[0]) ** 2 + (k[2] - k[1]) ** 2 + (k[2] - k[0]) ** 2) / (36.0 * reach * reach)
    cdef int i
    _moves_at(tp, place, q)
    _moves_at(tp, place - reach, before)
    _moves_at(tp, place + reach, behind)
    for i in range(AXES):
        q[i] -= weight * (before[i] - 2.0 * q[i] + behind[i])


cdef int fit_next(TpState* tp) noexcept nogil:
    """Add the next knot of the run, and the kink that it completes; 0 where more of the moves must be known first.

    The closer the knots, the nearer is the path to the moves, so that one of the distances tried fits.
    """
    cdef const Segment* last = _seg(tp, tp.seg_built - 1)
    cdef double knot = tp.knots[KNOTS - 1], left = last.begin - knot, step, end
    cdef int64_t k
    cdef int i
    while tp.fit_near + 1 < tp.seg_built and _seg(tp, tp.fit_near + 1).begin <= tp.knots[0]:
        tp.fit_near += 1
    k = tp.fit_near
    while k + 1 < tp.seg_built and _seg(tp, k + 1).begin <= knot:
        k += 1
    step = fmin(_widest(_seg(tp, k)), GROWTH * (knot - tp.knots[KNOTS - 2]))
    if k + MOVES_APART < tp.seg_built:
        step = fmin(step, _seg(tp, k + MOVES_APART).begin - knot)
    if tp.fit_closed:
        end = ENDS * (tp.arc_ended - last.begin)
        step = fmin(step, fmax(end, 0.5 * (left + end)))
    elif left < (TRIED + 1) * step:
        return 0
    for i in range(KNOTS - 1):
        tp.knots[i] = tp.knots[i + 1]
    for i in range(NARROWINGS):
        tp.knots[KNOTS - 1] = knot + step
        if _fits(tp):
            break
        step *= NARROWER
    _complete_kink(tp)
    if tp.fit_closed and tp.knots[0] >= last.begin:
        tp.fitting = 0
    return 1


cdef void _complete_kink(TpState* tp) noexcept nogil:
    """The kink between the middle three knots."""
    cdef const double* k = tp.knots
    cdef double before[AXES]
    cdef double behind[AXES]
    cdef const Segment* last = _seg(tp, tp.seg_built - 1)
    cdef Kink kink
    cdef int i
    kink.sharpness = 0.0
    kink.start, kink.middle, kink.to = k[1], k[2], k[3]
    kink.place = (k[1] + k[2] + k[3]) / 3.0
    _control(tp, k, before)
    _control(tp, k + 1, kink.vertex)
    _control(tp, k + 2, behind)
    for i in range(AXES):
        kink.out[i] = 3.0 * (behind[i] - kink.vertex[i]) / (k[4] - k[1])
        if tp.fit_closed and k[0] >= last.begin:
            kink.out[i] = last.rate[i] * last.pace
        kink.turn[i] = kink.out[i] - 3.0 * (kink.vertex[i] - before[i]) / (k[3] - k[0])
    add_kink(tp, &kink)


# --- tolerance --------------------------------------------------------------------------------------------------------

cdef int _fits(const TpState* tp) noexcept nogil:
    """Whether the path keeps the tolerance up to the newest knot, were the next ones as far apart."""
    cdef const Kink* kink = &tp.kinks[(tp.kink_tail - 1) % KINKS]
    cdef double k[KNOTS + 2]
    cdef double points[TRIED + 2][AXES]
    cdef double q[3][AXES]
    cdef double bend[AXES]
    cdef double into, h
    cdef int i, part
    for i in range(KNOTS):
        k[i] = tp.knots[i]
    k[KNOTS] = 2.0 * k[KNOTS - 1] - k[KNOTS - 2]
    k[KNOTS + 1] = 2.0 * k[KNOTS] - k[KNOTS - 1]
    for part in range(TRIED + 2):
        _control(tp, k + part, points[part])
    h = k[1] - kink.start                    # path at the second knot, where the last kink is highest
    for i in range(AXES):
        into = kink.out[i] - kink.turn[i]
        q[2][i] = 2.0 * kink.turn[i] / (kink.to - kink.start)
        q[1][i] = into + 0.5 * q[2][i] * h
        q[0][i] = kink.vertex[i] + into * (k[1] - kink.place) + q[2][i] * h * h / 6.0
    for part in range(TRIED):
        h = k[part + 2] - k[part + 1]
        for i in range(AXES):
            bend[i] = 3.0 * (points[part + 2][i] - points[part + 1][i]) / (k[part + 4] - k[part + 1])
            bend[i] -= 3.0 * (points[part + 1][i] - points[part][i]) / (k[part + 3] - k[part])
            bend[i] *= 2.0 / (k[part + 3] - k[part + 1])
        if not _near(tp, k[part + 1], h, q, bend, SHARES[part]):
            return 0
        for i in range(AXES):
            q[0][i] += h * (q[1][i] + h * (q[2][i] / 3.0 + bend[i] / 6.0))
            q[1][i] += 0.5 * h * (q[2][i] + bend[i])
            q[2][i] = bend[i]
    return 1


cdef int _near(
    const TpState* tp, double start, double h, const double (*q)[AXES], const double* bend, double share) noexcept nogil:
    """Whether a cubic stays near the moves: at both ends of what it passes of each, and in the middle.

    `q`: position and derivatives at its start; `bend`: second derivative at its end.
    """
    cdef int64_t k = tp.fit_near
    cdef double place = start, end, tolerance
    cdef const Segment* seg
    while k + 1 < tp.seg_built and _seg(tp, k + 1).begin <= start:
        k += 1
    while place < start + h - SAME_PLACE:
        seg = _seg(tp, k)
        end = start + h
        if k + 1 < tp.seg_built:
            end = fmin(end, _seg(tp, k + 1).begin)
        tolerance = share * (seg.tolerance - seg.deviation)
        if place >= tp.fit_from:
            if _off(seg, start, h, q, bend, place) > tolerance or _off(seg, start, h, q, bend, 0.5 * (place + end)) > tolerance:
                return 0
        if end > place and _off(seg, start, h, q, bend, end) > tolerance:
            return 0
        place = end
        k += 1
    return 1


cdef double _off(
    const Segment* seg, double start, double h, const double (*q)[AXES], const double* bend, double place) noexcept nogil:
    """Distance of a place on the cubic from the same place on a move."""
    cdef double off[AXES]
    cdef double x = place - start, line = place - seg.begin
    cdef int i
    for i in range(AXES):
        off[i] = q[0][i] + x * (q[1][i] + x * (0.5 * q[2][i] + x * (bend[i] - q[2][i]) / (6.0 * h)))
        off[i] -= seg.start[i] + seg.rate[i] * seg.pace * line
    return length(off)
