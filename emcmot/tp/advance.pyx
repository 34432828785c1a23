"""Motion along the planned path, one servo period at a time.

A period is cut into phases of constant d2u/dt2. On lines, where the limits do not change with u, a phase ends where the
feed, or the way that braking takes, is reached. On curved spans the acceleration is the largest that the axes can hold to the
end of the span and that arrives there with no more than the span's exit limit; where an override, a hold or an abort
asks for less speed, it is the smallest. Both keep the state in the set from which every later limit can be kept.
"""

from libc.math cimport fabs, fmax, fmin, sqrt
from libc.stdint cimport int64_t

from emcmot.tp.corner cimport blend_position
from emcmot.tp.cubic cimport cubic_position
from emcmot.tp.follow cimport count_way
from emcmot.tp.geometry cimport position
from emcmot.tp.interior cimport forget_plan
from emcmot.tp.jerk cimport move_smoothly
from emcmot.tp.limits cimport acceleration_range, hardest_stop
from emcmot.tp.model cimport AXES, CHAIN_NONE, SPAN_BLEND, SPAN_CUBIC, SPAN_LINE, TAP_NONE, Segment, Span, TpState
from emcmot.tp.path cimport exit_limit, extend, look_ahead, sweep_caps
from emcmot.tp.progress cimport holding, next_span, reached, run_tap, target_w, waiting
from emcmot.tp.reverse cimport turn_forward
from emcmot.tp.smooth cimport extend_smoothly, forget_chain
from emcmot.tp.tap cimport at_rest
from emcmot.tp.tp cimport TP_TAP

cdef enum:
    PHASES_PER_PERIOD = 5000    # bound of the work of one period
    LOOKED_AT_PER_PERIOD = 160   # spans

cdef double SAME_SPEED = 1e-12   # relative
cdef double STANDING = 1e-24     # w below which braking has come to rest: the rest is rounding
cdef double ROUNDING = 4e-16     # of u, relative to the length of its span
cdef double ARRIVED = 4.0 * ROUNDING # the same, for its end: a stop may fall short by half of this
cdef double HARDER = 1e-7        # share of the limit over a period that braking onto a point may add for rounding

ctypedef struct Phase:
    double acceleration      # d2u/dt2
    double way               # u for which it holds


