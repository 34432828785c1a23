"""Makes the speed plan where jerk is limited: as fast as velocities, accelerations and jerks of all axes and joints allow.

An interior point method: from a first guess, Newton's method for the time that the plan takes and a barrier that keeps it away from
limits and whose weight falls from step to step [Boyd, Vandenberghe, Convex Optimization, chapter 11]. A guess may break limits: where less
than a little is left of one, the barrier goes on as a parabola [Feller, Ebenbauer, Relaxed logarithmic barrier function based
model predictive control, 2017]. In the end each span is looked at between the places of the equations too; where that breaks a limit, less of
it is planned with there. Only what keeps all limits, and ends in a standstill on the known path, becomes the plan in force.

A step costs a few passes over the spans. Passes are cut into what one servo period can bear, while the machine follows
the plan in force; the new one begins far enough ahead of it.
Called by jerk.
"""

from libc.math cimport INFINITY, fmax, fmin, sqrt
from libc.stdint cimport int64_t

from emcmot.tp.equations cimport assemble_span, clear_equations, is_within, solve_equations, span_value, speed_reach
from emcmot.tp.guess cimport fixed, guess_plan
from emcmot.tp.model cimport Cell, END_STOP, Improvement, Span, TpState
from emcmot.tp.profile cimport pace_time

cdef enum InteriorPhase:
    IDLE = 0
    ASSEMBLE = 1             # the equations of a step
    REACH = 2                # how much of the step leaves some speed everywhere?
    TRY = 3                  # is it better?
    CHECK = 4                # is the result within all limits?

cdef enum:
    PLANNED_SPANS = 256      # at most, in one plan
    LEAST_NEW = 96           # spans that are worth a new plan
    VISITS = 480             # of spans in one period,
    VISITS_AT_REST = 600
    STEPS = 4                # with one barrier,
    MOST_STEPS = 40          # and in all
    MOST_CHECKS = 8
    TRIALS = 14              # of shares of a step

cdef double LEAD = 0.16          # s of the plan in force that are not touched: a new plan is ready before
cdef double ENOUGH = 1.0         # s that a plan is long, at most, at the speeds of its spans
cdef double FIRST_BARRIER = 0.3
cdef double LAST_BARRIER = 0.004
cdef double WEAKER = 0.25        # each barrier than the one before
cdef double NEARLY = 1.2         # of limits, where the barrier becomes weaker
cdef double NEAR = 0.15          # of a barrier: what is left of a limit from where on it is a parabola
cdef double CENTRED = 0.05       # gain of a step, of barrier and weight: go on with the next barrier
cdef double TO_BOUNDARY = 0.92   # of the step that leaves no speed
cdef double LESS = 0.6           # share of a step after one that was too long


