"""Rigid tapping: in with the spindle, out with the spindle, back to the start.

The tool goes along a straight move and back, led by the spindle's revolutions all the time. At the bottom the planner
asks for the reversed spindle (`wants_reverse`) and follows it while it slows down, past the programmed depth, and turns
back; at the top it asks for the first direction again, follows until the spindle has turned back, and goes to the start.
The way s along the tap and its speed v are of their own, because they run both ways and beyond the ends.
Called by advance while such a move executes.
"""

from libc.math cimport INFINITY, fabs, fmax, fmin, sqrt

from emcmot.tp.model cimport AXES, CHAIN_ACCELERATING, CHAIN_FOLLOWING, Segment, TpState
from emcmot.tp.model cimport TAP_IN, TAP_LEAVE, TAP_NONE, TAP_OUT, TAP_PLACE

cdef double DECAY = 0.1          # share of the position error that one servo period corrects


cdef int at_rest(const TpState* tp) noexcept nogil:
    """Whether the machine stands, tapping or not."""
    return tp.w == 0.0 and tp.tap_v == 0.0


cdef int tap(TpState* tp, const Segment* seg) noexcept nogil:
    """One servo period of the tap `seg`; 1 when it is over and the tool is back at the start."""
    cdef double a = _acceleration(tp, seg), v
    if tp.tap_phase == TAP_NONE:
        tp.tap_phase = TAP_IN
        tp.tap_s = tp.tap_v = 0.0
        tp.tap_direction = 1.0 if tp.spindle_rps[seg.spindle] >= 0.0 else -1.0
    if tp.aborting:
        v = 0.0
    elif tp.tap_phase == TAP_PLACE:
        v = _towards_start(tp, a)
        if v < 0.0:
            tp.tap_phase = TAP_NONE
            tp.tap_v = tp.tap_s = 0.0
            return 1
    else:
        v = _led_by_spindle(tp, seg, a)
    v = fmax(-seg.vel_max, fmin(seg.vel_max, v))
    v = fmax(tp.tap_v - a * tp.dt, fmin(tp.tap_v + a * tp.dt, v))
    tp.tap_s += 0.5 * (tp.tap_v + v) * tp.dt
    tp.tap_v = v
    _next_phase(tp, seg)
    return 0


cdef void _next_phase(TpState* tp, const Segment* seg) noexcept nogil:
    cdef double turning = tp.spindle_rps[seg.spindle] * tp.tap_direction
    if tp.tap_phase == TAP_IN and tp.tap_s >= seg.length:
        tp.tap_phase = TAP_OUT
    elif tp.tap_phase == TAP_OUT and tp.tap_s <= 0.0 and turning < 0.0:
        tp.tap_phase = TAP_LEAVE
    elif tp.tap_phase == TAP_LEAVE and turning >= 0.0 and tp.tap_v >= 0.0:
        tp.tap_phase = TAP_PLACE


cdef double _led_by_spindle(TpState* tp, const Segment* seg, double a) noexcept nogil:
    """Speed that keeps the way at the spindle's revolutions."""
    cdef double speed = tp.spindle_rps[seg.spindle] * tp.tap_direction * seg.sync_revs
    cdef double way = tp.spindle_revs[seg.spindle] * tp.tap_direction * seg.sync_revs
    cdef double error, correction
    if tp.chain == CHAIN_ACCELERATING:
        if tp.tap_v < speed * (1.0 - 1e-9):
            return speed
        tp.chain = CHAIN_FOLLOWING
        tp.chain_origin = way - tp.tap_s
    error = way - tp.chain_origin - tp.tap_s
    correction = fmin(DECAY * fabs(error) / tp.dt, sqrt(0.5 * a * fabs(error)))
    return speed + (correction if error > 0.0 else -correction)


cdef double _towards_start(const TpState* tp, double a) noexcept nogil:
    """Speed that ends at the start of the tap at rest; negative: there within this period."""
    cdef double way = -tp.tap_s, step = a * tp.dt
    cdef double square = 0.25 * step * step + 2.0 * a * way - step * tp.tap_v
    return sqrt(square) - 0.5 * step if square >= 0.25 * step * step else -1.0


cdef double _acceleration(const TpState* tp, const Segment* seg) noexcept nogil:
    cdef double a = INFINITY
    cdef int i
    for i in range(AXES):
        if seg.rate[i] != 0.0:
            a = fmin(a, tp.amax[i] / fabs(seg.rate[i]))
    return a
