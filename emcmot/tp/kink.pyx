"""Kinks: the path where jerk is limited, as a polyline whose changes of direction are spread over hats.

The second derivative of a polyline is a pulse at each corner, the change of direction there. Here each pulse becomes a
hat, a triangle of the same area and with the same centre of gravity: so the path is the polyline itself outside of the hats, its
second derivative is continuous and linear between their ends and tops, and the path is cubic there. Hats may
overlap; what they do adds up. In the middle of a hat of half-width d the path is d / 6 times the change of direction from
the corner, and less by the cube of the distance from there on: that makes the widths from the tolerance.

An arc, or a run of short moves, is a polyline as well, whose kinks and hats are those of a cubic spline (arcs, fit). The chain of moves
from one stop to the next has one parameter, the *way*. Called by smooth.
"""

from libc.math cimport INFINITY, fabs
from libc.stdint cimport int64_t

from emcmot.tp.geometry cimport length
from emcmot.tp.model cimport AXES, KINKS, Kink, TpState

cdef enum:
    NARROWINGS = 64

cdef double NARROWER = 0.93
cdef double SAME_PLACE = 1e-10   # of the way


cdef inline const Kink* _kink(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.kinks[index % KINKS]


cdef inline int _behind(const Kink* kink, double way, Side side) noexcept nogil:
    """Whether the hat lies wholly before the way."""
    return way > kink.to or (way == kink.to and not (side == SIDE_BEFORE and kink.middle == kink.to))


cdef inline int _ahead(const Kink* kink, double way, Side side) noexcept nogil:
    return way < kink.start or (way == kink.start and not (side == SIDE_BEHIND and kink.middle == kink.start))


cdef void path_at(const TpState* tp, double way, Side side, double* q, double* dq, double* ddq) noexcept nogil:
    """Position, and first and second derivative by the way. `side` counts only where a chain begins or ends on an arc."""
    cdef const Kink* kink
    cdef int64_t line = tp.kink_head, k
    cdef double bend, turned, moved, height, x
    cdef int i
    while line + 1 < tp.kink_tail and _kink(tp, line + 1).place <= way:
        line += 1
    kink = _kink(tp, line)
    for i in range(AXES):
        q[i] = kink.vertex[i] + kink.out[i] * (way - kink.place)
        dq[i] = kink.out[i]
        ddq[i] = 0.0
    for k in range(tp.kink_head, tp.kink_tail):
        kink = _kink(tp, k)
        if _behind(kink, way, side):
            if k <= line:
                continue
            bend, turned, moved = 0.0, 1.0, way - kink.place
        elif _ahead(kink, way, side):
            if k > line:
                continue
            bend, turned, moved = 0.0, -1.0, kink.place - way
        else:
            height = 2.0 / (kink.to - kink.start)
            if way < kink.middle or kink.middle == kink.to:
                x = way - kink.start
                bend = height * x / (kink.middle - kink.start)
                turned = 0.5 * bend * x - (k <= line)
                moved = bend * x * x / 6.0 - (way - kink.place) * (k <= line)
            else:
                x = kink.to - way
                bend = height * x / (kink.to - kink.middle)
                turned = (k > line) - 0.5 * bend * x
                moved = bend * x * x / 6.0 + (way - kink.place) * (k > line)
        for i in range(AXES):
            q[i] += kink.turn[i] * moved
            dq[i] += kink.turn[i] * turned
            ddq[i] += kink.turn[i] * bend


cdef void add_kink(TpState* tp, const Kink* kink) noexcept nogil:
    tp.kinks[tp.kink_tail % KINKS] = kink[0]
    tp.kink_tail += 1


cdef void forget_passed(TpState* tp) noexcept nogil:
    """Drop the kinks that no longer count where the path goes on."""
    while tp.kink_head + 1 < tp.kink_tail:
        if _kink(tp, tp.kink_head).to > tp.body_end or _kink(tp, tp.kink_head + 1).place > tp.body_end:
            return
        tp.kink_head += 1


cdef double next_node(const TpState* tp, double limit) noexcept nogil:
    """Next place, up to `limit`, where the third derivative changes."""
    cdef const Kink* kink
    cdef double least = tp.body_end + SAME_PLACE, node = limit
    cdef int64_t k
    for k in range(tp.kink_head, tp.kink_tail):
        kink = _kink(tp, k)
        if least < kink.start < node:
            node = kink.start
        if least < kink.middle < node:
            node = kink.middle
        if least < kink.to < node:
            node = kink.to
    return node


# --- the size of corners ----------------------------------------------------------------------------------------------

cdef double hat_off(double turn, double half, double away) noexcept nogil:
    """How far a hat of this half-width takes the path from the polyline, `away` from its corner."""
    cdef double rest = 1.0 - fabs(away) / half
    return turn * half * rest * rest * rest / 6.0 if rest > 0.0 else 0.0


cdef void taken(const TpState* tp, double place, double* off) noexcept nogil:
    """How far the corners before take the path from the polyline at a place."""
    cdef const Kink* kink
    cdef int64_t k
    cdef int i
    for i in range(AXES):
        off[i] = 0.0
    for k in range(tp.kink_head, tp.kink_tail):
        kink = _kink(tp, k)
        if kink.sharpness > 0.0 and kink.to > place:
            for i in range(AXES):
                off[i] += hat_off(kink.turn[i], kink.to - kink.place, place - kink.place)


cdef double reach_back(const TpState* tp, int count) noexcept nogil:
    """Way back over `count` corners; without limit where there are less."""
    cdef int64_t k = tp.kink_tail - 1
    while k >= tp.kink_head:
        if _kink(tp, k).sharpness > 0.0:
            if count == 0:
                return tp.corner.place - _kink(tp, k).place
            count -= 1
        k -= 1
    return INFINITY


cdef int _spares(const TpState* tp, const Kink* corner, double half) noexcept nogil:
    """Whether the corners before keep their tolerance with this one."""
    cdef const Kink* kink
    cdef double off[AXES]
    cdef int64_t k
    cdef int i
    for k in range(tp.kink_head, tp.kink_tail):
        kink = _kink(tp, k)
        if kink.sharpness > 0.0 and kink.place > corner.place - half:
            for i in range(AXES):
                off[i] = kink.off[i] + hat_off(corner.turn[i], half, corner.place - kink.place)
            if length(off) > kink.tolerance:
                return 0
    return 1


cdef void size_corner(TpState* tp, Kink* corner, double tolerance, double widest) noexcept nogil:
    """Spread a corner over a hat of half-width `widest` at most, so that it and the corners before keep the tolerance."""
    cdef double half = widest
    cdef Kink* kink
    cdef int64_t k
    cdef int i
    for i in range(NARROWINGS):
        taken(tp, corner.place, corner.off)
        for k in range(AXES):
            corner.off[k] += hat_off(corner.turn[k], half, 0.0)
        if length(corner.off) <= tolerance and _spares(tp, corner, half):
            break
        half *= NARROWER
    else:
        half = 0.0
    corner.start = corner.place - half
    corner.middle = corner.place
    corner.to = corner.place + half
    corner.tolerance = tolerance
    if half == 0.0:
        return
    for k in range(tp.kink_head, tp.kink_tail):
        kink = &tp.kinks[k % KINKS]
        if kink.sharpness > 0.0:
            for i in range(AXES):
                kink.off[i] += hat_off(corner.turn[i], half, corner.place - kink.place)
