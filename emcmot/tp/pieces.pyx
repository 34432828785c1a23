"""How long the spans are where jerk is limited: short in time, and shorter where the machine is about to stand or to turn.

On a span the speed plan has one value of d2w/du2, so spans are as long as an acceleration takes to come, or a part of that. About a
standstill, and about a corner that is passed slowly, they are much shorter, and grow with the time since then.
Called by smooth.
"""

from libc.math cimport INFINITY, cbrt, fabs, fmax, fmin, sqrt
from libc.stdint cimport int64_t

from emcmot.tp.cubic cimport corner_speed
from emcmot.tp.model cimport AXES, END_CORNER, END_OPEN, END_STOP, KINKS, Kink, Segment, Span, TpState

cdef enum:
    NEWTON_STEPS = 5

cdef double PIECE = 0.25             # longest span, of the time in which the acceleration comes and goes,
cdef double LEAST_PERIODS = 3.0      # periods; and this at least
cdef double FIRST_PERIODS = 2.0      # of the span about a standstill
cdef double GROWTH = 0.5             # of the time since then, or until then, at most
cdef double SPEED_RESERVE = 1.2         # corners are made for the programmed speed times this
cdef double SAME_PLACE = 1e-9        # of the way
cdef double STANDING = 1e-8          # square of a derivative by the way that has no direction: the path turns back there


cdef double _way_in(double v, double push, double jerk, double time) noexcept nogil:
    """Way that a time from a place of speed v takes, speeding up from there."""
    cdef double grown = fmin(time, push / jerk), rest = time - grown
    return v * time + jerk * grown * grown * (grown / 6.0 + 0.5 * rest) + 0.5 * push * rest * rest


cdef double _time_for(double v, double push, double jerk, double way) noexcept nogil:
    """The inverse of that."""
    cdef double time = cbrt(6.0 * way / jerk), grown
    cdef int k
    if time > push / jerk:
        time = push / jerk + sqrt(2.0 * way / push)
    if v > 0.0:
        time = fmin(time, way / v)
    for k in range(NEWTON_STEPS):
        grown = fmin(time, push / jerk)
        time -= (_way_in(v, push, jerk, time) - way) / (v + jerk * grown * (0.5 * grown + time - grown) + SAME_PLACE)
        time = fmax(0.0, time)
    return time


cdef double piece(const TpState* tp, const Segment* seg, double begin, double way) noexcept nogil:
    """Length of the next span, `way` at most: short in time, also where the machine is about to stand or turn."""
    cdef double push = INFINITY, jerk = INFINITY, speed = SPEED_RESERVE * fmin(seg.vel, seg.vel_max) / seg.pace
    cdef double step, h, time, rate, slow = 0.0, left = INFINITY
    cdef int i
    for i in range(AXES):
        rate = fabs(tp.node[1][i])
        if rate > 0.0:
            push = fmin(push, tp.amax[i] / rate)
            jerk = fmin(jerk, tp.jmax[i] / rate)
    jerk = fmin(jerk, push / tp.dt)
    step = fmax(LEAST_PERIODS * tp.dt, PIECE * push / jerk)
    time = _time_for(tp.slow_speed, push, jerk, begin - tp.slow_place)
    time += _grown(tp, step, time + sqrt(2.0 * tp.slow_speed / jerk))
    h = fmin(step * speed, _way_in(tp.slow_speed, push, jerk, time) - (begin - tp.slow_place))
    if tp.end == END_STOP or (tp.end == END_OPEN and tp.seg_built == tp.seg_tail):
        left = tp.body_goal - begin
    rate = _next_corner_speed(tp, begin + way)
    if rate < speed and way < left:
        left = way
        slow = rate
    if left < INFINITY:
        time = _time_for(slow, push, jerk, left)
        time -= fmin(time, _grown(tp, step, (time + sqrt(2.0 * slow / jerk)) / (1.0 + GROWTH)))
        if time > FIRST_PERIODS * tp.dt * GROWTH:
            h = fmin(h, left - _way_in(slow, push, jerk, time))
    h = fmax(h, jerk * (FIRST_PERIODS * tp.dt) ** 3 / 6.0)
    return way if h >= way else h


cdef double _grown(const TpState* tp, double most, double time) noexcept nogil:
    """Time of a span that begins so long after a slow place."""
    return fmax(FIRST_PERIODS * tp.dt, fmin(most, GROWTH * time))


cdef double turn(const Span* span) noexcept nogil:
    """Change of the direction on a span, to its middle and from there on, of its length."""
    cdef double first = 0.0, second = 0.0, before = STANDING, between = STANDING, behind = STANDING, middle
    cdef int j
    for j in range(span.n):
        if span.axis[j] < AXES:
            middle = span.dq0[j] + 0.125 * span.h * (3.0 * span.ddq0[j] + span.ddq1[j])
            first += (middle - span.dq0[j]) ** 2
            second += (span.dq1[j] - middle) ** 2
            before += span.dq0[j] ** 2
            between += middle ** 2
            behind += span.dq1[j] ** 2
    return (sqrt(first) + sqrt(second)) / sqrt(fmax(between, fmax(before, behind)))


cdef double _next_corner_speed(const TpState* tp, double place) noexcept nogil:
    """Speed of a corner whose hat begins at a place."""
    cdef const Kink* kink
    cdef double speed = INFINITY
    cdef int64_t k
    if tp.end == END_CORNER and tp.corner.start <= place + SAME_PLACE and tp.corner.sharpness > 0.0:
        speed = corner_speed(tp, tp.corner.turn, tp.corner.to - tp.corner.place)
    for k in range(tp.kink_head, tp.kink_tail):
        kink = &tp.kinks[k % KINKS]
        if kink.sharpness > 0.0 and fabs(kink.start - place) <= SAME_PLACE:
            speed = fmin(speed, corner_speed(tp, kink.turn, kink.to - kink.place))
    return speed
