"""How far the machine has come along the planned path: the executing move, its target speed, and what starts and ends it.

Used by both ways to move along the path: advance (acceleration limited) and jerk (jerk limited).
"""

from libc.math cimport fmin
from libc.stdint cimport int64_t
from libc.string cimport memcpy

from emcmot.tp.follow cimport follows_position, follows_velocity, spindle_speed, waits_for_index
from emcmot.tp.model cimport AXES, CHAIN_WAITING, SPAN_BLEND, SPAN_CUBIC, Segment, Span, TpState
from emcmot.tp.path cimport body_left, feed_cap, feed_scale
from emcmot.tp.tap cimport tap
from emcmot.tp.tp cimport TP_FH_ENABLED


cdef inline Span* _span(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.spans[index & tp.span_mask]


cdef inline Segment* _seg(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.segs[index & tp.seg_mask]


cdef double reached(const TpState* tp, const Span* span) noexcept nogil:
    """Parameter of the segment, or of the blend, where the machine is on the active span."""
    return span.u0 + (span.h - tp.u if tp.reversing else tp.u)


cdef int64_t current_segment(const TpState* tp) noexcept nogil:
    """Index of the executing segment; seg_tail when there is none. A blend is half the one, half the other."""
    cdef const Span* span
    cdef int64_t index
    cdef double way
    if tp.active >= tp.span_tail:
        return tp.seg_built
    span = _span(tp, tp.active)
    if span.kind == SPAN_CUBIC:
        index = span.seg
        way = reached(tp, span)
        while index + 1 < tp.seg_built and _seg(tp, index + 1).begin > 0.0 and way >= _seg(tp, index + 1).begin:
            index += 1
        return index
    return span.seg - (span.kind == SPAN_BLEND and reached(tp, span) < span.trim)


cdef int64_t current_raw(const TpState* tp) noexcept nogil:
    """Index of the executing programmed move; raw_next when there is none. In a chord, by the share of its way."""
    cdef const Segment* seg
    cdef const Span* span
    cdef int64_t index
    cdef double way = 0.0, u
    cdef int k
    if tp.active >= tp.span_tail:
        return tp.raw_next
    index = current_segment(tp)
    seg = _seg(tp, index)
    if seg.raw_count == 1:
        return seg.raw_first
    span = _span(tp, tp.active)
    u = reached(tp, span)
    if span.kind == SPAN_CUBIC:
        u = (u - seg.begin) * seg.pace
    elif span.kind == SPAN_BLEND:
        u += seg.length - span.trim if index < span.seg else -span.trim
    for k in range(seg.raw_count):
        way += tp.raws[(seg.raw_first + k) & tp.raw_mask].length
        if way > u:
            return seg.raw_first + k
    return seg.raw_first + seg.raw_count - 1


cdef int64_t current_id(const TpState* tp) noexcept nogil:
    """Motion id of the executing move, 0 when there is none."""
    return tp.raws[current_raw(tp) & tp.raw_mask].id if tp.active < tp.span_tail else 0


cdef int holding(const TpState* tp) noexcept nogil:
    cdef const Segment* seg = _seg(tp, current_segment(tp))
    if tp.aborting:
        return 1
    if follows_position(seg) and tp.chain > CHAIN_WAITING:       # a thread goes on until its end
        return 0
    return tp.paused or tp.feed_inhibit or (tp.feed_hold and seg.enables & TP_FH_ENABLED)


cdef double target_w(TpState* tp) noexcept nogil:
    """The w that the active span should have now: hard limits, feed and overrides, holds, the spindle that it follows."""
    cdef const Segment* seg = _seg(tp, current_segment(tp))
    cdef double target, v
    if holding(tp):
        return 0.0
    target = feed_cap(tp, tp.active)
    if follows_position(seg) or follows_velocity(seg):
        v = spindle_speed(tp, seg) * (feed_scale(tp, seg) if seg.sync_velocity else 1.0)
        target = fmin(target, v * v)
    return target


cdef int waiting(TpState* tp) noexcept nogil:
    """Whether the current segment may not start yet; once started it is not asked again."""
    cdef int64_t index = current_segment(tp)
    cdef const Segment* seg = _seg(tp, index)
    if index < tp.started:
        return 0
    if seg.wait_spindles & ~tp.at_speed or (seg.indexer >= 0 and not tp.unlocked):
        return 1
    if follows_position(seg) and waits_for_index(tp, seg):
        return 1
    tp.started = index + 1
    return 0


cdef int next_span(TpState* tp, Span* span) noexcept nogil:
    """Go on to the next span; 0 where the path ends."""
    cdef const Span* following
    tp.w = 0.0 if span.stop else tp.w * span.ratio * span.ratio
    if tp.reversing and tp.active + 1 >= tp.span_tail:
        return 0
    if tp.active + 1 >= tp.span_tail and (body_left(tp) or tp.raw_next < tp.raw_tail or tp.seg_built < tp.seg_tail):
        tp.w = 0.0                                   # at the end of what is built so far, but not of the queue
        return 0
    tp.active += 1
    tp.u = 0.0
    if tp.active >= tp.span_tail:
        tp.w = 0.0
        span.stop = 1
        tp.seg_head = tp.seg_built
        return 0
    following = _span(tp, tp.active)
    tp.seg_head = following.seg - (following.kind == SPAN_BLEND)
    if tp.stepping and current_id(tp) != tp.step_id:
        tp.stepping = 0
        tp.paused = 1
    return 1


cdef void run_tap(TpState* tp, const Span* span) noexcept nogil:
    """One servo period of a rigid tap; it ends where it began."""
    cdef Segment* seg = _seg(tp, span.seg)
    if tap(tp, seg):
        memcpy(seg.end, seg.start, AXES * sizeof(double))
        tp.u = span.h
