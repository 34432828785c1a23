"""The blend that replaces the corner between two segments.

While u runs over [0, 2d], the earlier segment is run out, s1 = L - d + u - u^2 / 4d, the later one is run up,
s2 = r u^2 / 4d, and their ways from the corner point C are added: q = p1(s1) + p2(s2) - C. This leaves the one and meets
the other with their own tangents, whatever curves they are; for two lines it is a parabola, at constant du/dt a
constant acceleration, which is the fastest way round a corner between axes. It is furthest from the corner and from the
segments in its middle: for lines by d |r t2 - t1| / 4.
"""

from libc.math cimport INFINITY, fabs, fmax, fmin

from emcmot.tp.follow cimport follows_position
from emcmot.tp.geometry cimport derivatives, length, position
from emcmot.tp.model cimport AXES, Segment, TpState
from emcmot.tp.tp cimport TP_ARC, TP_TAP, TP_TERM_BLEND, TP_TERM_STOP

cdef enum:
    MOTION_TOOL_CHANGE = 4
    ARC_BLEND_SPANS = 8
    PROBES = 8                   # parts of a blend with an arc between which its distance from the moves is measured

TANGENT = 1e-11                      # difference of unit tangents that needs no blend
cdef double EXACT_KINK = 0.02        # the same in exact-path mode: sharper corners are stops
cdef double EXACT_TOLERANCE = 1e-5   # lu; rounding of the corner's coordinates that exact-path mode may use
cdef double SMALLEST_TRIM = 1e-10    # lu
cdef double SPEED_RESERVE = 1.2      # blends are made for the programmed speed times this
cdef double ARC_SPAN_ANGLE = 0.03    # rad of an arc in one span of its blend
cdef double ARC_BLEND_ANGLE = 0.5    # rad of an arc that a blend may take
cdef double SLIGHT = 0.1             # corners below this difference of tangents cost next to no deviation


cdef Corner decide_corner(const TpState* tp, const Segment* a, const Segment* b, double room) noexcept nogil:
    """Size of the blend between `a` and `b` that may take up to `room` from the end of `a`."""
    cdef Corner corner
    cdef double t1[AXES]
    cdef double t2[AXES]
    cdef double unused[AXES]
    cdef double jump[AXES]
    cdef double sharpness, tolerance, along, wanted
    cdef int i
    derivatives(a, a.length, t1, unused)
    derivatives(b, 0.0, t2, unused)
    corner.ratio = corner_ratio(a, b, t1, t2)
    corner.trim = 0.0
    for i in range(AXES):
        jump[i] = corner.ratio * t2[i] - t1[i]
    sharpness = length(jump)
    corner.stop = must_stop(a, b) or sharpness > TANGENT
    if must_stop(a, b) or not corner.stop:
        return corner
    tolerance = corner_tolerance(a, b, sharpness)
    if tolerance == 0.0:
        return corner
    wanted = _trim_for_speed(tp, a, b, corner.ratio, jump)
    wanted *= 16.0 if sharpness < SLIGHT else 2.0
    along = fmin(fmin(room, 0.5 * b.length / corner.ratio), fmin(4.0 * tolerance / sharpness, wanted))
    if a.kind == TP_ARC:
        along = fmin(along, ARC_BLEND_ANGLE / fabs(a.omega))
    if b.kind == TP_ARC:
        along = fmin(along, ARC_BLEND_ANGLE / fabs(b.omega * corner.ratio))
    if tolerance < INFINITY and (a.kind == TP_ARC or b.kind == TP_ARC):
        along = _within(a, b, corner.ratio, along, tolerance)
    if along > SMALLEST_TRIM:
        corner.trim = along
        corner.stop = 0
    return corner


cdef int must_stop(const Segment* a, const Segment* b) noexcept nogil:
    """Whether the program wants the machine to rest between two moves."""
    if a.term == TP_TERM_STOP or a.motion_type >= MOTION_TOOL_CHANGE or b.motion_type >= MOTION_TOOL_CHANGE:
        return 1
    if b.wait_spindles or b.indexer >= 0 or (follows_position(b) and not follows_position(a)):
        return 1
    return a.kind == TP_TAP or b.kind == TP_TAP


cdef double corner_ratio(const Segment* a, const Segment* b, const double* t1, const double* t2) noexcept nogil:
    """du of `b` per du of `a`: 1 where both count the same length, else what keeps tangents or the feeds in step."""
    cdef double cross = 0.0, square1 = 0.0, square2 = 0.0
    cdef int i
    if a.unit == b.unit:
        return 1.0
    for i in range(AXES):
        cross += t1[i] * t2[i]
        square1 += t1[i] * t1[i]
        square2 += t2[i] * t2[i]
    if cross > 0.0 and cross * cross > (1.0 - TANGENT) * square1 * square2:
        return cross / square2
    return b.vel / a.vel


