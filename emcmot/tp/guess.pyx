"""The first guess of a speed plan, from which interior finds the best.

It is about right, and may break limits: under the largest speed of each span, speeding up and slowing down gently, spread over
the way that an acceleration needs to come. Where a plan is in force already, it turns into the guess little by little.
Called by interior; says for it and for equations which coefficients are those of a standstill, and how fast a span may be.
"""

from libc.math cimport INFINITY, cbrt, fmax, fmin, sqrt
from libc.stdint cimport int64_t

from emcmot.tp.follow cimport follows_position, follows_velocity
from emcmot.tp.model cimport Cell, Improvement, Segment, Span, TpState
from emcmot.tp.path cimport feed_cap, full_cap
from emcmot.tp.profile cimport crawl, creeps, ends_at_rest, starts_at_rest

cdef double SLOWEST = 0.01       # of the w that is programmed; slower overrides lower the rate only
cdef double ROOM = 0.0006        # over the w of the feed: plans keep below their caps by about that
cdef double LEAD_ROOM = 1.05     # over the speed that a spindle asks for
cdef double GUESS_PUSH = 0.5     # of acceleration and jerk
cdef double GUESS_SHARE = 0.8    # of w
cdef double SPREAD = 0.3         # of the square of the way that an acceleration needs to come;
cdef double FARTHEST = 9.0       # squares of the neighbours' lengths at most
cdef double RAGGED = 20.0        # of the speed at which a span is passed in the time in which jerk brings it


cdef inline const Span* _span(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.spans[index & tp.span_mask]


cdef inline Cell* _cell(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.cells[index & tp.cell_mask]


cdef int fixed(const TpState* tp, int64_t index) noexcept nogil:
    """Whether a coefficient is that of a standstill."""
    if ends_at_rest(tp, index, tp.improvement.end):
        return 1
    if tp.improvement.first == tp.improvement.origin == index:
        return tp.u == 0.0 and (starts_at_rest(tp, index) or not creeps(tp, index))
    return starts_at_rest(tp, index)


cdef double plan_cap(const TpState* tp, int64_t index) noexcept nogil:
    """Largest w of a span: that of the plan in force stays possible."""
    cdef const Span* span = _span(tp, index)
    cdef const Segment* seg = &tp.segs[span.seg & tp.seg_mask]
    cdef double cap = (1.0 + ROOM) * fmax(feed_cap(tp, index), SLOWEST * full_cap(tp, index))
    if follows_position(seg) or follows_velocity(seg):
        cap = fmin(cap, (LEAD_ROOM * fmax(1.0, tp.feed_scale) * tp.spindle_rps[seg.spindle] * seg.sync_revs / span.speed) ** 2)
    cap = fmin(cap, span.cap)
    if tp.improvement.origin <= index < tp.planned and tp.improvement.first > tp.improvement.origin:
        cap = fmax(cap, _cell(tp, index).w)
    return fmax(cap, 4.0 * crawl(tp, index))


cdef void guess_plan(TpState* tp) noexcept nogil:
    """A plan that is about right, into `change`: under each span's speed, speeding up and slowing down gently."""
    cdef Improvement* s = &tp.improvement
    cdef int64_t k
    cdef double w = 0.0, a = 0.0, most
    s.weight = 0.0
    for k in range(max(s.first - 2, s.origin), s.end):
        _cell(tp, k).cap = plan_cap(tp, k)
    for k in range(s.first, s.end):
        if starts_at_rest(tp, k):
            w = a = 0.0
        elif k == s.first and k > s.origin:
            w = _cell(tp, k - 1).w
        elif k == s.first:
            w = INFINITY
        most = fmin(_cell(tp, k).cap, _span(tp, k).steady ** 2)
        if s.failed:                             # where spans are short, equations are better for slow guesses
            most = fmin(most, cbrt(RAGGED * _span(tp, k).jerk * _span(tp, k).h ** 2) ** 2)
        _ramp(_span(tp, k), most, &w, &a)
        _cell(tp, k).change = w
    w = a = 0.0
    for k in range(s.end - 1, s.first - 1, -1):
        if ends_at_rest(tp, k, s.end):
            w = a = 0.0
        _ramp(_span(tp, k), _cell(tp, k).change, &w, &a)
        _cell(tp, k).change = w
    _smoothe(tp)
    for k in range(max(s.first - 2, s.origin), s.end):
        w = _cell(tp, k).w if k < s.first else _cell(tp, k).change
        _cell(tp, k).weight = _span(tp, k).h / sqrt(w)
        s.weight += _cell(tp, k).weight
    s.even = s.weight / (s.end - s.first)
    _mix(tp)


cdef void _smoothe(TpState* tp) noexcept nogil:
    """Spread what changes suddenly in the guess over the way that an acceleration needs to come: c - r^2 c'' = guess."""
    cdef Improvement* s = &tp.improvement
    cdef const Span* span
    cdef Cell* c
    cdef double before, behind, reach, w, down = 0.0, up, diagonal
    cdef int64_t k
    for k in range(s.first, s.end):
        c = _cell(tp, k)
        span = _span(tp, k)
        c.beside[0] = 0.0
        w = c.change
        if k > s.first and not fixed(tp, k) and not fixed(tp, k - 1) and k + 1 < s.end:
            reach = fmax(span.h, fmax(_span(tp, k - 1).h, _span(tp, k + 1).h))
            reach = fmin(SPREAD * w * (span.push / span.jerk) ** 2, FARTHEST * reach * reach)
            before = 0.5 * (span.h + _span(tp, k - 1).h)
            behind = 0.5 * (span.h + _span(tp, k + 1).h)
            down = 2.0 * reach / (before * (before + behind))
            up = 2.0 * reach / (behind * (before + behind))
            diagonal = 1.0 + down + up - down * _cell(tp, k - 1).beside[0]
            c.beside[0] = up / diagonal
            c.change = (w + down * _cell(tp, k - 1).change) / diagonal
    for k in range(s.end - 2, s.first - 1, -1):
        _cell(tp, k).change += _cell(tp, k).beside[0] * _cell(tp, k + 1).change


cdef void _ramp(const Span* span, double cap, double* w, double* a) noexcept nogil:
    """Speed up along a span, with an acceleration that grows."""
    cdef double jerk = GUESS_PUSH * span.jerk, time = cbrt(6.0 * span.h / jerk)
    if w[0] > 0.0:
        time = fmin(time, span.h / sqrt(w[0]))
    a[0] = fmin(GUESS_PUSH * span.push, a[0] + jerk * time)
    w[0] += 2.0 * a[0] * span.h
    if w[0] >= cap:
        w[0] = cap
        a[0] = 0.0


cdef void _mix(TpState* tp) noexcept nogil:
    """Where to start from: the plan in force where there is one, and more and more of the guess."""
    cdef Improvement* s = &tp.improvement
    cdef double share = GUESS_SHARE, way = 0.0, whole = 0.0, x, least
    cdef int64_t k
    cdef Cell* cell
    for k in range(s.first, min(tp.planned, s.end)):
        whole += _span(tp, k).h
    for k in range(max(s.first - 2, s.origin), s.end):
        cell = _cell(tp, k)
        if k < s.first:
            cell.fresh = cell.w
            continue
        least = crawl(tp, k)
        if fixed(tp, k):
            cell.fresh = least
        elif k < tp.planned and s.first > s.origin:
            way += _span(tp, k).h
            x = way / whole
            x = x * x * (3.0 - 2.0 * x)
            cell.fresh = fmax(least, (1.0 - x) * cell.w + x * share * cell.change)
        else:
            cell.fresh = fmax(least, share * cell.change)
