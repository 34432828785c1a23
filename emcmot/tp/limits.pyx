"""What the axis limits allow on one span.

Inside a span w = (du/dt)^2 is linear in u, so with x = the way to the end of the span, d2u/dt2 = (w1 - w0) / 2x, and the
acceleration of an axis is dq d2u/dt2 + ddq w.  Where dq and ddq are linear in u (blends of lines; arcs to within the
span's `tight` share), it is extreme at the ends of the span; so the limits are linear inequalities in w0 and w1, two
two-sided ones for each axis.  They hold at w0 = w1 = 0, and what they allow is convex; hence the speeds at the start from which
some speed at the end can be reached are an interval [0, largest].
"""

from libc.math cimport INFINITY, fabs, fmax, fmin

from emcmot.tp.model cimport LIMITED, SPAN_LINE, Span

cdef enum:
    MAX_ROWS = 2 * LIMITED + 2   # two for each axis and joint, and the segment's own limit of d2u/dt2

cdef double ROUNDING = 1.0 + 1e-9
cdef double FLAT = 1e-9          # relative weight of w0 below which a row limits w1 only

ctypedef struct Bounds:          # of w0 at one w1: low <= w0 <= high, and how they change with w1
    double low
    double low_slope
    double high
    double high_slope

ctypedef struct Rows:            # |r w0 + s w1| <= a
    int n
    double r[MAX_ROWS]
    double s[MAX_ROWS]
    double a[MAX_ROWS]


cdef inline Bounds _bounds(const Rows* rows, double cap, double w1) noexcept nogil:
    """Interval of w0 that every row allows at w1."""
    cdef Bounds b
    cdef double inverse, middle, half, slope
    cdef int k
    b.low = 0.0
    b.low_slope = 0.0
    b.high = cap
    b.high_slope = 0.0
    for k in range(rows.n):
        inverse = 1.0 / rows.r[k]
        slope = -rows.s[k] * inverse
        middle = slope * w1
        half = fabs(rows.a[k] * inverse)
        if middle + half < b.high:
            b.high = middle + half
            b.high_slope = slope
        if middle - half > b.low:
            b.low = middle - half
            b.low_slope = slope
    return b


cdef inline void _add_row(Rows* rows, double r, double s, double a, double* limit_w1) noexcept nogil:
    if fabs(r) > FLAT * fabs(s):
        rows.r[rows.n] = r
        rows.s[rows.n] = s
        rows.a[rows.n] = a
        rows.n += 1
    elif fabs(s) * limit_w1[0] > a:
        limit_w1[0] = a / fabs(s)


cdef double entry_limit(const Span* span, const double* amax, double cap, double exit_w, int* settled) noexcept nogil:
    """Largest w at the start of `span`, at most `cap`, from which its end can be reached with at most `exit_w`.

    `settled` becomes non-zero where a larger `exit_w` would not change the answer.
    """
    cdef Rows rows
    cdef Bounds here, left
    cdef double w1, previous, k, a
    cdef int j, step
    settled[0] = 0
    if span.kind == SPAN_LINE:
        w1 = exit_w + 2.0 * span.acc * span.h
        if w1 < cap:
            return w1
        settled[0] = 1
        return cap
    k = 0.5 / span.h
    rows.n = 0
    w1 = exit_w
    for j in range(span.n):
        a = amax[span.axis[j]] * span.tight
        _add_row(&rows, span.ddq0[j] - k * span.dq0[j], k * span.dq0[j], a, &w1)
        _add_row(&rows, -k * span.dq1[j], k * span.dq1[j] + span.ddq1[j], a, &w1)
    if span.acc < INFINITY:
        _add_row(&rows, -k, k, span.acc, &w1)
    here = _bounds(&rows, cap, w1)
    step = 0
    while here.low > here.high and step < MAX_ROWS:      # w1 is unreachable; both bounds are straight up to the crossing
        w1 = fmax(0.0, w1 - (here.low - here.high) / (here.low_slope - here.high_slope))
        here = _bounds(&rows, cap, w1)
        step += 1
    if here.high_slope >= 0.0:
        settled[0] = here.high_slope == 0.0 or w1 < exit_w
        return fmin(here.high, cap)
    settled[0] = 1
    left = _bounds(&rows, cap, 0.0)
    if left.high_slope <= 0.0:
        return left.high
    return _peak(&rows, cap, left, 0.0, here, w1)


cdef double _peak(const Rows* rows, double cap, Bounds left, double left_w1, Bounds right, double right_w1) noexcept nogil:
    """Top of the upper bound of w0, which rises at `left_w1` and falls at `right_w1` and is concave between."""
    cdef Bounds here
    cdef double w1, crossing
    cdef int step
    here = left
    for step in range(2 * MAX_ROWS):
        w1 = left_w1 + (
            right.high - left.high - right.high_slope * (right_w1 - left_w1)
        ) / (left.high_slope - right.high_slope)
        crossing = left.high + left.high_slope * (w1 - left_w1)
        here = _bounds(rows, cap, w1)
        if here.high >= crossing * (1.0 - 1e-12) or here.high_slope == 0.0:
            break
        if here.high_slope > 0.0:
            left = here
            left_w1 = w1
        else:
            right = here
            right_w1 = w1
    return here.high


cdef inline void _allow(double factor, double offset, double a, double* low, double* high) noexcept nogil:
    """Narrow [low, high] to the x with |factor x + offset| <= a, to within rounding."""
    cdef double middle, half
    if factor == 0.0:
        return
    middle = -offset / factor
    half = fabs(a * ROUNDING / factor)
    if middle - half > low[0]:
        low[0] = middle - half
    if middle + half < high[0]:
        high[0] = middle + half


cdef int acceleration_range(
    const Span* span, const double* amax, double u, double w, double* low, double* high) noexcept nogil:
    """Range of d2u/dt2 that may be held from u, where the square of the speed is w, to the end of a curved span.

    0 where rounding or interpolation leaves none; the range then is the one value that breaks every limit least.
    """
    cdef double x = span.h - u, t = u / span.h, a, dq, ddq
    cdef int j
    low[0] = -span.acc
    high[0] = span.acc
    for j in range(span.n):
        a = amax[span.axis[j]] * span.tight
        dq = span.dq0[j] + t * (span.dq1[j] - span.dq0[j])
        ddq = span.ddq0[j] + t * (span.ddq1[j] - span.ddq0[j])
        _allow(dq, ddq * w, a, low, high)
        _allow(span.dq1[j] + 2.0 * x * span.ddq1[j], span.ddq1[j] * w, a, low, high)
    if low[0] <= high[0]:
        return 1
    low[0] = high[0] = fmax(high[0], fmin(low[0], 0.0))
    return 0


cdef double hardest_stop(const Span* span, const double* amax, double u, double w) noexcept nogil:
    """Smallest d2u/dt2 with which a stop inside a curved span, before its end, keeps the limits."""
    cdef double t = u / span.h, a, dq, ddq
    cdef double low = -span.acc, high = span.acc
    cdef int j
    for j in range(span.n):
        a = amax[span.axis[j]] * span.tight
        dq = span.dq0[j] + t * (span.dq1[j] - span.dq0[j])
        ddq = span.ddq0[j] + t * (span.ddq1[j] - span.ddq0[j])
        _allow(dq, ddq * w, a, &low, &high)
        _allow(dq, -0.5 * w * (span.dq1[j] - span.dq0[j]) / span.h, a, &low, &high)
    return low