cdef double corner_tolerance(const Segment* a, const Segment* b, double sharpness) noexcept nogil:
    """Deviation that the corner may have; infinite for G64 without P, 0 for a stop."""
    if a.term != TP_TERM_BLEND:
        return EXACT_TOLERANCE if sharpness < EXACT_KINK else 0.0
    if b.term == TP_TERM_BLEND and b.tolerance > 0.0 and a.tolerance > 0.0:
        return fmin(a.tolerance - a.deviation, b.tolerance - b.deviation)
    return a.tolerance - a.deviation if a.tolerance > 0.0 else INFINITY


cdef double _trim_for_speed(
    const TpState* tp, const Segment* a, const Segment* b, double ratio, const double* jump) noexcept nogil:
    """Trim at which the corner no longer slows the programmed speed."""
    cdef double speed = SPEED_RESERVE * fmin(fmin(a.vel, a.vel_max), fmin(b.vel, b.vel_max) / ratio)
    cdef double trim = 0.0
    cdef int i
    for i in range(AXES):
        trim = fmax(trim, 0.5 * speed * speed * fabs(jump[i]) / tp.amax[i])
    return trim


cdef double _within(const Segment* a, const Segment* b, double ratio, double trim, double tolerance) noexcept nogil:
    """Shrink the trim until the blend lies within the tolerance of the moves, in its middle and on either side of it."""
    cdef double deviation
    cdef int step, k
    for step in range(20):
        deviation = 0.0
        for k in range(1, PROBES):
            deviation = fmax(deviation, _deviation(a, b, ratio, trim, 2.0 * trim * k / PROBES))
        if deviation <= tolerance:
            return trim
        trim *= fmax(0.5, 0.98 * tolerance / deviation)
    return 0.0


cdef double _deviation(const Segment* a, const Segment* b, double ratio, double trim, double u) noexcept nogil:
    """Distance of the blend at `u` from the place that is as far along the moves themselves."""
    cdef double q[AXES]
    cdef double p[AXES]
    cdef double part = 0.25 * u * u / trim
    cdef int i
    position(a, a.length - trim + u - part, q)
    position(b, ratio * part, p)
    for i in range(AXES):
        q[i] += p[i] - b.start[i]
    if u <= trim:
        position(a, a.length - trim + u, p)
    else:
        position(b, ratio * (u - trim), p)
    for i in range(AXES):
        q[i] -= p[i]
    return length(q)


cdef int blend_spans(const Segment* a, const Segment* b, const Corner* corner) noexcept nogil:
    """Number of spans that a blend is planned in: the sharper, the more."""
    cdef double t1[AXES]
    cdef double t2[AXES]
    cdef double unused[AXES]
    cdef double square = 0.0
    cdef int i
    cdef double bend = fmax(fabs(a.omega), fabs(b.omega * corner.ratio))
    if a.kind == TP_ARC or b.kind == TP_ARC:
        return ARC_BLEND_SPANS + <int>(2.0 * corner.trim * bend / ARC_SPAN_ANGLE)
    derivatives(a, a.length, t1, unused)
    derivatives(b, 0.0, t2, unused)
    for i in range(AXES):
        square += (corner.ratio * t2[i] - t1[i]) ** 2
    return 1 if square < 0.0025 else 2 if square < 0.25 else 4


cdef void blend_position(const Segment* a, const Segment* b, double trim, double u, double* q) noexcept nogil:
    """Position at parameter u, 0 to 2 trim, of the blend. The later segment's own trim gives the ratio."""
    cdef double p[AXES]
    cdef double part = 0.25 * u * u / trim
    cdef int i
    position(a, a.length - trim + u - part, q)
    position(b, part * b.trim_start / trim, p)
    for i in range(AXES):
        q[i] += p[i] - b.start[i]


cdef void blend_derivatives(
    const Segment* a, const Segment* b, const Corner* corner, double u, double* dq, double* ddq) noexcept nogil:
    """First and second derivative by u."""
    cdef double dp[AXES]
    cdef double ddp[AXES]
    cdef double bend = 0.5 / corner.trim, out = 1.0 - bend * u, into = corner.ratio * bend * u
    cdef int i
    derivatives(a, a.length - corner.trim + u - 0.5 * bend * u * u, dq, ddq)
    derivatives(b, 0.5 * corner.ratio * bend * u * u, dp, ddp)
    for i in range(AXES):
        ddq[i] = ddq[i] * out * out - dq[i] * bend + ddp[i] * into * into + corner.ratio * bend * dp[i]
        dq[i] = dq[i] * out + dp[i] * into
