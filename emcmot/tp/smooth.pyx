"""The path where jerk is limited: lays cubic spans of queued moves, from one stop to the next.

Moves between two stops are a *chain*. Its corners become kinks (see kink) as wide as the tolerance, the room and the programmed
speed allow; arcs, and runs of short moves, become polylines whose kinks have the hats of a cubic spline (see arcs, fit).
The path is laid up to where the next corner may begin; the end of the queue stays open until the machine
would have to slow down for want of path, because what is laid to its end is a stop.
Called by advance; jerk moves the machine along the spans.
"""

from libc.math cimport INFINITY, fmax, fmin, sqrt
from libc.stdint cimport int64_t
from libc.string cimport memcpy, memset

from emcmot.tp.arcs cimport arc_laid_out, end_spacing, open_arc, spline_arc
from emcmot.tp.corner cimport TANGENT, corner_ratio, corner_tolerance, must_stop
from emcmot.tp.cubic cimport corner_speed, first_speed, half_for_speed, limit_cubic
from emcmot.tp.fit cimport begin_run, close_run, fit_next, run_ahead, run_begins, run_goes_on
from emcmot.tp.geometry cimport derivatives, length
from emcmot.tp.interior cimport forget_plan
from emcmot.tp.joints cimport Curve, add_joints
from emcmot.tp.kink cimport SIDE_BEFORE, SIDE_BEHIND, add_kink, forget_passed, hat_off, next_node, path_at
from emcmot.tp.kink cimport reach_back, size_corner, taken
from emcmot.tp.merge cimport take_segment
from emcmot.tp.model cimport AXES, BACK_RING, END_CORNER, END_OPEN, END_STOP, KINKS, SPAN_CUBIC, SPAN_LINE
from emcmot.tp.model cimport Kink, Segment, Span, TpState
from emcmot.tp.pieces cimport piece, turn
from emcmot.tp.spans cimport keep_derivatives, limit_speed, new_span
from emcmot.tp.tp cimport TP_ARC, TP_TAP, TP_TERM_BLEND

cdef enum:
    STEPS_PER_PERIOD = 96
    KINKS_IN_WORK = 16           # room that a step needs in their ring
    SPANS_IN_WORK = 16
    SEGMENTS_BEHIND = 64         # the machine, at which a run may still look
    NEIGHBOURS = 8               # corners on each side that a hat may reach, and that are known when it is made
    SHORTENINGS = 10
    FITTINGS = 24

cdef double EXACT_ROUNDING = 1e-3    # lu; what exact path mode gives to the ends of arcs
cdef double SPEED_RESERVE = 1.2      # corners are made for the programmed speed times this,
cdef double WIDER = 2.0              # this much wider,
cdef double SLIGHTLY_WIDER = 8.0     # and slight ones even more: they are as many as a curve has moves
cdef double SLIGHT = 0.1
cdef double FAIR_SHARE = 0.9        # of the tolerance that corners plan with; their neighbours need not be as wide
cdef double LEAST_HAT = 0.01         # of the shorter move
cdef double MUCH_LESS = 0.5          # tolerance of another corner, which this one does not reach
cdef double LAST_HOLD = 2e-3         # lu or degrees; an open end as near as this becomes a stop
cdef double SAME_PLACE = 1e-9        # of the way
cdef double MOST_TURN = 0.25           # of one span
cdef double JOINT_MISS = 0.02        # of a joint's acceleration that a span may miss


