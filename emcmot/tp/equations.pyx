"""The equations for the speed plan where jerk is limited: what it counts, derivatives of that, their solution, and limits.

Along q(u) the velocity of an axis is q' v, its acceleration q' a + q'' w and its jerk v (q' b + 3 q'' a + q''' w), where w = v^2,
a is half of dw/du and b half of d2w/du2. All of them follow from the plan's coefficients (see profile), three for each span. What
counts is the time, and a barrier: the logarithm of what is left of each limit. Each term has three coefficients at most, so the
equations of Newton's method have a band of five diagonals.
Called by interior, span by span.
"""

from libc.math cimport INFINITY, fabs, fmax, fmin, log, sqrt
from libc.stdint cimport int64_t
from libc.string cimport memset

from emcmot.tp.guess cimport fixed, plan_cap
from emcmot.tp.model cimport Cell, Improvement, Span, TpState
from emcmot.tp.profile cimport ends_at_rest, starts_at_rest

cdef enum:
    PLACES = 3               # of a span, for which there are equations
    PARTS = 8                # between which its limits are checked

cdef double WITHIN = 0.985       # of limits a plan must be: overrides need the rest to begin
cdef double TIGHTER = 0.998      # reserve of a span that is not, beyond what it misses,
cdef double LEAST_RESERVE = 0.3  # and the least
cdef double CAPPED = 0.2         # of a span's own barrier: the feed is kept that much closer
cdef double SHARED = 0.5         # of a barrier is the same for all spans, the rest by the time that they take
cdef double SINGULAR = 1e-12     # of a diagonal: what is less is rounding

ctypedef struct Local:       # one span of the plan that is being made
    double w[PLACES]         # at its start, in its middle and at its end
    double a[PLACES]
    double b
    double by_w[PLACES][3]   # derivatives by the coefficients of the span before, of this one, and of the next
    double by_a[PLACES][3]
    double by_b[3]

ctypedef struct Bends:       # derivatives of an axis by u at one of these places
    double dq
    double ddq
    double dddq