cdef inline const Span* _span(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.spans[index & tp.span_mask]


cdef inline Cell* _cell(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.cells[index & tp.cell_mask]


cdef void forget_plan(TpState* tp) noexcept nogil:
    """The path ahead is another one now; at rest."""
    tp.improvement.phase = IDLE
    tp.plan_from = tp.planned = tp.active
    tp.plan_time = 0.0
    tp.replan = 0
    tp.rate = tp.rate_change = 0.0
    tp.rate_limit = 1.0


cdef int planning(const TpState* tp) noexcept nogil:
    """Whether a plan is being made."""
    return tp.improvement.phase != IDLE


cdef void plan_anew(TpState* tp) noexcept nogil:
    """The plan in force was changed: what is being made no longer fits it."""
    tp.improvement.phase = IDLE
    tp.replan = 1


# --- what is planned --------------------------------------------------------------------------------------------------

cdef void plan_ahead(TpState* tp) noexcept nogil:
    """Go on with the new plan, as far as one period bears, or begin one where that is worth it."""
    cdef int visits = VISITS if tp.w > 0.0 else VISITS_AT_REST
    if tp.improvement.phase == IDLE and (not _is_due(tp) or not _begin(tp)):
        return
    if tp.improvement.first > tp.improvement.origin and tp.active + 1 >= tp.improvement.first:
        plan_anew(tp)                        # the machine is there already
    while tp.improvement.phase != IDLE and visits > 0:
        visits -= _go_on(tp)


cdef int _is_long(const TpState* tp) noexcept nogil:
    """Whether so much of the path is laid that it is worth setting out."""
    cdef double time = 0.0
    cdef int64_t k = tp.active
    while k < tp.span_tail and k < tp.active + LEAST_NEW and time < 0.5 * ENOUGH:
        time += _span(tp, k).h / _span(tp, k).steady
        k += 1
    return k == tp.active + LEAST_NEW or time >= 0.5 * ENOUGH


cdef int _is_due(TpState* tp) noexcept nogil:
    cdef const Span* span
    cdef double v
    if tp.active >= tp.span_tail:
        return 0
    if tp.active >= tp.planned:
        return (tp.end == END_STOP and tp.body_end >= tp.body_goal) or tp.reversing or _is_long(tp)
    if tp.replan:
        return 1
    if tp.span_tail <= tp.planned:
        return 0
    if tp.span_tail - tp.planned >= LEAST_NEW:
        return tp.planned - tp.active < PLANNED_SPANS
    span = _span(tp, tp.active)
    v = sqrt(_cell(tp, tp.active).w)
    return tp.plan_time < LEAD + 0.5 * ENOUGH + v / span.push + span.push / span.jerk


cdef int _begin(TpState* tp) noexcept nogil:
    """Choose what is planned anew, and guess a plan for it; 0: nothing can be."""
    cdef Improvement* s = &tp.improvement
    cdef const Span* span
    cdef int64_t k
    cdef int replan
    cdef double time = 0.0
    replan = tp.replan
    tp.replan = 0
    s.origin = tp.plan_from
    if tp.active >= tp.planned or (tp.w == 0.0 and (tp.u == 0.0 or tp.rate == 0.0)):
        s.origin = s.first = tp.active
    else:
        k = tp.active
        while time < LEAD and k < tp.planned:
            time += pace_time(tp, k)
            k += 1
        s.first = k + 1
        if s.first > tp.planned or (s.first >= tp.planned and tp.planned >= tp.span_tail):
            return 0
    s.end = s.first
    time = 0.0
    while s.end < tp.span_tail and s.end - s.first < PLANNED_SPANS and time < ENOUGH:
        span = _span(tp, s.end)
        time += span.h / span.steady
        s.end += 1
    if s.first > s.origin and not replan and s.end - tp.planned < min(LEAST_NEW, (s.end - s.first) // 4) and s.end < tp.span_tail:
        return 0
    if s.end <= s.first:
        return 0
    guess_plan(tp)
    s.total = s.checks = 0
    _set_barrier(tp, FIRST_BARRIER)
    _begin_step(tp)
    return 1


# --- passes -----------------------------------------------------------------------------------------------------------

cdef int _go_on(TpState* tp) noexcept nogil:
    """Visit the next span of the pass that is due, and begin the next pass behind the last; how much work that was."""
    cdef Improvement* s = &tp.improvement
    cdef int64_t index = s.cursor
    if index < s.end:
        s.cursor += 1
        if s.phase == ASSEMBLE:
            assemble_span(tp, index)
            return 2
        if s.phase == REACH:
            s.share = fmin(s.share, speed_reach(tp, index))
        elif s.phase == CHECK:
            s.within &= is_within(tp, index)
            return 2
        else:
            s.trial += span_value(tp, index, s.share, &s.trial_worst)
            if s.trial == INFINITY:
                _shorten(tp)
        return 1
    if s.phase == ASSEMBLE:
        solve_equations(tp)
        s.phase = CHECK if _is_centred(tp) else REACH
        s.share = INFINITY
        s.within = 1
        _rewind(tp)
    elif s.phase == REACH:
        s.share = fmin(1.0, TO_BOUNDARY * s.share)
        s.attempt = 0
        _begin_trial(tp)
    elif s.phase == CHECK:
        s.checks += 1
        if s.within:
            _finish(tp)
        elif s.checks < MOST_CHECKS:
            s.steps = 0
            _begin_step(tp)
        else:
            _give_up(tp)
    elif s.trial <= s.merit:
        _take_step(tp)
    else:
        _shorten(tp)
    return 1


cdef void _rewind(TpState* tp) noexcept nogil:
    tp.improvement.cursor = max(tp.improvement.first - 1, tp.improvement.origin)


cdef int _is_centred(const TpState* tp) noexcept nogil:
    """Whether the plan is as good as the last barrier allows."""
    cdef const Improvement* s = &tp.improvement
    return s.barrier <= LAST_BARRIER and (s.gain <= CENTRED * s.barrier * s.weight or s.steps >= STEPS)


cdef void _begin_step(TpState* tp) noexcept nogil:
    cdef Improvement* s = &tp.improvement
    s.phase = ASSEMBLE
    if s.steps == 0:
        s.merit = s.worst = 0.0
    clear_equations(tp)
    _rewind(tp)


cdef void _begin_trial(TpState* tp) noexcept nogil:
    tp.improvement.phase = TRY
    tp.improvement.trial = tp.improvement.trial_worst = 0.0
    _rewind(tp)


cdef void _shorten(TpState* tp) noexcept nogil:
    """A step was too long."""
    cdef Improvement* s = &tp.improvement
    s.attempt += 1
    if s.attempt < TRIALS:
        s.share *= LESS
        _begin_trial(tp)
    else:
        _give_up(tp)


cdef void _give_up(TpState* tp) noexcept nogil:
    """The next guess is made otherwise."""
    tp.improvement.phase = IDLE
    tp.improvement.failed = not tp.improvement.failed


cdef void _take_step(TpState* tp) noexcept nogil:
    cdef Improvement* s = &tp.improvement
    cdef int64_t k
    for k in range(s.first, s.end):
        _cell(tp, k).fresh += s.share * _cell(tp, k).change
    s.steps += 1
    s.total += 1
    s.merit = s.trial
    s.worst = s.trial_worst
    if s.total >= MOST_STEPS:
        _give_up(tp)
        return
    if s.barrier > LAST_BARRIER and (s.gain <= CENTRED * s.barrier * s.weight or (s.steps >= STEPS and s.worst < NEARLY)):
        _set_barrier(tp, fmax(LAST_BARRIER, WEAKER * s.barrier))
    _begin_step(tp)


cdef void _set_barrier(TpState* tp, double barrier) noexcept nogil:
    tp.improvement.barrier = barrier
    tp.improvement.near = NEAR * barrier
    tp.improvement.steps = 0


cdef void _finish(TpState* tp) noexcept nogil:
    """Take the new plan over, if the machine is not there yet."""
    cdef Improvement* s = &tp.improvement
    cdef int64_t k
    s.phase = IDLE
    s.failed = 0
    if tp.active + 1 >= s.first if s.first > s.origin else tp.w > 0.0 or tp.active != s.origin:
        tp.replan = 1
        return
    tp.plan_from = s.origin
    for k in range(s.first, s.end):
        _cell(tp, k).w = _cell(tp, k).fresh
    tp.planned = s.end
    tp.plan_time = 0.0
    for k in range(tp.active, tp.planned):
        if not fixed(tp, k):
            tp.plan_time += pace_time(tp, k)
    tp.caps_changed = 1
