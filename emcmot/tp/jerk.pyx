"""Motion along the planned path with limited jerk, one servo period at a time.

The state is the speed v = du/dt and its change a. The path ahead is looked at as *stretches*: spans with similar limits
taken as one, each with a largest speed, acceleration and jerk along the path. It must be possible to slow down to the speed
of each before it begins, with an acceleration that it bears, and to stand still where a move ends in a stop or the known
path does. What is possible now still is after a period of the hardest braking: so there is always a way to keep all limits.

A period takes the acceleration that leads to the wanted speed (feed, override, hold) without passing it; where that would
make one of the stretches unreachable, it takes the nearest one that does not. Nothing is planned further ahead, so every
command acts at once.
Speeds here are those of `smooth`, which adds what makes the curvature continuous.
"""

from libc.math cimport copysign, fabs, fmax, fmin, sqrt
from libc.stdint cimport int64_t

from emcmot.tp.follow cimport count_way
from emcmot.tp.model cimport STRETCHES, Segment, Span, Stretch, TpState
from emcmot.tp.path cimport feed
from emcmot.tp.progress cimport next_span, run_tap, target_w, waiting
from emcmot.tp.tp cimport TP_TAP

cdef enum:
    GATHERED_PER_PERIOD = 128    # spans
    HALVINGS = 10                # of the range of accelerations, where the wanted one is too large,
    SLOW_HALVINGS = 32           # and where the machine is slow: the path ahead may ask for far less than one period's jerk brings
    SPANS_PER_PERIOD = 5000      # bound of the way of one period

cdef enum Verdict:
    FEASIBLE = 0
    TOO_FAST = 1                 # for a stretch ahead
    TOO_HARD = 2                 # braking: it cannot be taken back in time

cdef double ROUNDING = 4e-15     # of u, relative to the length of its span
cdef double STANDING = 0.1    # jerk dt^2: a held machine that is no faster stands
cdef double LANDING = 0.2     # jerk dt^3 from the end, the rest of the way is gone in one period
cdef double EARLY = 0.5       # jerk dt^3 before a slower stretch, its speed is reached: periods round the braking curve
cdef double ALIKE = 0.85         # ratio of limits from which two spans may be one stretch
cdef double SHORT = 0.04         # of the way that braking takes: shorter spans are taken together anyway
cdef double REACH = 1.25         # the known path should be longer than braking takes, by this


