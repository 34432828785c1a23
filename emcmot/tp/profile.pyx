"""The speed plan where jerk is limited: w = (du/dt)^2 along the path, a quadratic spline with one piece for each span.

Its coefficients are values of w, one for each span: about that in the middle of it. Between two spans w and dw/du are
continuous, so the acceleration along the path, half of dw/du, is continuous too; on a span d2w/du2 is constant. Before and behind
a standstill the coefficient is that of a *crawl*, a speed that the machine may have, or lose, from one period to the next.
On such a span d2u/dt2 is linear in u, so the place is a sum of exponentials (or sines) of time.
Called by interior, which makes the plan, and jerk, which follows it.
"""

from libc.math cimport fabs, fmax, sqrt
from libc.stdint cimport int64_t

from emcmot.tp.model cimport Cell, Span, TpState

cdef enum:
    NEWTON_STEPS = 12

cdef double CRAWL = 0.03         # of the speed that a period's full jerk brings
cdef double CREEPING = 400.0     # periods
cdef double ARRIVED = 1e-13      # of the way: rounding


cdef inline const Span* _span(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.spans[index & tp.span_mask]


cdef inline const Cell* _cell(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.cells[index & tp.cell_mask]


cdef double crawl(const TpState* tp, int64_t index) noexcept nogil:
    """The w of a speed that may come and go in one period."""
    return (CRAWL * _span(tp, index).jerk * tp.dt * tp.dt) ** 2


cdef int creeps(const TpState* tp, int64_t index) noexcept nogil:
    """Whether a span is too long for the speed of a crawl: it was not made for a stop."""
    return _span(tp, index).h > CREEPING * tp.dt * sqrt(crawl(tp, index))


cdef int starts_at_rest(const TpState* tp, int64_t index) noexcept nogil:
    """Whether the machine stands at the start of a span."""
    return index == 0 or _span(tp, index - 1).stop


cdef int ends_at_rest(const TpState* tp, int64_t index, int64_t end) noexcept nogil:
    """Whether the machine stands at the end of a span in a plan that goes as far as span `end`."""
    return _span(tp, index).stop or index + 1 >= end


cdef Pace pace(const TpState* tp, int64_t index) noexcept nogil:
    """The plan on one span; beyond its ends there is no change."""
    cdef Pace p
    cdef double h = _span(tp, index).h, here = _cell(tp, index).w, before = h, behind = h, w0 = here, w2 = here, last
    if index > tp.plan_from and not starts_at_rest(tp, index):
        before = _span(tp, index - 1).h
        w0 = _cell(tp, index - 1).w
    if not ends_at_rest(tp, index, tp.planned):
        behind = _span(tp, index + 1).h
        w2 = _cell(tp, index + 1).w
    p.slope = 2.0 * (here - w0) / (before + h)
    last = 2.0 * (w2 - here) / (h + behind)
    p.w = (h * w0 + before * here) / (before + h)
    p.bend = 0.5 * (last - p.slope) / h
    return p


cdef double fastest(const TpState* tp, int64_t index) noexcept nogil:
    """A bound of the speed on a span."""
    cdef Pace p = pace(tp, index)
    cdef double h = _span(tp, index).h
    return sqrt(fmax(_cell(tp, index).w, fmax(p.w, p.w + h * (p.slope + h * p.bend))))


cdef double pace_time(const TpState* tp, int64_t index) noexcept nogil:
    """Time that the plan takes for a span, nearly."""
    return _span(tp, index).h / sqrt(_cell(tp, index).w)


cdef double after(const Pace* p, double x, double time, double* v) noexcept nogil:
    """Place, and speed there, a time after x; on this span's plan, also where that is beyond its end."""
    cdef double a, z, part, sine, cosine
    v[0] = sqrt(fmax(0.0, p.w + x * (p.slope + x * p.bend)))
    while time > 0.0:
        part = time if fabs(p.bend) * time * time <= 1.0 else 1.0 / sqrt(fabs(p.bend))
        a = 0.5 * p.slope + p.bend * x
        z = p.bend * part * part
        sine = part * (1.0 + z / 6.0 * (1.0 + z / 20.0 * (1.0 + z / 42.0 * (1.0 + z / 72.0 * (1.0 + z / 110.0)))))
        cosine = 0.5 * part * part * (
            1.0 + z / 12.0 * (1.0 + z / 30.0 * (1.0 + z / 56.0 * (1.0 + z / 90.0 * (1.0 + z / 132.0)))))
        x += v[0] * sine + a * cosine
        v[0] = fmax(0.0, v[0] * (1.0 + p.bend * cosine) + a * sine)
        time -= part
    return x


cdef double time_to(const Pace* p, double x, double to) noexcept nogil:
    """Time from x to a later place of the span."""
    cdef double v0 = sqrt(fmax(0.0, p.w + x * (p.slope + x * p.bend))), v, time, place
    cdef double v1 = sqrt(fmax(0.0, p.w + to * (p.slope + to * p.bend)))
    cdef int k
    time = 2.0 * (to - x) / (v0 + v1)
    for k in range(NEWTON_STEPS):
        place = after(p, x, time, &v)
        if fabs(place - to) <= ARRIVED * to or v <= 0.0:
            break
        time = fmax(0.0, time - (place - to) / v)
    return time
