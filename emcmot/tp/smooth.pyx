"""Where jerk is limited: the commanded position is the average of the planned ones of the last periods.

The planned path bends suddenly, where a blend or an arc begins; averages over a time T do not: its commanded path has a continuous
curvature, and a jump of the acceleration becomes a jerk of that jump / T. Averages keep every limit of velocity and
acceleration, in each axis. From the path they are off by no more than T^2 / 24 times the acceleration across it.

An axis spends its jerk by shares: most of it on changes of the acceleration along the path (`jerk` of a span), a part each
way on its bends, a tenth on the change of speed within them. On straight moves from stop to stop, changes of the
acceleration along the path have all of it. T is chosen at rest, for the tolerance of the move that starts, so that
both bounds on bends, that of jerk and that of the distance from the path, bind at the same speed.
Called by tp (choice), path (limits of spans) and advance (positions).
"""

from libc.math cimport INFINITY, cbrt, fabs, fmax, fmin, sqrt
from libc.string cimport memcpy

from emcmot.tp.model cimport AXES, WINDOW, Segment, Span, TpState
from emcmot.tp.tp cimport TP_TERM_BLEND

ALONG = 0.6                          # shares of an axis's jerk: along the path,
cdef double BEND = 0.15              # for a bend; two may follow each other, to and fro
cdef double MIXED = 0.1              # 3 q'' v a
cdef double STEADY_SHARE = 0.8       # of an axis's acceleration that bends may use; speed needs the rest to change
cdef double SMOOTHING_SHARE = 0.25   # of the tolerance
cdef double EXACT_SMOOTHING = 1e-3   # lu; what exact path mode gives to smoothing
cdef double SPREAD = 24.0            # an average over T is off by acceleration T^2 / 24
cdef int LEAST_WINDOW = 8


cdef void choose_smoothing(TpState* tp, double tolerance) noexcept nogil:
    """Decide, at rest with an empty queue, whether jerk is limited, and over how many periods positions are averaged."""
    cdef double jerk = INFINITY, time
    cdef int i
    for i in range(AXES + tp.joints):
        jerk = fmin(jerk, tp.jmax[i])
    tp.smooth = tp.limit_jerk and jerk < INFINITY
    tp.window = 1
    tp.a = 0.0
    tp.stretch_count = 0
    tp.hungry = 1
    tp.draining = tp.slot = 0
    if not tp.smooth:
        return
    if tolerance <= 0.0:
        tolerance = EXACT_SMOOTHING / SMOOTHING_SHARE
    time = cbrt(SPREAD * SMOOTHING_SHARE * tolerance / (BEND * jerk))
    tp.window = <int>fmax(LEAST_WINDOW, fmin(WINDOW, time / tp.dt))
    for i in range(tp.window):
        memcpy(tp.recent[i], tp.pos, sizeof(tp.pos))


cdef double blend_share(const TpState* tp) noexcept nogil:
    """Share of the tolerance that blends may use."""
    return 1.0 - SMOOTHING_SHARE if tp.smooth else 1.0


cdef double smoothing_tolerance(const Segment* seg) noexcept nogil:
    """Distance from a move that smoothing may bring."""
    if seg.term != TP_TERM_BLEND or seg.tolerance <= 0.0:
        return EXACT_SMOOTHING
    return SMOOTHING_SHARE * (seg.tolerance - seg.deviation)


cdef double bend_speed(const TpState* tp, double tolerance, const double* bend) noexcept nogil:
    """Largest speed where the second derivative by u is `bend`."""
    cdef double time = tp.window * tp.dt, w = INFINITY, across = 0.0
    cdef int i
    for i in range(AXES):
        if bend[i] != 0.0:
            w = fmin(w, fmin(STEADY_SHARE * tp.amax[i], BEND * tp.jmax[i] * time) / fabs(bend[i]))
            across += bend[i] * bend[i]
    return sqrt(fmin(w, SPREAD * tolerance / (sqrt(across) * time * time))) if across > 0.0 else INFINITY


cdef double first_speed(const TpState* tp, const double* rate) noexcept nogil:
    """Speed that the first period of a start brings where the first derivative by u is `rate`."""
    cdef double jerk = INFINITY
    cdef int i
    for i in range(AXES):
        if rate[i] != 0.0:
            jerk = fmin(jerk, fmin(ALONG * tp.jmax[i], tp.amax[i] / tp.dt) / fabs(rate[i]))
    return jerk * tp.dt * tp.dt


cdef void limit_smooth(const TpState* tp, double tolerance, Span* span) noexcept nogil:
    """Largest speed, acceleration and jerk along a span whose derivatives and cap are known."""
    cdef double time = tp.window * tp.dt, w = span.cap, rate, bend, across = 0.0, a, jerk, v
    cdef int j, i
    for j in range(span.n):
        i = span.axis[j]
        bend = fmax(fabs(span.ddq0[j]), fabs(span.ddq1[j]))
        if bend == 0.0:
            continue
        w = fmin(w, fmin(STEADY_SHARE * tp.amax[i] * span.tight, BEND * tp.jmax[i] * time) / bend)
        if i < AXES:
            across += bend * bend
    if across > 0.0:
        w = fmin(w, SPREAD * tolerance / (sqrt(across) * time * time))
    v = sqrt(w)
    a = span.acc
    jerk = INFINITY
    for j in range(span.n):
        i = span.axis[j]
        rate = fmax(fabs(span.dq0[j]), fabs(span.dq1[j]))
        bend = fmax(fabs(span.ddq0[j]), fabs(span.ddq1[j]))
        if rate > 0.0:
            a = fmin(a, (tp.amax[i] * span.tight - bend * w) / rate)
            jerk = fmin(jerk, span.along * tp.jmax[i] / rate)
        if bend > 0.0:
            a = fmin(a, MIXED * tp.jmax[i] / (3.0 * bend * v))
    span.steady = v
    span.push = a
    span.jerk = fmin(jerk, a / tp.dt)        # without a limit: any acceleration within a period


cdef void command_planned(TpState* tp) noexcept nogil:
    memcpy(tp.pos, tp.planned, sizeof(tp.pos))


cdef void command_smoothed(TpState* tp) noexcept nogil:
    """Take the planned position of this period, and command the average of the last ones."""
    cdef const double* newest = tp.recent[tp.slot]
    cdef double total
    cdef int i, k, moved = 0
    for i in range(AXES):
        moved |= newest[i] != tp.planned[i]
    tp.lag = tp.window - 1 if moved else tp.lag - (tp.lag > 0)
    tp.slot = (tp.slot + 1) % tp.window
    memcpy(tp.recent[tp.slot], tp.planned, sizeof(tp.planned))
    if tp.lag == 0:
        command_planned(tp)
        return
    for i in range(AXES):
        total = 0.0
        for k in range(tp.window):
            total += tp.recent[k][i] - tp.planned[i]
        tp.pos[i] = tp.planned[i] + total / tp.window