cdef inline Span* _span(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.spans[index & tp.span_mask]


cdef inline Stretch* _stretch(TpState* tp, int k) noexcept nogil:
    return &tp.stretches[(tp.stretch_head + k) % STRETCHES]


# --- stretches --------------------------------------------------------------------------------------------------------

cdef void forget_stretches(TpState* tp) noexcept nogil:
    """The path ahead is another one now; at rest."""
    tp.stretch_count = 0
    tp.a = 0.0
    tp.hungry = 1


cdef void _gather(TpState* tp) noexcept nogil:
    """Take new spans into stretches. The first stretch, where the machine is, stays as it is."""
    cdef const Span* span
    cdef Stretch* last
    cdef int count
    if tp.stretch_count == 0:
        tp.stretched = tp.active
    for count in range(GATHERED_PER_PERIOD):
        if tp.stretched >= tp.span_tail:
            return
        span = _span(tp, tp.stretched)
        last = _stretch(tp, tp.stretch_count - 1)
        if tp.stretch_count > 1 and not _span(tp, last.last).stop and _belongs(tp, last, span):
            last.length += span.h
            last.speed = fmax(last.speed, span.speed)
            last.steady = fmin(last.steady, span.steady)
            last.push = fmin(last.push, span.push)
            last.jerk = fmin(last.jerk, span.jerk)
        elif tp.stretch_count < STRETCHES:
            tp.stretch_count += 1
            last = _stretch(tp, tp.stretch_count - 1)
            last.seg = span.seg
            last.length = span.h - (tp.u if tp.stretched == tp.active else 0.0)
            last.speed = span.speed
            last.steady = span.steady
            last.push = span.push
            last.jerk = span.jerk
        else:
            return
        last.last = tp.stretched
        tp.stretched += 1


cdef int _belongs(const TpState* tp, const Stretch* stretch, const Span* span) noexcept nogil:
    """Whether a span may join a stretch: it is alike, or both are too short to change the speed by much."""
    cdef const Segment* a = &tp.segs[stretch.seg & tp.seg_mask]
    cdef const Segment* b = &tp.segs[span.seg & tp.seg_mask]
    cdef double slow = fmin(stretch.steady, span.steady), push, jerk
    if a.vel != b.vel or a.vel_max != b.vel_max or a.enables != b.enables or a.motion_type != b.motion_type:
        return 0
    if a.unit != b.unit or a.spindle != b.spindle:
        return 0
    push = fmin(stretch.push, span.push)
    jerk = fmin(stretch.jerk, span.jerk)
    if slow >= ALIKE * fmax(stretch.steady, span.steady) and push >= ALIKE * fmax(stretch.push, span.push):
        if jerk >= ALIKE * fmax(stretch.jerk, span.jerk):
            return 1
    return stretch.length + span.h <= SHORT * _settling_way(slow, 0.0, push, jerk)


cdef double _speed(const TpState* tp, const Stretch* stretch) noexcept nogil:
    """Speed that a stretch may be run at now, overrides included."""
    return fmin(stretch.steady, feed(tp, &tp.segs[stretch.seg & tp.seg_mask]) / stretch.speed)


# --- braking ----------------------------------------------------------------------------------------------------------

cdef inline double _settling_way(double v, double to, double push, double jerk) noexcept nogil:
    """Way on which the speed falls from `v` to `to`, with no acceleration at either end."""
    cdef double fall = v - to
    if fall * jerk <= push * push:
        return (v + to) * sqrt(fall / jerk)
    return 0.5 * (v + to) * (fall / push + push / jerk)


cdef double _braking_way(double v, double a, double to, double push, double jerk) noexcept nogil:
    """Least way until the speed, which changes by `a` now, is no more than `to` and stays so."""
    cdef double t, top, root
    if a >= 0.0:
        t = a / jerk
        top = v + 0.5 * a * t
        if top <= to:
            return 0.0
        return v * t + a * t * t / 3.0 + _settling_way(top, to, push, jerk)
    if v <= to:
        return 0.0
    a = fmax(a, -push)
    t = -a / jerk
    root = a * a - 2.0 * jerk * (v - to)
    if root >= 0.0:                          # on the way back to a = 0 already
        t = (-a - sqrt(root)) / jerk
        return v * t + 0.5 * a * t * t + jerk * t * t * t / 6.0
    top = v - 0.5 * a * t                    # where this braking would have begun
    return fmax(0.0, _settling_way(top, to, push, jerk) - top * t + jerk * t * t * t / 6.0)


cdef double _meeting_way(double v, double a, double to, double push, double jerk, double later) noexcept nogil:
    """Least way until the speed fits a stretch in which only the jerk `later` takes back an acceleration."""
    cdef double t = a / jerk
    if a > 0.0 and v + 0.5 * a * a / later > to:
        return v * t + a * t * t / 3.0 + _settling_way(fmax(to, v + 0.5 * a * t), to, push, jerk)
    return _braking_way(v, a, to, push, jerk)


cdef inline int _relaxed(double v, double a, double push, double jerk, double distance) noexcept nogil:
    """Whether an acceleration that is taken back from now on is no more than `push` after a distance."""
    cdef double t = (fabs(a) - push) / jerk
    return t <= 0.0 or v * t + 0.5 * a * t * t - copysign(jerk, a) * t * t * t / 6.0 <= distance


cdef Verdict _judge(TpState* tp, double v, double a, double way) noexcept nogil:
    """Whether all stretches ahead can be met at their speeds and accelerations, from v and a, `way` from here."""
    cdef const Stretch* here = _stretch(tp, 0)
    cdef const Stretch* following
    cdef double distance = here.length - way, push = here.push, jerk = here.jerk, slower, rest, room
    cdef double early = EARLY * here.jerk * tp.dt * tp.dt * tp.dt
    cdef int k
    for k in range(tp.stretch_count):
        room = fmax(0.0, distance - v * tp.dt)       # jerk changes between periods only: be there a period early
        rest = _braking_way(v, a, 0.0, push, jerk)
        if _span(tp, here.last).stop:
            return FEASIBLE if rest <= room else TOO_FAST
        if k == tp.stretch_count - 1:
            tp.hungry |= rest * REACH >= room
            return FEASIBLE if rest <= room else TOO_FAST
        if rest < room:
            return FEASIBLE
        following = _stretch(tp, k + 1)
        slower = fmin(jerk, following.jerk)
        room = fmax(0.0, room - early)
        if _meeting_way(v, a, following.now, push, jerk, slower) > room:
            return TOO_FAST
        if v + copysign(0.5 * a * a / jerk, a) <= following.now and not _relaxed(v, a, following.push, jerk, room):
            return TOO_FAST if a > 0.0 else TOO_HARD
        here = following
        distance += here.length
        push = fmin(push, here.push)
        jerk = slower
    return FEASIBLE


# --- one period -------------------------------------------------------------------------------------------------------

cdef inline double _ramp(double gap, double jerk, double dt) noexcept nogil:
    """Acceleration after `dt`, from which a gap of speed is closed just when it is back at zero."""
    return sqrt(0.25 * jerk * jerk * dt * dt + 2.0 * jerk * gap) - 0.5 * jerk * dt


cdef inline Verdict _outcome(TpState* tp, double v, double a) noexcept nogil:
    """The same for the acceleration `a` at the end of this period."""
    return _judge(tp, v + 0.5 * (tp.a + a) * tp.dt, a, tp.dt * (v + (2.0 * tp.a + a) * tp.dt / 6.0))


cdef double _choose(TpState* tp, double v, double target) noexcept nogil:
    """Acceleration at the end of this period: the feasible one that is nearest to what the target speed asks for."""
    cdef const Stretch* here = _stretch(tp, 0)
    cdef double dt = tp.dt, change = here.jerk * dt
    cdef double gap = target - v - 0.5 * tp.a * dt
    cdef double wanted = copysign(fmin(here.push, _ramp(fabs(gap), here.jerk, 2.0 * dt)), gap)
    cdef double low = -fmin(here.push, _ramp(fmax(0.0, v + 0.5 * tp.a * dt), here.jerk, dt))
    cdef double high = tp.a + change, middle
    cdef Verdict verdict
    wanted = fmax(tp.a - change, fmin(high, wanted))
    low = fmin(wanted, fmax(tp.a - change, low))
    verdict = _outcome(tp, v, wanted)
    if verdict == FEASIBLE:
        return wanted
    middle = _nearest(tp, v, low, high, wanted, verdict, 0)
    if _outcome(tp, v, middle) != FEASIBLE and low < wanted:
        middle = _nearest(tp, v, low, wanted, wanted, TOO_FAST, 1)
    return middle


cdef double _nearest(TpState* tp, double v, double low, double high, double wanted, Verdict verdict, int stop) noexcept nogil:
    """The feasible acceleration from `low` to `high` that is nearest to `wanted`, of which `verdict` is known.

    What is TOO_HARD for the stretch ahead may still be right for a `stop` before it, and then less braking is not.
    """
    cdef int halvings = HALVINGS if v > _stretch(tp, 0).jerk * tp.dt * tp.dt else SLOW_HALVINGS
    cdef double middle
    cdef int k
    if verdict == TOO_FAST:
        high = wanted
    else:
        low = wanted
    for k in range(halvings):
        middle = 0.5 * (low + high)
        verdict = _outcome(tp, v, middle)
        if verdict == TOO_FAST or (verdict == TOO_HARD and stop) or (verdict == FEASIBLE and middle > wanted):
            high = middle
        else:
            low = middle
    return high if high > wanted else low


cdef void move_smoothly(TpState* tp) noexcept nogil:
    """Move along the path for one period."""
    cdef Span* span = _span(tp, tp.active)
    cdef double v = sqrt(tp.w), dt = tp.dt, target, a, way, least
    cdef int k
    if tp.draining:
        if tp.lag > 0:
            return
        tp.draining = 0
    if tp.w == 0.0 and waiting(tp):
        return
    if tp.u >= span.h * (1.0 - ROUNDING) and not _go_on(tp, span):
        return
    span = _span(tp, tp.active)
    if tp.w == 0.0 and tp.u == 0.0 and (tp.draining or waiting(tp)):
        return
    if tp.segs[span.seg & tp.seg_mask].kind == TP_TAP and tp.u == 0.0:
        run_tap(tp, span)
        return
    tp.hungry = 0
    _gather(tp)
    for k in range(tp.stretch_count):
        _stretch(tp, k).now = _speed(tp, _stretch(tp, k))
    target = fmin(_stretch(tp, 0).steady, sqrt(target_w(tp)))
    least = _stretch(tp, 0).jerk * dt * dt
    a = _choose(tp, v, target)
    way = dt * (v + (2.0 * tp.a + a) * dt / 6.0)
    v += 0.5 * (tp.a + a) * dt
    if target == 0.0 and v <= STANDING * least and fabs(a) * dt <= STANDING * least:
        tp.w = tp.a = 0.0
        return
    tp.a = a if v > 0.0 else fmax(0.0, a)
    tp.w = fmax(0.0, v) ** 2
    if _ends(tp, 0) and _stretch(tp, 0).length <= LANDING * least * dt and v <= least:
        way = _rest(tp)
    _go(tp, fmax(0.0, way))


cdef double _rest(TpState* tp) noexcept nogil:
    """Way to the end of the first stretch, summed anew: its length has lost digits on the way."""
    cdef double way = -tp.u
    cdef int64_t index
    for index in range(tp.active, _stretch(tp, 0).last + 1):
        way += _span(tp, index).h
    return way


cdef int _ends(TpState* tp, int k) noexcept nogil:
    """Whether the machine must stand at the end of a stretch."""
    return k == tp.stretch_count - 1 or _span(tp, _stretch(tp, k).last).stop


cdef int _go_on(TpState* tp, Span* span) noexcept nogil:
    """On to the next span; 0 where the path ends, or the machine stands for a while."""
    cdef int ended = tp.active == _stretch(tp, 0).last
    if not next_span(tp, span):
        tp.a = 0.0
        tp.hungry = 1
        if tp.active >= tp.span_tail:
            forget_stretches(tp)
        return 0
    if ended and tp.stretch_count > 0:
        tp.stretch_head = (tp.stretch_head + 1) % STRETCHES
        tp.stretch_count -= 1
    if span.stop:
        tp.a = 0.0
        tp.draining = 1
        return 0
    return 1


cdef void _go(TpState* tp, double way) noexcept nogil:
    """Travel along the spans."""
    cdef Span* span
    cdef double room
    cdef int k
    for k in range(SPANS_PER_PERIOD):
        span = _span(tp, tp.active)
        room = fmin(way, span.h - tp.u)
        count_way(tp, &tp.segs[span.seg & tp.seg_mask], room)
        tp.u += room
        _stretch(tp, 0).length -= room
        way -= room
        if tp.u < span.h * (1.0 - ROUNDING) or not _go_on(tp, span):
            return
        if way <= 0.0:
            return
