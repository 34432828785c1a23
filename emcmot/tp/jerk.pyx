"""Motion along the planned path with limited jerk, one servo period at a time.

The machine follows the speed plan (see interior) in a time of its own: in a period dt the plan goes on by rate * dt. Overrides,
holds, and the spindle that a move follows change the rate, between 0 and 1; a change that ends late may take it a little
beyond, for which plans have room. With the plan's velocity, acceleration and jerk of an axis V, A, J, its own are

    rate V,   rate^2 A + rate' V,   rate^3 J + 3 rate rate' A + rate'' V

so each axis has a bound for rate' and rate'', from what the plan leaves of its limits. These are taken from the part of the path
on which the rate changes; the rate can always be kept, so whatever is commanded, the limits hold.
Speeds that overrides allow again are planned anew: see plan_ahead.
"""

from libc.math cimport INFINITY, copysign, fabs, fmax, fmin, sqrt
from libc.stdint cimport int64_t

from emcmot.tp.follow cimport count_way, follows_position, follows_velocity, spindle_speed
from emcmot.tp.guess cimport plan_cap
from emcmot.tp.interior cimport plan_ahead, plan_anew, planning
from emcmot.tp.model cimport Cell, Segment, Span, TpState
from emcmot.tp.path cimport feed_cap, feed_scale
from emcmot.tp.profile cimport Pace, after, crawl, creeps, fastest, most_rate, pace, pace_time, time_to
from emcmot.tp.progress cimport current_segment, holding, next_span, run_tap, waiting
from emcmot.tp.tp cimport TP_TAP

cdef enum:
    PLACES = 5                   # of a span, at which limits are looked at
    SPANS_PER_PERIOD = 5000      # bound of the way of one period,
    SPANS_OF_CHANGE = 400        # and of the path on which the rate changes

cdef double ROUNDING = 4e-15     # of u, relative to the length of its span
cdef double STANDING = 0.001     # jerk dt^2; a rate as near its goal is there: what that adds to the jerk is less than plans leave
cdef double CLOSER = 0.3         # of the way to a higher rate: what is left there is used now
cdef double LEFT = 0.995         # of accelerations and jerks, may be used
cdef double TURNING = 0.5        # of the jerk that the plan leaves, for the rate's change; the rest changes that change
cdef double APPROACH = 0.5       # of that change of change, for closing in on the wanted rate: it may become less on the way
cdef double MARGIN = 0.12        # s of the plan that are looked at beyond the change of the rate
cdef double LEAST_RATE = 0.1     # that may become a plan,
cdef double LONG = 0.05          # s on one span, with which it may not
cdef double FASTER = 1.02        # of a cap, at which a plan is made anew
cdef double OVER = 0.002         # of the feed, at which the plan counts as too fast for it
cdef double HUNGRY = 0.2        # s of the plan before its end, beyond what a stop takes: more path is wanted

ctypedef struct Freedom:
    double change                # largest |rate'|
    double jerk                  # and |rate''|


