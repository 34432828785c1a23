"""The planned path: makes spans of queued segments, and keeps the largest safe speed at the start of each span.

`extend` builds a bounded number of segments per servo period, so adding a segment to the queue costs only a copy.
`refresh` is the look-ahead: going back from the end of the built path, where the machine must be able to stop, it finds
for each span the largest w (`beta`) from which all that follows can be kept. A span whose answer does not depend on what
follows (`settled`) shields those before it, so each span is visited about twice, however far the machine looks ahead.
`refresh_some` does the same in the pieces that a period can bear: new path only raises what is safe, so what was found
before holds until the piece that is due gets there.
"""

from libc.math cimport INFINITY, ceil, fabs, fmax, fmin
from libc.stdint cimport int64_t

from emcmot.tp.corner cimport Corner, blend_derivatives, blend_spans, decide_corner
from emcmot.tp.follow cimport follows_position, follows_velocity
from emcmot.tp.geometry cimport derivatives, norm
from emcmot.tp.joints cimport Curve, add_joints
from emcmot.tp.limits cimport acceleration_range, entry_limit
from emcmot.tp.merge cimport take_segment
from emcmot.tp.model cimport AXES, BACK_RING, SPAN_CURVE, SPAN_BLEND, SPAN_LINE, UNIT_XYZ, Segment, Span, TpState
from emcmot.tp.spans cimport keep_derivatives, limit_speed, new_span
from emcmot.tp.tp cimport TP_AF_ENABLED, TP_ARC, TP_FS_ENABLED

cdef enum:
    STEPS_PER_PERIOD = 96        # a segment takes three: its corner, the blend before it, itself
    RAWS_PER_STEP = 4            # and one more for so many moves in a chord,
    BUILT_PER_STEP = 4           # and for so many spans
    SPANS_PER_STEP = 64          # spans that one step of building may add
    SPANS_PER_SWEEP = 512        # spans per period that a change of feed caps recomputes
    JOINT_HALVINGS = 8           # of a span, until
    SMALL_QUEUE = 128            # spans; up to this many the look-ahead is refreshed for every new one
    REFRESH_SHARE = 16           # longer ones: when this share of the path is new
    FRESH_SPANS = 256            # so many are looked at without need
    MOTION_TRAVERSE = 1

cdef double NO_WAY = 1e-14       # of the length of a move; spans shorter than this are left out
cdef double ARC_SPAN_ANGLE = 0.04
cdef double ARC_MISS = 1.75      # angle^2 times this: share of an acceleration that interpolation on an arc may miss
cdef double UNLIKE = 8.0         # accelerations of axes that arcs take into account in full
cdef double NO_TURN = 1e-6       # share of the curvature below which an axis counts as straight
cdef double JOINT_MISS = 0.02    # is all that it misses of an acceleration of a joint
cdef double ARC_BLEND_TIGHT = 0.98  # of blends with arcs, whose derivatives are not quite linear in u