cdef inline const Span* _span(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.spans[index & tp.span_mask]


cdef inline Cell* _cell(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.cells[index & tp.cell_mask]


# --- one span ---------------------------------------------------------------------------------------------------------

cdef inline void _meet(double h, double other, int side, double* by_w, double* by_a) noexcept nogil:
    """How w and a depend on the coefficients where a span meets another: that before it, side 0, or behind it, side 2."""
    cdef double inverse = 1.0 / (h + other)
    by_w[side] = h * inverse
    by_w[1] = other * inverse
    by_a[side] = (side - 1) * inverse
    by_a[1] = (1 - side) * inverse


cdef void _look(const TpState* tp, int64_t index, double share, Local* local) noexcept nogil:
    """A span of the plan that is being made, changed by a share of the step."""
    cdef const Span* span = _span(tp, index)
    cdef double c[3]
    cdef double before = 0.0, behind = 0.0
    cdef int place, j
    memset(local, 0, sizeof(Local))
    c[0] = c[1] = c[2] = _cell(tp, index).fresh + share * _cell(tp, index).change
    if index > tp.improvement.origin and not starts_at_rest(tp, index):
        before = _span(tp, index - 1).h
        c[0] = _cell(tp, index - 1).fresh + share * _cell(tp, index - 1).change
    if not ends_at_rest(tp, index, tp.improvement.end):
        behind = _span(tp, index + 1).h
        c[2] = _cell(tp, index + 1).fresh + share * _cell(tp, index + 1).change
    local.by_w[0][1] = local.by_w[2][1] = 1.0
    if before > 0.0:
        _meet(span.h, before, 0, local.by_w[0], local.by_a[0])
    if behind > 0.0:
        _meet(span.h, behind, 2, local.by_w[2], local.by_a[2])
    for j in range(3):
        local.by_w[1][j] = 0.25 * (local.by_w[0][j] + local.by_w[2][j]) + (0.5 if j == 1 else 0.0)
        local.by_a[1][j] = 0.5 * (local.by_a[0][j] + local.by_a[2][j])
        local.by_b[j] = (local.by_a[2][j] - local.by_a[0][j]) / span.h
        local.b += local.by_b[j] * c[j]
        for place in range(PLACES):
            local.w[place] += local.by_w[place][j] * c[j]
            local.a[place] += local.by_a[place][j] * c[j]


cdef inline Bends _bends(const Span* span, int j, int place) noexcept nogil:
    cdef Bends bends
    bends.dddq = (span.ddq1[j] - span.ddq0[j]) / span.h
    if place == 0:
        bends.dq = span.dq0[j]
        bends.ddq = span.ddq0[j]
    elif place == 2:
        bends.dq = span.dq1[j]
        bends.ddq = span.ddq1[j]
    else:
        bends.dq = span.dq0[j] + span.h * (0.375 * span.ddq0[j] + 0.125 * span.ddq1[j])
        bends.ddq = 0.5 * (span.ddq0[j] + span.ddq1[j])
    return bends


# --- what it counts ---------------------------------------------------------------------------------------------------

cdef inline double _beyond(double value, double near, double* product) noexcept nogil:
    """What the barrier of a value has over -log(product), to which 1 - value is multiplied.

    That is nothing where more than `near` is left; else the parabola that goes on from there, since guesses break limits.
    """
    cdef double left = 1.0 - value
    if left >= near:
        product[0] *= left
        return 0.0
    left = (near - left) / near
    product[0] *= near
    return left + 0.5 * left * left


cdef inline void _slope(double value, double near, double* first, double* second) noexcept nogil:
    """Its derivatives."""
    cdef double left = 1.0 - value
    if left >= near:
        first[0] = 1.0 / left
        second[0] = first[0] * first[0]
        return
    second[0] = 1.0 / (near * near)
    first[0] = 1.0 / near + (near - left) * second[0]


cdef inline double _shared(const Improvement* s, double weight) noexcept nogil:
    """Weight of the barrier at one place of a span."""
    return (1.0 - SHARED) * weight + SHARED * s.even / PLACES


cdef double span_value(const TpState* tp, int64_t index, double share, double* worst) noexcept nogil:
    """What a span counts, with a share of the step; infinite where the speed would be none."""
    cdef const Improvement* s = &tp.improvement
    cdef const Span* span = _span(tp, index)
    cdef double cap = _cell(tp, index).cap, v, x, value = 0.0, weight = _cell(tp, index).weight / PLACES
    cdef double bars, capped, product
    cdef double middle = _cell(tp, index).fresh + share * _cell(tp, index).change
    cdef Local local
    cdef Bends at
    cdef int place, j
    _look(tp, index, share, &local)
    if middle <= 0.0 or local.w[0] <= 0.0 or local.w[2] <= 0.0:
        return INFINITY
    worst[0] = fmax(worst[0], middle / cap)
    product = 1.0
    capped = 2.0 * _beyond(middle / cap, CAPPED * s.near, &product)
    capped -= 2.0 * log(product)
    bars = -2.0 * log(middle)
    for place in range(PLACES):
        v = sqrt(local.w[place])
        worst[0] = fmax(worst[0], local.w[place] / cap)
        product = 1.0
        capped += _beyond(local.w[place] / cap, CAPPED * s.near, &product)
        capped -= log(product)
        x = log(local.w[place])
        value -= weight * x
        bars -= x
        product = 1.0
        for j in range(span.n):
            at = _bends(span, j, place)
            if place < 2:                        # at the end it is that of the next span
                x = fabs(at.dq * local.a[place] + at.ddq * local.w[place]) / (span.reserve * tp.amax[span.axis[j]] * span.tight)
                worst[0] = fmax(worst[0], x)
                bars += _beyond(x, s.near, &product) + _beyond(-x, s.near, &product)
            x = v * fabs(at.dq * local.b + 3.0 * at.ddq * local.a[place] + at.dddq * local.w[place]) / (
                span.reserve * tp.jmax[span.axis[j]])
            worst[0] = fmax(worst[0], x)
            bars += _beyond(x, s.near, &product) + _beyond(-x, s.near, &product)
        bars -= log(product)
    return value + s.barrier * (_shared(s, weight) * bars + CAPPED * weight * capped)


cdef inline void _bound(double value, double by_w, double by_a, double by_b, double weight, double near, double* g, double* h) noexcept nogil:
    """Add the barrier of -1 < value < 1 to gradient and second derivatives (ww, wa, wb, aa, ab, bb)."""
    cdef double above, below, above2, below2, first, second
    _slope(value, near, &above, &above2)
    _slope(-value, near, &below, &below2)
    first = weight * (above - below)
    second = weight * (above2 + below2)
    g[0] += first * by_w
    g[1] += first * by_a
    g[2] += first * by_b
    h[0] += second * by_w * by_w
    h[1] += second * by_w * by_a
    h[2] += second * by_w * by_b
    h[3] += second * by_a * by_a
    h[4] += second * by_a * by_b
    h[5] += second * by_b * by_b


cdef void assemble_span(TpState* tp, int64_t index) noexcept nogil:
    """Add the derivatives of what a span counts to the equations."""
    cdef const Span* span = _span(tp, index)
    cdef Cell* here = _cell(tp, index)
    cdef double cap = here.cap, near = tp.improvement.near, weight, barrier, capped, v, w, a, most, bracket, first, second
    cdef double g[3]
    cdef double h[6]
    cdef double by[3]
    cdef Local local
    cdef Bends at
    cdef int place, j, k, l
    _look(tp, index, 0.0, &local)
    weight = here.weight / PLACES
    barrier = tp.improvement.barrier * _shared(&tp.improvement, weight)
    capped = tp.improvement.barrier * CAPPED * weight
    _slope(here.fresh / cap, CAPPED * near, &first, &second)
    here.gradient += 2.0 * (capped * first / cap - barrier / here.fresh)
    here.diagonal += 2.0 * (capped * second / (cap * cap) + barrier / (here.fresh * here.fresh))
    if tp.improvement.steps == 0:            # with another barrier than the last trial's
        tp.improvement.merit += span_value(tp, index, 0.0, &tp.improvement.worst)
    for place in range(PLACES):
        w = local.w[place]
        a = local.a[place]
        v = sqrt(w)
        _slope(w / cap, CAPPED * near, &first, &second)
        memset(g, 0, sizeof(g))
        memset(h, 0, sizeof(h))
        g[0] = -(weight + barrier) / w + capped * first / cap
        h[0] = (weight + barrier) / (w * w) + capped * second / (cap * cap)
        for j in range(span.n):
            at = _bends(span, j, place)
            if place < 2:
                most = 1.0 / (span.reserve * tp.amax[span.axis[j]] * span.tight)
                _bound((at.dq * a + at.ddq * w) * most, at.ddq * most, at.dq * most, 0.0, barrier, near, g, h)
            most = 1.0 / (span.reserve * tp.jmax[span.axis[j]])
            bracket = at.dq * local.b + 3.0 * at.ddq * a + at.dddq * w
            _bound(v * bracket * most, (v * at.dddq + 0.5 * bracket / v) * most, 3.0 * v * at.ddq * most, v * at.dq * most,
                   barrier, near, g, h)
        for k in range(3):
            by[0] = h[0] * local.by_w[place][k] + h[1] * local.by_a[place][k] + h[2] * local.by_b[k]
            by[1] = h[1] * local.by_w[place][k] + h[3] * local.by_a[place][k] + h[4] * local.by_b[k]
            by[2] = h[2] * local.by_w[place][k] + h[4] * local.by_a[place][k] + h[5] * local.by_b[k]
            _cell(tp, index + k - 1).gradient += (
                g[0] * local.by_w[place][k] + g[1] * local.by_a[place][k] + g[2] * local.by_b[k])
            for l in range(k, 3):
                first = by[0] * local.by_w[place][l] + by[1] * local.by_a[place][l] + by[2] * local.by_b[l]
                if l == k:
                    _cell(tp, index + k - 1).diagonal += first
                else:
                    _cell(tp, index + k - 1).beside[l - k - 1] += first


# --- all spans --------------------------------------------------------------------------------------------------------

cdef void clear_equations(TpState* tp) noexcept nogil:
    """Begin anew."""
    cdef Improvement* s = &tp.improvement
    cdef Cell* cell
    cdef int64_t k
    for k in range(max(s.first - 2, s.origin), s.end):
        cell = _cell(tp, k)
        cell.gradient = cell.diagonal = cell.beside[0] = cell.beside[1] = cell.change = 0.0


cdef void solve_equations(TpState* tp) noexcept nogil:
    """Solve the equations; fixed coefficients do not change."""
    cdef Improvement* s = &tp.improvement
    cdef int64_t k
    cdef Cell* c
    cdef Cell* c1
    cdef Cell* c2
    cdef double l1, l2
    for k in range(s.first, s.end):
        if fixed(tp, k):
            c = _cell(tp, k)
            c.gradient = c.beside[0] = c.beside[1] = 0.0
            c.diagonal = 1.0
            if k - 1 >= s.first:
                _cell(tp, k - 1).beside[0] = 0.0
            if k - 2 >= s.first:
                _cell(tp, k - 2).beside[1] = 0.0
    s.gain = 0.0
    for k in range(s.first, s.end):
        _cell(tp, k).change = _cell(tp, k).diagonal
    for k in range(s.first, s.end):
        c = _cell(tp, k)
        c.diagonal = fmax(c.diagonal, SINGULAR * c.change)
        l1 = c.beside[0] / c.diagonal
        l2 = c.beside[1] / c.diagonal
        if k + 1 < s.end:
            c1 = _cell(tp, k + 1)
            c1.diagonal -= l1 * c.beside[0]
            c1.beside[0] -= l1 * c.beside[1]
            c1.gradient -= l1 * c.gradient
        if k + 2 < s.end:
            c2 = _cell(tp, k + 2)
            c2.diagonal -= l2 * c.beside[1]
            c2.gradient -= l2 * c.gradient
        s.gain += c.gradient * c.gradient / c.diagonal
        c.beside[0] = l1
        c.beside[1] = l2
        c.change = c.gradient / c.diagonal
    for k in range(s.end - 1, s.first - 1, -1):
        c = _cell(tp, k)
        if k + 1 < s.end:
            c.change -= c.beside[0] * _cell(tp, k + 1).change
        if k + 2 < s.end:
            c.change -= c.beside[1] * _cell(tp, k + 2).change
    for k in range(s.first, s.end):
        _cell(tp, k).change = -_cell(tp, k).change
    for k in range(max(s.first - 2, s.origin), s.first):
        _cell(tp, k).change = 0.0


# --- limits -----------------------------------------------------------------------------------------------------------

cdef int is_within(TpState* tp, int64_t index) noexcept nogil:
    """Whether a span keeps all limits, everywhere; where it does not, less of them is planned with."""
    cdef Span* span = &tp.spans[index & tp.span_mask]
    cdef Cell* here = _cell(tp, index)
    cdef Local local
    cdef double worst = 0.0, fastest = 0.0, cap, x, w, a, v, dddq, ddq, dq
    cdef int j, k, within = 1
    _look(tp, index, 0.0, &local)
    for k in range(PARTS + 1):
        x = span.h * k / PARTS
        w = local.w[0] + x * (2.0 * local.a[0] + x * local.b)
        a = local.a[0] + x * local.b
        v = sqrt(fmax(0.0, w))
        fastest = fmax(fastest, w)
        for j in range(span.n):
            dddq = (span.ddq1[j] - span.ddq0[j]) / span.h
            ddq = span.ddq0[j] + x * dddq
            dq = span.dq0[j] + x * (span.ddq0[j] + 0.5 * x * dddq)
            worst = fmax(worst, fabs(dq * a + ddq * w) / (tp.amax[span.axis[j]] * span.tight))
            worst = fmax(worst, v * fabs(dq * local.b + 3.0 * ddq * a + dddq * w) / tp.jmax[span.axis[j]])
    if worst > WITHIN:
        span.reserve = fmax(LEAST_RESERVE, span.reserve * TIGHTER * fmax(0.5, WITHIN / worst))
        within = 0
    cap = plan_cap(tp, index)
    if fastest > cap:
        here.cap *= TIGHTER * cap / fastest
        within = 0
    return within


cdef double speed_reach(TpState* tp, int64_t index) noexcept nogil:
    """Share of the step that takes the speed of a span to nothing."""
    cdef const Cell* here = _cell(tp, index)
    cdef double share = -here.fresh / here.change if here.change < 0.0 else INFINITY
    cdef Local local
    cdef Local moved
    cdef int place
    _look(tp, index, 0.0, &local)
    _look(tp, index, 1.0, &moved)
    for place in range(0, PLACES, 2):
        if moved.w[place] < local.w[place]:
            share = fmin(share, local.w[place] / (local.w[place] - moved.w[place]))
    return share