cdef inline Span* _span(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.spans[index & tp.span_mask]


cdef inline Cell* _cell(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.cells[index & tp.cell_mask]


# --- the rate ---------------------------------------------------------------------------------------------------------

cdef void _leave(const TpState* tp, int64_t index, double start, double end, double rate, Freedom* freedom) noexcept nogil:
    """What a part of a span leaves to changes of the rate, where that is no more than `rate`."""
    cdef const Span* span = _span(tp, index)
    cdef Pace p = pace(tp, index)
    cdef double x, w, a, v, dq, ddq, dddq, along, across, left
    cdef int place, j
    for place in range(PLACES):
        x = start + (end - start) * place / (PLACES - 1)
        w = p.w + x * (p.slope + x * p.bend)
        a = 0.5 * p.slope + x * p.bend
        v = sqrt(fmax(w, 0.0))
        for j in range(span.n):
            dddq = (span.ddq1[j] - span.ddq0[j]) / span.h
            ddq = span.ddq0[j] + x * dddq
            dq = span.dq0[j] + x * (span.ddq0[j] + 0.5 * x * dddq)
            along = fabs(dq) * v
            if along == 0.0:
                continue
            across = fabs(dq * a + ddq * w)
            left = fmax(0.0, LEFT * tp.amax[span.axis[j]] * span.tight - rate * rate * across) / along
            freedom.change = fmin(freedom.change, left)
            left = LEFT * tp.jmax[span.axis[j]] - rate * rate * rate * v * fabs(dq * p.bend + 3.0 * ddq * a + dddq * w)
            left = fmax(0.0, left)
            if across > 0.0:
                freedom.change = fmin(freedom.change, TURNING * left / (3.0 * fmax(rate, 1e-9) * across))
                left *= 1.0 - TURNING
            freedom.jerk = fmin(freedom.jerk, left / along)


cdef Freedom _freedom(const TpState* tp, double goal) noexcept nogil:
    """How much the rate may change, and that change, on the way to `goal`."""
    cdef Freedom freedom
    cdef double time = 0.0, gap, needed, highest = fmax(tp.rate, goal)
    cdef int64_t k
    freedom.change = freedom.jerk = INFINITY
    for k in range(tp.active, min(tp.planned, tp.active + SPANS_OF_CHANGE)):
        _leave(tp, k, 0.0, _span(tp, k).h, highest, &freedom)
        time += pace_time(tp, k)
        gap = fabs(goal - tp.rate) + 0.5 * tp.rate_change * tp.rate_change / freedom.jerk
        needed = gap / freedom.change + 2.0 * sqrt(gap / freedom.jerk) + fabs(tp.rate_change) / freedom.jerk
        if _span(tp, k).stop or time > highest * needed + MARGIN:
            break
    freedom.jerk = fmin(freedom.jerk, freedom.change / tp.dt)
    return freedom


cdef double _jerk_now(const TpState* tp) noexcept nogil:
    """How much the change of the rate may change in this period: it can always be taken back where the machine is."""
    cdef Freedom freedom
    cdef double left = 2.0 * tp.dt, start = tp.u, end, v
    cdef int64_t k = tp.active
    freedom.change = freedom.jerk = INFINITY
    while True:
        v = fastest(tp, k)
        end = fmin(_span(tp, k).h, start + left * v)
        _leave(tp, k, start, end, tp.rate, &freedom)
        left -= (end - start) / v
        start = 0.0
        k += 1
        if end < _span(tp, k - 1).h or left <= 0.0 or k >= tp.planned or _span(tp, k - 1).stop:
            return freedom.jerk


cdef inline double _towards(double gap, double jerk, double dt) noexcept nogil:
    """Change after `dt`, from which a gap is closed just when the change is back at zero."""
    return sqrt(0.25 * jerk * jerk * dt * dt + 2.0 * jerk * gap) - 0.5 * jerk * dt


cdef double _goal(TpState* tp) noexcept nogil:
    """The rate that holds, overrides and the spindle ask for."""
    cdef const Segment* seg = &tp.segs[current_segment(tp) & tp.seg_mask]
    cdef double v, planned
    cdef Pace p
    if holding(tp) or (tp.active + 1 >= tp.planned and creeps(tp, tp.active)):
        return 0.0
    if not follows_position(seg) and not follows_velocity(seg):
        return tp.rate_limit
    v = spindle_speed(tp, seg) * (feed_scale(tp, seg) if seg.sync_velocity else 1.0) / seg.pace
    p = pace(tp, tp.active)
    planned = sqrt(fmax(1e-30, p.w + tp.u * (p.slope + tp.u * p.bend)))
    if v > planned and plan_cap(tp, tp.active) > FASTER * _cell(tp, tp.active).cap:
        tp.replan = 1                        # the spindle has become faster
    return fmin(tp.rate_limit, v / planned)


cdef double _wanted_change(const TpState* tp, double goal, Freedom* freedom) noexcept nogil:
    """Change of the rate at the end of this period, with which the goal is reached soonest; and what is free for that."""
    cdef double dt = tp.dt, gap = goal - tp.rate - 0.5 * tp.rate_change * dt, jerk, wanted, change, down, up
    if goal > tp.rate:                       # the higher the rate, the less is left of limits
        freedom[0] = _freedom(tp, tp.rate + CLOSER * (goal - tp.rate))
        jerk = 0.5 * (freedom.jerk + _freedom(tp, goal).jerk)
    else:
        freedom[0] = _freedom(tp, goal)
        jerk = freedom.jerk
    wanted = copysign(fmin(freedom.change, _towards(fabs(gap), APPROACH * jerk, 2.0 * dt)), gap)
    down = up = freedom.jerk
    if tp.rate_change > 0.0:
        down = fmax(down, _jerk_now(tp))
    elif tp.rate_change < 0.0:
        up = fmax(up, _jerk_now(tp))
    change = fmax(tp.rate_change - down * dt, fmin(tp.rate_change + up * dt, wanted))
    if change * tp.rate_change < 0.0:        # what goes beyond is a change of its own
        change = fmax(-freedom.jerk * dt, fmin(freedom.jerk * dt, change))
    return change


cdef double _change_rate(TpState* tp) noexcept nogil:
    """Find the rate at the end of this period; how far the plan goes on in it."""
    cdef double dt = tp.dt, goal = _goal(tp), was = tp.rate, change
    cdef Freedom freedom
    if tp.rate_change == 0.0 and LEAST_RATE < tp.rate < 1.0 and tp.rate == goal == tp.rate_limit and _take_over_rate(tp):
        return dt
    if tp.rate_change == 0.0 and tp.rate == goal:
        return goal * dt
    change = _wanted_change(tp, goal, &freedom)
    tp.rate += 0.5 * (tp.rate_change + change) * dt
    tp.rate_change = change
    if fabs(goal - tp.rate) <= freedom.jerk * dt * dt * STANDING and fabs(change) <= 2.0 * STANDING * freedom.jerk * dt:
        tp.rate = goal
        tp.rate_change = 0.0
    if tp.rate >= most_rate():
        tp.rate = most_rate()
        tp.rate_change = fmin(0.0, tp.rate_change)
    if tp.rate <= 0.0:
        tp.rate = tp.rate_change = 0.0
    return 0.5 * (was + tp.rate) * dt


cdef int _take_over_rate(TpState* tp) noexcept nogil:
    """The rate is steady: let it be that of a slower plan, which can be improved where overrides do not matter.

    0 where that must wait: close to a standstill, or where the next spans, which no new plan makes faster, would take long.
    """
    cdef int64_t k
    cdef double share = tp.rate * tp.rate, w
    for k in range(max(tp.plan_from, tp.active - 1), min(tp.planned, tp.active + 3)):
        w = _cell(tp, k).w * share
        if w <= crawl(tp, k) or _span(tp, k).h > LONG * sqrt(w):
            return 0
    for k in range(max(tp.plan_from, tp.active - 1), tp.planned):
        _cell(tp, k).w = fmax(share * _cell(tp, k).w, fmin(_cell(tp, k).w, crawl(tp, k)))
    tp.rate = tp.rate_limit = 1.0
    plan_anew(tp)
    return 1


cdef void _limit_rate(TpState* tp) noexcept nogil:
    """What overrides leave of the plan, where it is too fast for them."""
    cdef int64_t k
    cdef double limit = 1.0, cap, w
    for k in range(tp.active, tp.planned):
        w = _cell(tp, k).w
        cap = feed_cap(tp, k)
        if w > (1.0 + OVER) * cap:
            limit = fmin(limit, cap / w)
        if fmin(cap, _span(tp, k).cap) > FASTER * _cell(tp, k).cap:
            tp.replan = 1
    tp.rate_limit = sqrt(limit)


# --- one period -------------------------------------------------------------------------------------------------------

cdef void move_smoothly(TpState* tp) noexcept nogil:
    """Move along the path for one period."""
    cdef Span* span = _span(tp, tp.active)
    cdef double time, v
    cdef Pace p
    if tp.w == 0.0 and tp.u == 0.0 and waiting(tp):
        plan_ahead(tp)
        return
    if tp.u >= span.h * (1.0 - ROUNDING) and not _go_on(tp, span):
        return
    span = _span(tp, tp.active)
    if tp.w == 0.0 and tp.u == 0.0 and waiting(tp):
        return
    if tp.segs[span.seg & tp.seg_mask].kind == TP_TAP and tp.u == 0.0:
        run_tap(tp, span)
        return
    plan_ahead(tp)
    if tp.active >= tp.planned:
        tp.hungry = not planning(tp)
        return
    if tp.caps_changed:
        tp.caps_changed = 0
        _limit_rate(tp)
    p = pace(tp, tp.active)
    if tp.w == 0.0 and tp.u == 0.0 and p.w <= 1.01 * crawl(tp, tp.active) and _goal(tp) > 0.0:
        tp.rate = fmin(1.0, _goal(tp))
    time = _change_rate(tp)
    if tp.rate == 0.0 and tp.active + 1 >= tp.planned and creeps(tp, tp.active):
        tp.planned = tp.active               # that end was not made for a stop
    tp.plan_time -= time
    p = pace(tp, tp.active)
    v = sqrt(fmax(0.0, p.w + tp.u * (p.slope + tp.u * p.bend)))
    tp.hungry = tp.span_tail <= tp.planned and tp.plan_time < HUNGRY + v / span.push + span.push / span.jerk
    _go(tp, time)


cdef int _go_on(TpState* tp, Span* span) noexcept nogil:
    """On to the next span; 0 where the path ends, or the machine stands for a while."""
    if not next_span(tp, span):
        span.stop = 1
        tp.hungry = 1
        return 0
    return 1


cdef void _go(TpState* tp, double time) noexcept nogil:
    """Follow the plan for a time of its own."""
    cdef Span* span
    cdef const Segment* seg
    cdef double place, v = 0.0, needed
    cdef Pace p
    cdef int k
    for k in range(SPANS_PER_PERIOD):
        span = _span(tp, tp.active)
        seg = &tp.segs[span.seg & tp.seg_mask]
        p = pace(tp, tp.active)
        needed = INFINITY
        if span.h - tp.u <= time * fastest(tp, tp.active):
            needed = time_to(&p, tp.u, span.h)
        if needed > time:
            place = fmin(span.h, after(&p, tp.u, time, &v))
            count_way(tp, seg, (place - tp.u) * seg.pace)
            tp.u = place
            tp.w = (tp.rate * v) ** 2
            return
        time -= needed
        count_way(tp, seg, (span.h - tp.u) * seg.pace)
        tp.u = span.h
        if tp.active + 1 >= tp.planned:
            span.stop = 1
        if span.stop:
            tp.w = tp.rate = tp.rate_change = 0.0
        if not _go_on(tp, span) or span.stop:
            return