cdef inline Span* _span(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.spans[index & tp.span_mask]


cdef inline Segment* _seg(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.segs[index & tp.seg_mask]


# --- caps -------------------------------------------------------------------------------------------------------------

cdef double feed_scale(const TpState* tp, const Segment* seg) noexcept nogil:
    """Share of the programmed speed that overrides leave, holds aside."""
    cdef double scale = 1.0
    if seg.enables & TP_FS_ENABLED:
        scale = tp.rapid_scale if seg.motion_type == MOTION_TRAVERSE else tp.feed_scale
    if seg.enables & TP_AF_ENABLED and seg.motion_type != MOTION_TRAVERSE:
        scale *= fabs(tp.adaptive_scale)
    return scale


cdef double feed(const TpState* tp, const Segment* seg) noexcept nogil:
    """Feed of a segment under the overrides of now."""
    cdef double v = seg.vel_max
    if not follows_position(seg) and not follows_velocity(seg):
        v = fmin(seg.vel * feed_scale(tp, seg), v)
    return fmin(v, tp.vel_limit) if seg.unit == UNIT_XYZ and tp.vel_limit > 0.0 else v


cdef double feed_cap(const TpState* tp, int64_t index) noexcept nogil:
    """Largest w of a span under its hard limits and the feed as overridden now."""
    cdef const Span* span = _span(tp, index)
    cdef double v = feed(tp, _seg(tp, span.seg)) / span.speed
    if span.kind == SPAN_BLEND:
        v = fmin(v, feed(tp, _seg(tp, span.seg - 1)) / span.speed_before)
    return fmin(v * v, span.cap)


cdef double full_cap(const TpState* tp, int64_t index) noexcept nogil:
    """The same without overrides."""
    cdef const Span* span = _span(tp, index)
    cdef const Segment* seg = _seg(tp, span.seg)
    return fmin((fmin(seg.vel, seg.vel_max) / span.speed) ** 2, span.cap)


# --- look-ahead -------------------------------------------------------------------------------------------------------

cdef double exit_limit(const TpState* tp, int64_t index) noexcept nogil:
    """Largest w at the end of a span, in its own u, from which what follows can be kept."""
    cdef const Span* span = _span(tp, index)
    if span.stop or index + 1 >= tp.span_tail:
        return 0.0
    return _span(tp, index + 1).beta / (span.ratio * span.ratio)


cdef void refresh(TpState* tp) noexcept nogil:
    """Recompute beta from the end of the path back to where nothing changes, all at once."""
    stop_looking(tp)
    _begin_looking(tp)
    _look_back(tp, tp.active)


cdef void refresh_some(TpState* tp) noexcept nogil:
    """The same, no further than what is left of this period's share of work; the next periods go on."""
    if tp.look_left <= 0:
        return
    tp.looking = min(tp.looking, tp.span_tail - 1)
    if tp.looking < 0:
        _begin_looking(tp)
    _look_back(tp, max(tp.active, tp.looking - tp.look_left))


cdef void stop_looking(TpState* tp) noexcept nogil:
    """Give up a look-ahead that is not done; the next one goes at least as far."""
    if tp.looking > tp.active:
        tp.new_spans = min(tp.new_spans, tp.looking + 1)
    tp.looking = -1


cdef void _begin_looking(TpState* tp) noexcept nogil:
    tp.looking = tp.span_tail - 1
    tp.looking_new = tp.new_spans
    tp.looking_settled = -1
    tp.new_spans = tp.span_tail


cdef int look_at(TpState* tp, int64_t index, int* shielded) noexcept nogil:
    """Find anew what is safe at the start of a span; whether that is something else now."""
    cdef Span* span = _span(tp, index)
    cdef double was = span.beta
    span.beta = entry_limit(span, tp.amax, feed_cap(tp, index), exit_limit(tp, index), shielded)
    return span.beta != was


cdef void look_ahead(TpState* tp) noexcept nogil:
    """Refresh the look-ahead when the next span's limit may still rise and enough of the path is new to be worth it.

    A path that is known far ahead asks for nothing, and grows; it is refreshed in pieces that a period can bear.
    """
    cdef int64_t fresh = tp.span_tail - tp.new_spans, known = tp.span_tail - tp.active
    cdef int wanted = tp.active + 1 >= tp.settled and (known < SMALL_QUEUE or fresh * REFRESH_SHARE >= known)
    if tp.looking >= 0 or fresh >= FRESH_SPANS or (fresh > 0 and wanted):
        refresh_some(tp)


cdef void _look_back(TpState* tp, int64_t stop) noexcept nogil:
    """Take the look-ahead back to the span after `stop`; its cursor becomes -1 where it is done."""
    cdef int shielded, unchanged = 0
    while tp.looking > stop:
        unchanged = not look_at(tp, tp.looking, &shielded) and tp.looking < tp.looking_new
        tp.look_left -= 1
        if unchanged:
            break
        if shielded and tp.looking_settled < 0:
            tp.looking_settled = tp.looking
        tp.looking -= 1
    if not unchanged and tp.looking > tp.active:
        return
    if tp.looking_settled >= 0:
        tp.settled = tp.looking_settled + 1
    elif tp.looking > tp.settled:
        tp.settled = tp.looking
    tp.looking = -1


cdef void _lower(TpState* tp) noexcept nogil:
    """The end of the path was changed: lower what it no longer bears; what may rise is left to the look-ahead."""
    cdef int64_t index = tp.span_tail - 1
    cdef int shielded
    cdef double beta
    cdef Span* span
    while index > tp.active:
        span = _span(tp, index)
        beta = entry_limit(span, tp.amax, feed_cap(tp, index), exit_limit(tp, index), &shielded)
        if index < tp.new_spans and beta >= span.beta:
            return
        span.beta = beta
        index -= 1


cdef void sweep_caps(TpState* tp) noexcept nogil:
    """After a change of feed caps: recompute beta of all spans, a bounded number of them per period."""
    cdef int64_t stop
    cdef int shielded
    if tp.sweep <= tp.active:
        if not tp.caps_changed:
            return
        tp.caps_changed = 0
        tp.sweep = tp.span_tail - 1
    tp.sweep = min(tp.sweep, tp.span_tail - 1)
    stop = max(tp.active, tp.sweep - SPANS_PER_SWEEP)
    while tp.sweep > stop:
        look_at(tp, tp.sweep, &shielded)
        tp.sweep -= 1


# --- building ---------------------------------------------------------------------------------------------------------

cdef int body_left(const TpState* tp) noexcept nogil:
    """Whether spans are missing of the last segment that has been begun."""
    return tp.seg_built > tp.seg_head and tp.body_end < tp.body_goal - NO_WAY * _seg(tp, tp.seg_built - 1).length


cdef void extend(TpState* tp) noexcept nogil:
    """Build spans of queued moves, as far as the ring of spans and this period's share of work allow.

    The end of the last segment is left unbuilt, and a run of short moves waits to become longer, until the machine would
    have to slow down for want of it.
    """
    cdef int steps = 0, urgent
    cdef int64_t last, spans
    while steps < STEPS_PER_PERIOD and tp.span_tail - tp.active + 2 * SPANS_PER_STEP + BACK_RING < tp.span_mask:
        if tp.seg_tail - tp.seg_head + 2 >= tp.seg_mask:
            return
        steps += 1
        last = tp.seg_built - 1
        spans = tp.span_tail
        urgent = tp.active + 1 >= min(tp.settled, tp.span_tail)
        if tp.seg_built == tp.seg_tail:
            steps += take_segment(tp, urgent) // RAWS_PER_STEP
        if last >= tp.seg_head and not tp.corner_known and tp.seg_built < tp.seg_tail:
            _plan_corner(tp, last)
        elif body_left(tp):
            if not tp.corner_known and not urgent:
                return
            _add_body(tp, last)
        elif tp.seg_built < tp.seg_tail:
            _start_segment(tp, tp.seg_built)
        else:
            return
        if tp.span_tail > spans:
            steps += (tp.span_tail - spans) // BUILT_PER_STEP


cdef void _plan_corner(TpState* tp, int64_t last) noexcept nogil:
    """Decide the corner at the end of segment `last`, and how far its own spans reach."""
    cdef Segment* a = _seg(tp, last)
    cdef Segment* b = _seg(tp, last + 1)
    cdef Corner corner
    if tp.body_end >= a.length * (1.0 - NO_WAY):
        _reopen(tp, last)
        return
    corner = decide_corner(tp, a, b, a.length - fmax(tp.body_end, a.trim_start))
    _set_corner(tp, last, corner)


cdef void _set_corner(TpState* tp, int64_t last, Corner corner) noexcept nogil:
    cdef Segment* a = _seg(tp, last)
    cdef Segment* b = _seg(tp, last + 1)
    a.trim_end = corner.trim
    a.exit_stop = corner.stop
    a.exit_ratio = corner.ratio
    b.trim_start = corner.ratio * corner.trim
    tp.body_goal = a.length - corner.trim
    tp.corner_known = 1


cdef void _reopen(TpState* tp, int64_t last) noexcept nogil:
    """The path was built to the end of `last`, and now goes on: put a blend there if the machine can still take it."""
    cdef Segment* a = _seg(tp, last)
    cdef Segment* b = _seg(tp, last + 1)
    cdef Corner corner
    cdef double room = a.length - a.trim_start
    cdef const Span* span
    if tp.active < tp.span_tail:
        span = _span(tp, tp.active)
        if span.seg == last and span.kind != SPAN_BLEND:
            room = fmax(0.0, a.length - span.u0 - tp.u)
    else:
        room = 0.0
    corner = decide_corner(tp, a, b, 0.99 * room)
    _set_corner(tp, last, corner)
    if corner.trim == 0.0:
        tp.new_spans = min(tp.new_spans, tp.span_tail - 1)
        return
    _cut_body(tp, last, tp.body_goal)
    _start_segment(tp, last + 1)
    if body_left(tp):
        _add_body(tp, last + 1)
    _lower(tp)
    if _active_fits(tp):
        return
    while tp.span_tail > tp.active + 1 and _span(tp, tp.span_tail - 1).seg == last + 1:
        tp.span_tail -= 1
    corner.trim = 0.0
    corner.stop = 1
    _set_corner(tp, last, corner)
    tp.seg_built = last + 1
    span = _span(tp, tp.span_tail - 1)
    tp.body_end = a.trim_start if span.kind == SPAN_BLEND else span.u0 + span.h
    while body_left(tp):
        _add_body(tp, last)
    refresh(tp)


cdef void _cut_body(TpState* tp, int64_t last, double end) noexcept nogil:
    """Let the spans of segment `last` end at u = `end`."""
    cdef Span* span = _span(tp, tp.span_tail - 1)
    while tp.span_tail - 1 > tp.active and span.seg == last and span.kind != SPAN_BLEND and span.u0 >= end - NO_WAY * _seg(tp, last).length:
        tp.span_tail -= 1
        span = _span(tp, tp.span_tail - 1)
    if span.seg == last and span.kind != SPAN_BLEND:
        span.h = end - span.u0
        _limit_body(tp, _seg(tp, last), span)
    tp.body_end = end
    tp.held_span = -1
    tp.new_spans = min(tp.new_spans, tp.span_tail - 1)
    tp.settled = min(tp.settled, tp.new_spans)


cdef int _active_fits(const TpState* tp) noexcept nogil:
    """Whether the present speed can still keep all limits ahead."""
    cdef const Span* span = _span(tp, tp.active)
    cdef double x = span.h - tp.u, limit = exit_limit(tp, tp.active), low, high
    if span.kind == SPAN_LINE:
        return tp.w <= (limit + 2.0 * span.acc * x) * (1.0 + 1e-9)
    acceleration_range(span, tp.amax, tp.u, tp.w, &low, &high)
    return tp.w + 2.0 * x * low <= limit * (1.0 + 1e-9)


cdef void _start_segment(TpState* tp, int64_t index) noexcept nogil:
    """Join segment `index` to the end of the path: the blend before it, or the tangent joint, or the stop."""
    cdef Segment* b = _seg(tp, index)
    cdef Segment* a = _seg(tp, index - 1)
    if index > tp.seg_head and a.trim_end > 0.0:
        _add_blend(tp, index)
    elif tp.span_tail > tp.active:
        _span(tp, tp.span_tail - 1).stop = a.exit_stop
        _span(tp, tp.span_tail - 1).ratio = a.exit_ratio
    tp.seg_built = index + 1
    tp.body_end = b.trim_start
    tp.body_goal = b.length
    tp.corner_known = 0


cdef void _add_body(TpState* tp, int64_t index) noexcept nogil:
    """Spans of the segment itself, from body_end on; long arcs come in several steps."""
    cdef Segment* seg = _seg(tp, index)
    cdef Span* span
    cdef double way = tp.body_goal - tp.body_end, h = way, pieces
    cdef int kind = SPAN_LINE, count, k
    if seg.kind == TP_ARC or tp.inverse != NULL:
        kind = SPAN_CURVE
        h = fmin(h, fmax(4.0 * tp.dt * seg.vel_max, _braking_way(tp, seg)))
    if seg.kind == TP_ARC:
        h = fmin(h, ARC_SPAN_ANGLE / fabs(seg.omega))
    if tp.inverse != NULL:
        h = _joint_way(tp, seg, index, h)
    pieces = fmax(ceil(way / h), 1.0)
    count = <int>fmin(pieces, SPANS_PER_STEP)
    h = way / pieces
    for k in range(count):
        span = new_span(tp, kind, index, tp.body_end + k * h, h)
        _limit_body(tp, seg, span)
    tp.body_end = tp.body_goal if count >= pieces else tp.body_end + count * h


cdef double _joint_way(TpState* tp, const Segment* seg, int64_t index, double h) noexcept nogil:
    """Length of spans, `h` at most, in which the joints' derivatives change little."""
    cdef Span* span
    cdef int step
    for step in range(JOINT_HALVINGS):
        span = new_span(tp, SPAN_CURVE, index, tp.body_end, h)
        _limit_body(tp, seg, span)
        tp.span_tail -= 1
        if span.tight >= 1.0 - JOINT_MISS:
            break
        h *= 0.5
    return h


cdef double _braking_way(const TpState* tp, const Segment* seg) noexcept nogil:
    """A fifth of the way that stopping takes: spans of this length lose next to nothing of the acceleration."""
    return 0.1 * seg.vel_max * seg.vel_max / fmax(tp.amax[0], fmax(tp.amax[1], tp.amax[2]))


cdef void _limit_body(TpState* tp, const Segment* seg, Span* span) noexcept nogil:
    """Limits of a span of a line or an arc."""
    cdef double dq0[AXES]
    cdef double dq1[AXES]
    cdef double ddq0[AXES]
    cdef double ddq1[AXES]
    cdef double angle
    cdef Curve curve
    cdef int i
    if seg.acc > 0.0:
        span.acc = seg.acc
    derivatives(seg, span.u0, dq0, ddq0)
    if span.kind == SPAN_LINE:
        for i in range(AXES):
            if dq0[i] != 0.0:
                span.acc = fmin(span.acc, tp.amax[i] / fabs(dq0[i]))
        limit_speed(tp, span, dq0, dq0, seg.vel_max, seg.unit)
        return
    angle = fabs(seg.omega) * span.h
    span.tight = 1.0 - ARC_MISS * angle * angle
    derivatives(seg, span.u0 + span.h, dq1, ddq1)
    limit_speed(tp, span, dq0, dq1, seg.vel_max, seg.unit)
    keep_derivatives(span, dq0, dq1, ddq0, ddq1)
    if tp.inverse != NULL:
        curve.cubic = NULL
        curve.before = NULL
        curve.seg = seg
        curve.trim = 0.0
        curve.length = seg.length
        add_joints(tp, &curve, span)
    _bound_curve(tp, span)


cdef void _bound_curve(const TpState* tp, Span* span) noexcept nogil:
    """Bounds by the weakest of the axes that turn: linear interpolation bears no more than UNLIKE times its acceleration."""
    cdef double weakest = INFINITY, turning = 0.0, turn
    cdef int j
    for j in range(span.n):
        turning = fmax(turning, fmax(fabs(span.ddq0[j]), fabs(span.ddq1[j])))
    for j in range(span.n):
        turn = fmax(fabs(span.ddq0[j]), fabs(span.ddq1[j]))
        if turn > NO_TURN * turning:
            weakest = fmin(weakest, tp.amax[span.axis[j]])
    span.acc = fmin(span.acc, UNLIKE * weakest)
    if turning > 0.0:
        span.cap = fmin(span.cap, UNLIKE * weakest / turning)


cdef void _add_blend(TpState* tp, int64_t index) noexcept nogil:
    """Spans of the corner between segments `index - 1` and `index`."""
    cdef Segment* a = _seg(tp, index - 1)
    cdef Segment* b = _seg(tp, index)
    cdef Corner corner
    cdef Curve curve
    cdef Span* span = NULL
    cdef double dq[2][AXES]
    cdef double ddq[2][AXES]
    cdef double h
    cdef int count, k, now, then
    corner.stop = 0
    corner.trim = a.trim_end
    corner.ratio = a.exit_ratio
    count = blend_spans(a, b, &corner)
    h = 2.0 * corner.trim / count
    curve.cubic = NULL
    curve.before = a
    curve.seg = b
    curve.trim = corner.trim
    curve.length = 2.0 * corner.trim
    blend_derivatives(a, b, &corner, 0.0, dq[0], ddq[0])
    for k in range(count):
        now, then = k & 1, 1 - (k & 1)
        span = new_span(tp, SPAN_BLEND, index, k * h, h)
        blend_derivatives(a, b, &corner, (k + 1) * h, dq[then], ddq[then])
        span.trim = corner.trim
        if a.kind == TP_ARC or b.kind == TP_ARC:
            span.tight = ARC_BLEND_TIGHT
        limit_speed(tp, span, dq[now], dq[then], b.vel_max, b.unit)
        span.speed_before = fmax(norm(dq[now], a.unit), norm(dq[then], a.unit))
        span.cap = fmin(span.cap, (a.vel_max / span.speed_before) ** 2)
        keep_derivatives(span, dq[now], dq[then], ddq[now], ddq[then])
        if tp.inverse != NULL:
            add_joints(tp, &curve, span)
        if span.tight < 1.0:
            _bound_curve(tp, span)
    span.ratio = corner.ratio
