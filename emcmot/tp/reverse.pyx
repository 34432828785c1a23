"""Reverse run: back along the path that was executed, as far as the rings still hold it, and forwards again.

Limits of velocity and acceleration are the same in both directions of time. So a span that is run from its end to its
start has the limits of its mirror image, whose u counts from the end: first derivatives change sign and both ends change
places. To turn back, the executed spans are mirrored into a ring of their own, the newest first, and the planner works on that ring
as on any other path: look-ahead, overrides, pause, step and abort are those of the forward run. To turn forward, the
ring of the planned path is put back, with the place in it. Both happen at rest; tp asks for them.
"""

from libc.math cimport fmax, fmin
from libc.stdint cimport int64_t

from emcmot.tp.interior cimport forget_plan
from emcmot.tp.model cimport AXES, BACK_RING, SPAN_BLEND, Segment, Span, TpState
from emcmot.tp.path cimport look_at, refresh, stop_looking
from emcmot.tp.tp cimport TP_TAP

cdef enum:
    MOTION_TOOL_CHANGE = 4
    RAWS_IN_WORK = 2             # slots of the ring of raws that tp_add prepares


cdef inline Span* _span(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.spans[index & tp.span_mask]


cdef inline Segment* _seg(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.segs[index & tp.seg_mask]


cdef int turn_back(TpState* tp) noexcept nogil:
    """Make the executed path the path ahead; 0 where there is none to go back on. At rest only."""
    cdef int64_t newest = min(tp.active, tp.span_tail - 1)
    cdef double u = tp.u if tp.active < tp.span_tail else _span(tp, newest).h
    cdef int count = _kept(tp, newest), k
    if count == 0:
        return 0
    for k in range(count):
        _mirror(tp, newest - k, &tp.back_spans[k], k == count - 1)
    stop_looking(tp)
    tp.ahead_spans = tp.spans
    tp.ahead_mask = tp.span_mask
    tp.ahead_active = tp.active
    tp.ahead_tail = tp.span_tail
    tp.ahead_settled = tp.settled
    tp.ahead_new = tp.new_spans
    tp.turned_at = newest
    tp.spans = tp.back_spans
    tp.span_mask = BACK_RING - 1
    tp.span_tail = count
    tp.settled = tp.new_spans = 0
    tp.reversing = 1
    _place(tp, 0, u)
    if not tp.smooth:
        refresh(tp)
    return 1


cdef void turn_forward(TpState* tp) noexcept nogil:
    """Put the planned path back, and look ahead over what lies again before the machine. At rest only."""
    cdef int64_t index = tp.turned_at - tp.active, k
    cdef double u = tp.u
    cdef int shielded
    tp.spans = tp.ahead_spans
    tp.span_mask = tp.ahead_mask
    tp.span_tail = tp.ahead_tail
    tp.settled = tp.ahead_settled
    tp.new_spans = tp.ahead_new
    tp.reversing = 0
    _place(tp, index, u)
    k = min(tp.ahead_active, tp.span_tail - 1)
    while k > index and not tp.smooth:
        look_at(tp, k, &shielded)
        k -= 1


cdef void _place(TpState* tp, int64_t index, double u) noexcept nogil:
    """Stand on span `index`, where its mirror image has the parameter `u`."""
    cdef const Span* span = _span(tp, index)
    tp.active = index
    tp.u = fmax(0.0, fmin(span.h, span.h - u))
    tp.w = 0.0
    tp.seg_head = _first_segment(span)
    tp.held_span = tp.sweep = -1
    tp.caps_changed = 1
    tp.hungry = 1
    forget_plan(tp)


cdef inline int64_t _first_segment(const Span* span) noexcept nogil:
    return span.seg - (span.kind == SPAN_BLEND)


cdef int _kept(const TpState* tp, int64_t newest) noexcept nogil:
    """How many spans from `newest` backwards can be run back: whole in the rings, of moves that may be run back."""
    cdef int64_t oldest = max(tp.history, tp.span_tail - tp.span_mask)
    cdef int64_t raws_needed = tp.segs[tp.seg_head & tp.seg_mask].raw_first if tp.seg_head < tp.seg_tail else tp.raw_next
    cdef int64_t oldest_raw = raws_needed + tp.capacity + RAWS_IN_WORK - tp.raw_mask
    cdef int64_t seg
    cdef const Span* span
    cdef int count = 0
    while count < BACK_RING and newest - count >= oldest:
        span = _span(tp, newest - count)
        seg = _first_segment(span)
        if seg <= tp.seg_tail - tp.seg_mask or _seg(tp, seg).raw_first < oldest_raw:
            break
        if not _may_go_back(_seg(tp, seg)) or not _may_go_back(_seg(tp, span.seg)):
            break
        count += 1
    return count


cdef inline int _may_go_back(const Segment* seg) noexcept nogil:
    """Not what a spindle leads, nor probes, tool changes and locked rotary moves."""
    return seg.kind != TP_TAP and seg.spindle < 0 and seg.motion_type < MOTION_TOOL_CHANGE


cdef void _mirror(const TpState* tp, int64_t index, Span* image, int last) noexcept nogil:
    """Span `index` as it is run from its end to its start, on to the span before it, or to the end of the way back."""
    cdef const Span* span = _span(tp, index)
    cdef int j
    image[0] = span[0]
    image.stop = 1 if last else _span(tp, index - 1).stop
    image.ratio = 1.0 if last else 1.0 / _span(tp, index - 1).ratio
    for j in range(span.n):
        image.dq0[j] = -span.dq1[j]
        image.dq1[j] = -span.dq0[j]
        image.ddq0[j] = span.ddq1[j]
        image.ddq1[j] = span.ddq0[j]
    for j in range(AXES):
        image.q0[j] = span.q1[j]
        image.q1[j] = span.q0[j]