cdef inline Span* _span(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.spans[index & tp.span_mask]


cdef inline Segment* _seg(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.segs[index & tp.seg_mask]


cdef void advance(TpState* tp) noexcept nogil:
    """One servo period: build and look ahead as far as needed, move by dt, publish position and velocity."""
    cdef double before[AXES]
    cdef int i
    for i in range(AXES):
        before[i] = tp.pos[i]
    tp.lead_known = 0
    tp.look_left = LOOKED_AT_PER_PERIOD
    if not tp.reversing and tp.smooth:
        extend_smoothly(tp)
    elif not tp.reversing:
        extend(tp)
    if tp.active < tp.span_tail:
        if tp.smooth:
            move_smoothly(tp)
        else:
            sweep_caps(tp)
            _move(tp, tp.dt)
        _place(tp)
    if tp.aborting and at_rest(tp):
        _drop_queue(tp)
    for i in range(AXES):
        tp.vel[i] = (tp.pos[i] - before[i]) / tp.dt


cdef void _drop_queue(TpState* tp) noexcept nogil:
    cdef int i
    if tp.reversing:
        turn_forward(tp)
    tp.raw_next = tp.raw_tail
    tp.seg_head = tp.seg_built = tp.seg_tail
    tp.active = tp.settled = tp.new_spans = tp.history = tp.span_tail
    tp.corner_known = 0
    tp.looking = -1
    tp.body_end = tp.body_goal = 0.0
    forget_chain(tp)
    tp.aborting = tp.paused = tp.stepping = 0
    tp.chain = CHAIN_NONE
    tp.tap_phase = TAP_NONE
    tp.u = tp.w = 0.0
    tp.hungry = 1
    forget_plan(tp)
    for i in range(AXES):
        tp.goal[i] = tp.pos[i]


cdef void _place(TpState* tp) noexcept nogil:
    """Find the commanded position."""
    cdef const Span* span
    cdef const Segment* seg
    cdef int i
    if tp.active >= tp.span_tail:
        position(_seg(tp, tp.seg_built - 1), _seg(tp, tp.seg_built - 1).length, tp.pos)
        return
    span = _span(tp, tp.active)
    seg = _seg(tp, span.seg)
    if seg.kind == TP_TAP and tp.tap_phase != TAP_NONE:
        for i in range(AXES):
            tp.pos[i] = seg.start[i] + seg.rate[i] * tp.tap_s
    elif span.kind == SPAN_CUBIC:
        cubic_position(span, tp.u, tp.pos)
    elif span.kind == SPAN_BLEND:
        blend_position(_seg(tp, span.seg - 1), _seg(tp, span.seg), span.trim, reached(tp, span), tp.pos)
    else:
        position(_seg(tp, span.seg), reached(tp, span), tp.pos)


cdef void _move(TpState* tp, double left) noexcept nogil:
    """Move along the path for `left` seconds."""
    cdef Span* span
    cdef Phase phase
    cdef double v, end_v, end_w, time, way
    cdef int count
    for count in range(PHASES_PER_PERIOD):
        if tp.w == 0.0 and waiting(tp):
            return
        span = _span(tp, tp.active)
        if _seg(tp, span.seg).kind == TP_TAP and tp.u == 0.0:
            run_tap(tp, span)
            return
        if tp.u >= span.h * (1.0 - ARRIVED):
            if not next_span(tp, span):
                return
            continue
        look_ahead(tp)
        phase = _line_phase(tp, span) if span.kind == SPAN_LINE else _curve_phase(tp, span)
        if tp.w == 0.0 and phase.acceleration <= 0.0:
            return
        end_w = fmax(0.0, tp.w + 2.0 * phase.acceleration * phase.way)
        if phase.acceleration < 0.0 and end_w < STANDING:
            end_w = 0.0
        v = sqrt(tp.w)
        time = 2.0 * phase.way / (v + sqrt(end_w))
        if time <= left:
            left -= time
            count_way(tp, _seg(tp, span.seg), phase.way)
            tp.u += phase.way
            tp.w = end_w
            continue
        end_v = v + phase.acceleration * left
        if end_v > 0.0:
            way = 0.5 * (v + end_v) * left
            tp.w = end_v * end_v
        else:
            way = 0.5 * tp.w / fabs(phase.acceleration)
            tp.w = 0.0
        count_way(tp, _seg(tp, span.seg), way)
        tp.u += way
        return


cdef Phase _line_phase(TpState* tp, const Span* span) noexcept nogil:
    """Accelerate to the feed, hold it, brake for what follows: whichever is due now."""
    cdef Phase phase
    cdef double x = span.h - tp.u, a = span.acc
    cdef double limit = exit_limit(tp, tp.active)
    cdef double braking = limit + 2.0 * a * x        # w from which full braking arrives at the limit
    cdef double target = target_w(tp), hardest
    if tp.w > target * (1.0 + SAME_SPEED):
        phase.acceleration = -a
        phase.way = fmin(x, (tp.w - target) / (2.0 * a))
    elif tp.w >= braking * (1.0 - SAME_SPEED) or braking - tp.w <= 4.0 * a * ROUNDING * span.h:
        hardest = a * (1.0 + HARDER * fmax(1.0, 0.5 * tp.dt * sqrt(tp.w) / x))
        phase.acceleration = fmax(-hardest, fmin(0.0, (limit - tp.w) / (2.0 * x)))
        phase.way = x
    elif tp.w < target * (1.0 - SAME_SPEED):
        phase.acceleration = a
        phase.way = fmin(x, fmin((target - tp.w) / (2.0 * a), (braking - tp.w) / (4.0 * a)))
    else:
        phase.acceleration = 0.0
        phase.way = fmin(x, (braking - tp.w) / (2.0 * a))
    return phase


cdef Phase _curve_phase(TpState* tp, const Span* span) noexcept nogil:
    """The largest acceleration to the end of the span; the smallest where the speed is to fall.

    What was chosen before on this span may always be held on: it keeps the limits at both ends.
    """
    cdef Phase phase
    cdef double x = span.h - tp.u
    cdef double limit = exit_limit(tp, tp.active)
    cdef double low, high, target, room
    if not acceleration_range(span, tp.amax, tp.u, tp.w, &low, &high) and tp.held_span == tp.active:
        low = high = tp.held
    if tp.held_span == tp.active:
        low = fmin(low, tp.held)
        high = fmax(high, tp.held)
    phase.way = x
    if holding(tp):
        tp.held_span = -1
        phase.acceleration = hardest_stop(span, tp.amax, tp.u, tp.w)
        if tp.w + 2.0 * x * phase.acceleration <= 0.0:
            phase.way = -0.5 * tp.w / phase.acceleration if tp.w > 0.0 else x
        else:
            phase.acceleration = fmax(low, -0.5 * tp.w / x)
            tp.held = phase.acceleration
            tp.held_span = tp.active
        return phase
    target = target_w(tp)
    phase.acceleration = fmax(low, fmin(high, (fmin(limit, target) - tp.w) / (2.0 * x)))
    tp.held = phase.acceleration
    tp.held_span = tp.active
    if limit < target:
        room = _even_acceleration(tp, span, x, limit)
        if tp.w + limit < 0.25 * room * x and tp.w < 0.99 * target:
            tp.held_span = -1
            phase.acceleration = room
            phase.way = fmin(limit - tp.w + 2.0 * room * x, 2.0 * (target - tp.w)) / (4.0 * room)
    return phase


cdef double _even_acceleration(const TpState* tp, const Span* span, double x, double limit) noexcept nogil:
    """An acceleration that may be held, either way, anywhere on the rest x of the span, up to the speeds it leads to."""
    cdef double a = span.acc, dq, ddq, most
    cdef int j
    for j in range(span.n):
        dq = fmax(fabs(span.dq0[j]), fabs(span.dq1[j]))
        ddq = fmax(fabs(span.ddq0[j]), fabs(span.ddq1[j]))
        most = tp.amax[span.axis[j]] * span.tight - ddq * limit
        a = fmin(a, fmax(0.0, most) / (dq + 2.0 * x * ddq))
    return a