cdef inline Segment* _seg(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.segs[index & tp.seg_mask]


cdef inline double _way(const Segment* seg) noexcept nogil:
    """Length of a segment along its chain."""
    return seg.length / seg.pace


cdef void choose_smoothing(TpState* tp) noexcept nogil:
    """Decide, at rest with an empty queue, whether jerk is limited."""
    cdef double jerk = INFINITY
    cdef int i
    for i in range(AXES + tp.joints):
        jerk = fmin(jerk, tp.jmax[i])
    tp.smooth = tp.limit_jerk and jerk < INFINITY
    tp.body_end = tp.body_goal = 0.0
    forget_chain(tp)
    tp.hungry = 1
    forget_plan(tp)


cdef void forget_chain(TpState* tp) noexcept nogil:
    """Nothing of what was laid goes on."""
    tp.end = END_STOP
    tp.arc_open = tp.fitting = 0
    tp.kink_head = tp.kink_tail = 0


cdef void extend_smoothly(TpState* tp) noexcept nogil:
    """Lay the path ahead, as far as rings and this period's share of work allow."""
    cdef int step, urgent = tp.hungry, more = 1
    for step in range(STEPS_PER_PERIOD):
        if tp.span_tail - tp.active + SPANS_IN_WORK + BACK_RING >= tp.span_mask:
            return
        if tp.seg_tail - tp.seg_head + NEIGHBOURS + SEGMENTS_BEHIND >= tp.seg_mask:
            return
        if more and tp.seg_tail - tp.seg_built < NEIGHBOURS:
            more = take_segment(tp, urgent and tp.seg_built == tp.seg_tail)
        if tp.end == END_OPEN and tp.kink_tail - tp.kink_head + KINKS_IN_WORK < KINKS:
            _decide_end(tp, &urgent)
        if _lay(tp):
            continue
        if tp.kink_tail - tp.kink_head + KINKS_IN_WORK < KINKS and (tp.fitting and fit_next(tp) or tp.arc_open and spline_arc(tp)):
            continue
        if tp.end == END_OPEN or tp.arc_open or (tp.fitting and tp.fit_closed):
            return
        if tp.end == END_CORNER:
            _go_round(tp)
        elif tp.body_end < tp.body_goal or tp.seg_built == tp.seg_tail:
            return
        else:
            _begin_chain(tp)


# --- chains -----------------------------------------------------------------------------------------------------------

cdef void _begin_chain(TpState* tp) noexcept nogil:
    """Go on behind a stop."""
    cdef Segment* seg = _seg(tp, tp.seg_built)
    seg.begin = 0.0
    seg.pace = 1.0
    tp.kink_head = tp.kink_tail = 0
    tp.body_end = tp.arc_ended = 0.0
    tp.laying = tp.seg_built
    tp.arc_start = 0.0
    memset(&tp.corner, 0, sizeof(Kink))
    if seg.kind != TP_ARC:
        memcpy(tp.corner.vertex, seg.start, sizeof(tp.corner.vertex))
        memcpy(tp.corner.out, seg.rate, sizeof(tp.corner.out))
        add_kink(tp, &tp.corner)
    _join(tp, seg)


cdef void _go_round(TpState* tp) noexcept nogil:
    """Go on behind the corner that is decided."""
    if not tp.fitting:
        add_kink(tp, &tp.corner)
    _join(tp, _seg(tp, tp.seg_built))


cdef void _join(TpState* tp, Segment* seg) noexcept nogil:
    """Let a segment be the last of the chain; its begin and pace are known."""
    cdef double half = tp.corner.to - tp.corner.place
    tp.seg_built += 1
    tp.body_goal = seg.begin + _way(seg)
    tp.end = END_OPEN
    tp.hold = fmax(0.5 * _way(seg), 2.0 * half)
    if seg.kind == TP_ARC:
        open_arc(tp, seg, half)


# --- corners ----------------------------------------------------------------------------------------------------------

cdef void _decide_end(TpState* tp, int* urgent) noexcept nogil:
    """Decide how the last segment of the chain ends, when that is known, or cannot wait."""
    cdef const Segment* a = _seg(tp, tp.seg_built - 1)
    cdef double sharpness, tolerance
    cdef int parts
    if tp.seg_built == tp.seg_tail:
        if urgent[0] and tp.raw_next == tp.raw_tail and _laid_out(tp):
            tp.hold *= 0.5 if tp.w > 0.0 else 0.1
            urgent[0] = 0
            if tp.hold < LAST_HOLD or tp.arc_open or tp.fitting:
                _stop(tp)
        return
    if must_stop(a, _seg(tp, tp.seg_built)):
        _stop(tp)
        return
    if tp.seg_tail - tp.seg_built < NEIGHBOURS and not urgent[0]:
        return
    _aim(tp, a, _seg(tp, tp.seg_built))
    if tp.fitting and run_goes_on(tp) or not tp.fitting and run_begins(tp):
        if not tp.fitting:
            begin_run(tp)
        tp.end = END_CORNER
        return
    sharpness = tp.corner.sharpness
    tolerance = corner_tolerance(a, _seg(tp, tp.seg_built), sharpness)
    if sharpness > TANGENT and tolerance == 0.0:
        _stop(tp)
        return
    if tp.fitting:
        close_run(tp)
    if a.term != TP_TERM_BLEND and sharpness <= TANGENT:
        tolerance = EXACT_ROUNDING
    parts = (a.kind == TP_ARC) + (_seg(tp, tp.seg_built).kind == TP_ARC) + (sharpness > TANGENT)
    tp.arc_end = end_spacing(tp, a, a.length, tolerance / parts) if a.kind == TP_ARC else 0.0
    tp.arc_start = end_spacing(tp, _seg(tp, tp.seg_built), 0.0, tolerance / parts) if _seg(tp, tp.seg_built).kind == TP_ARC else 0.0
    if sharpness <= TANGENT or _round(tp, a, _seg(tp, tp.seg_built), tolerance / parts) or _committed(tp):
        tp.end = END_CORNER
    else:
        _stop(tp)


cdef int _committed(TpState* tp) noexcept nogil:
    """Whether corners before bend the path here already, so that it cannot end: then this one is passed, however slowly."""
    cdef double least = LEAST_HAT * fmin(_way(_seg(tp, tp.seg_built - 1)), _way(_seg(tp, tp.seg_built)))
    cdef int64_t k
    for k in range(tp.kink_head, tp.kink_tail):
        if tp.kinks[k % KINKS].to > tp.body_goal + SAME_PLACE:
            if tp.corner.to < tp.corner.place + least:
                tp.corner.start = tp.corner.place - least
                tp.corner.to = tp.corner.place + least
            return 1
    return 0


cdef int _laid_out(const TpState* tp) noexcept nogil:
    """Whether no more can be laid before the end is decided."""
    if tp.arc_open:
        return arc_laid_out(tp)
    if tp.fitting:
        return 1
    return tp.body_end > tp.body_goal - tp.hold - SAME_PLACE


cdef void _stop(TpState* tp) noexcept nogil:
    tp.end = END_STOP
    tp.arc_end = 0.0
    if tp.fitting and not tp.fit_closed:
        close_run(tp)


cdef void _aim(TpState* tp, const Segment* a, Segment* b) noexcept nogil:
    """Fill in the corner between two segments, but for its hat; and where and how fast the later one runs."""
    cdef Kink* corner = &tp.corner
    cdef double t1[AXES]
    cdef double t2[AXES]
    cdef double unused[AXES]
    cdef int i
    derivatives(a, a.length, t1, unused)
    derivatives(b, 0.0, t2, unused)
    b.begin = tp.body_goal
    b.pace = a.pace * corner_ratio(a, b, t1, t2)
    for i in range(AXES):
        corner.out[i] = b.pace * t2[i]
        corner.turn[i] = corner.out[i] - a.pace * t1[i]
        corner.vertex[i] = b.start[i]
    corner.place = corner.start = corner.middle = corner.to = tp.body_goal
    corner.sharpness = length(corner.turn)
    if corner.sharpness <= TANGENT:
        memset(corner.turn, 0, sizeof(corner.turn))
        corner.sharpness = 0.0


cdef int _round(TpState* tp, const Segment* a, const Segment* b, double tolerance) noexcept nogil:
    """Give the corner its hat; 0 where it is passed more slowly than after a stop."""
    cdef Kink* corner = &tp.corner
    cdef double before[AXES]
    cdef double speed = SPEED_RESERVE * fmin(fmin(a.vel, a.vel_max) / a.pace, fmin(b.vel, b.vel_max) / b.pace)
    cdef double widest = half_for_speed(tp, corner.turn, speed)
    cdef int i
    widest *= SLIGHTLY_WIDER if corner.sharpness < SLIGHT else WIDER
    if tolerance == INFINITY:
        widest = fmin(widest, 0.5 * fmin(_way(a), _way(b)))
    if a.kind == TP_ARC:
        widest = fmin(widest, _way(a))
    if b.kind == TP_ARC:
        widest = fmin(widest, _way(b))
    elif run_ahead(tp, tp.seg_built + 1):
        widest = fmin(widest, 0.5 * _way(b))
    widest = fmin(widest, fmin(corner.place - tp.arc_ended, corner.place - tp.body_end))
    widest = _fair(tp, a, b, tolerance, widest)
    size_corner(tp, corner, tolerance, widest)
    for i in range(AXES):
        before[i] = corner.out[i] - corner.turn[i]
    return corner.to > corner.place and corner_speed(tp, corner.turn, corner.to - corner.place) >= fmax(
        first_speed(tp, before), first_speed(tp, corner.out)
    )


cdef double _fair(TpState* tp, const Segment* a, const Segment* b, double tolerance, double widest) noexcept nogil:
    """Half-width with which this corner and its neighbours, were they as wide, would keep the tolerance."""
    cdef double turn[NEIGHBOURS][AXES]
    cdef double away[NEIGHBOURS]
    cdef double off[AXES]
    cdef double distance = 0.0, half, used, sharpness, allowed
    cdef const Segment* seg = b
    cdef const Segment* following
    cdef int64_t index = tp.seg_built
    cdef int n = 0, k, i
    while b.kind != TP_ARC and n < NEIGHBOURS:              # the corners that follow
        distance += seg.length / b.pace
        index += 1
        if index >= tp.seg_tail:
            break
        following = _seg(tp, index)
        if must_stop(seg, following) or seg.unit != following.unit or following.kind == TP_ARC:
            break
        sharpness = 0.0
        for i in range(AXES):
            sharpness += (following.rate[i] - seg.rate[i]) ** 2
        allowed = corner_tolerance(seg, following, sqrt(sharpness))
        if allowed < MUCH_LESS * tolerance:
            break
        tolerance = fmin(tolerance, allowed)
        away[n] = distance
        for i in range(AXES):
            turn[n][i] = b.pace * (following.rate[i] - seg.rate[i])
        n += 1
        seg = following
    if b.kind != TP_ARC:
        widest = fmin(widest, distance)
    half = fmin(widest, reach_back(tp, NEIGHBOURS))
    for k in range(FITTINGS):
        taken(tp, tp.corner.place, off)
        for i in range(AXES):
            off[i] += hat_off(tp.corner.turn[i], half, 0.0)
        for index in range(n):
            for i in range(AXES):
                off[i] += hat_off(turn[index][i], half, away[index])
        used = length(off)
        if used <= FAIR_SHARE * tolerance:
            break
        half *= fmax(0.5, 0.99 * sqrt(FAIR_SHARE * tolerance / used))
    return half


# --- spans ------------------------------------------------------------------------------------------------------------

cdef double _safe(const TpState* tp) noexcept nogil:
    """Way up to which no kink can come any more."""
    cdef double limit = tp.body_goal
    if tp.end == END_OPEN:
        limit -= tp.hold
    elif tp.end == END_CORNER:
        limit = fmin(tp.corner.start, limit - 2.0 * tp.arc_start)
    if tp.arc_open or tp.fitting:
        limit = fmin(limit, tp.knots[1])
    return limit


cdef int _alike(const Segment* a, const Segment* b) noexcept nogil:
    """Whether a span may be of both segments: the same feed, and what acts on it."""
    return (
        a.vel == b.vel and a.vel_max == b.vel_max and a.acc == b.acc and a.enables == b.enables and a.unit == b.unit
        and a.motion_type == b.motion_type and a.spindle == b.spindle and a.sync_revs == b.sync_revs
    )


cdef int _lay(TpState* tp) noexcept nogil:
    """Lay the next span; 0 where there is none to lay."""
    cdef double begin = tp.body_end, end, limit = _safe(tp)
    cdef const Segment* seg
    cdef int64_t k
    if tp.seg_built <= tp.seg_head or tp.kink_tail == tp.kink_head or limit <= begin + SAME_PLACE:
        return 0
    while tp.laying + 1 < tp.seg_built and _seg(tp, tp.laying + 1).begin <= begin + SAME_PLACE:
        tp.laying += 1
    seg = _seg(tp, tp.laying)
    end = next_node(tp, limit)
    k = tp.laying + 1
    while k < tp.seg_built and _seg(tp, k).begin < end - SAME_PLACE:
        if not _alike(seg, _seg(tp, k)):
            end = _seg(tp, k).begin
        k += 1
    if begin == 0.0:
        path_at(tp, 0.0, SIDE_BEHIND, tp.node[0], tp.node[1], tp.node[2])
        memcpy(tp.node[0], seg.start, sizeof(tp.node[0]))
        tp.slow_place = tp.slow_speed = 0.0
    if seg.kind != TP_TAP:
        end = begin + piece(tp, seg, begin, end - begin)
    if tp.end == END_STOP and end > tp.body_goal - SAME_PLACE:
        end = tp.body_goal
    _add_span(tp, seg, begin, end)
    forget_passed(tp)
    return 1


cdef void _add_span(TpState* tp, const Segment* seg, double begin, double end) noexcept nogil:
    """Lay the path from one place to another, or less of it where it, or a joint, bends too much."""
    cdef double q[3][AXES]
    cdef Span* span = new_span(
        tp, SPAN_LINE if seg.kind == TP_TAP else SPAN_CUBIC, tp.laying, begin, end - begin)
    cdef Curve curve
    cdef double shorter
    cdef int step
    if seg.acc > 0.0:
        span.acc = seg.acc / seg.pace
    curve.cubic = span
    curve.before = NULL
    curve.seg = seg
    for step in range(SHORTENINGS):
        path_at(tp, end, SIDE_BEFORE, q[0], q[1], q[2])
        if tp.end == END_STOP and end == tp.body_goal:
            memcpy(q[0], _seg(tp, tp.seg_built - 1).end, sizeof(q[0]))
            span.stop = 1
        memcpy(span.q0, tp.node[0], sizeof(span.q0))
        memcpy(span.q1, q[0], sizeof(span.q1))
        span.tight = 1.0
        limit_speed(tp, span, tp.node[1], q[1], INFINITY, seg.unit)
        keep_derivatives(span, tp.node[1], q[1], tp.node[2], q[2])
        curve.length = span.h
        if tp.inverse != NULL:
            add_joints(tp, &curve, span)
        shorter = fmin(1.0, MOST_TURN / turn(span))
        if span.tight < 1.0 - JOINT_MISS:
            shorter = fmin(shorter, 0.5)
        if shorter == 1.0 or step + 1 == SHORTENINGS:
            break
        end = begin + shorter * (end - begin)
        span.h = end - begin
        span.stop = 0
    limit_cubic(tp, span)
    if span.steady * span.steady < tp.slow_speed * tp.slow_speed + span.push * (end - tp.slow_place):
        tp.slow_speed = span.steady
        tp.slow_place = end
    memcpy(tp.node, q, sizeof(q))
    tp.body_end = end
