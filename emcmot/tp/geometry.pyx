"""Segments as curves: straight moves, and arcs that may be helices, spirals and carry any other axis along.

Every curve is q(u) in nine axes, u in [0, length], with |dq/du| = 1 in the axes that the feed is measured along (exactly
for lines and helices, on average for spirals).  Used by path and smooth (limits of the spans) and advance (positions).
"""

from libc.math cimport M_PI, atan2, ceil, cos, hypot, isfinite, sin, sqrt

from emcmot.tp.model cimport AXES, UNIT_ABC, UNIT_UVW, UNIT_XYZ, Segment
from emcmot.tp.tp cimport TP_ARC, TP_BAD, TP_LINE, TP_OK, TP_TAP, TpSegment

cdef double LINEAR_MOTION = 1e-6     # lu; less xyz or uvw motion than this does not define the feed
cdef double FULL_TURN_ANGLE = 1e-7   # rad; an arc that ends this near its start direction is a full turn
cdef double SHORTEST_RADIUS = 1e-9   # lu


cdef inline double dot3(const double* a, const double* b) noexcept nogil:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


cdef double length(const double* v) noexcept nogil:
    """Length over all nine axes, a degree counting as one length unit."""
    cdef double square = 0.0
    cdef int i
    for i in range(AXES):
        square += v[i] * v[i]
    return sqrt(square)


cdef double norm(const double* v, int unit) noexcept nogil:
    """Length of a nine-axis vector in the axes of one feed unit."""
    cdef const double* p = v + (0 if unit == UNIT_XYZ else 3 if unit == UNIT_ABC else 6)
    return sqrt(dot3(p, p))


cdef int shape(Segment* seg, const TpSegment* given, const double* start) noexcept nogil:
    """Fill the geometry of `seg` for the move from `start`; TP_BAD where it is no curve. A length of 0 is no error."""
    cdef int i
    for i in range(AXES):
        if not isfinite(given.end[i]):
            return TP_BAD
        seg.start[i] = start[i]
        seg.end[i] = given.end[i]
    seg.kind = given.kind
    seg.trim_start = seg.trim_end = 0.0
    if given.kind == TP_LINE or given.kind == TP_TAP:
        _shape_line(seg)
        return TP_OK
    if given.kind == TP_ARC:
        return _shape_arc(seg, given)
    return TP_BAD


cdef void _shape_line(Segment* seg) noexcept nogil:
    cdef double delta[AXES]
    cdef int i
    for i in range(AXES):
        delta[i] = seg.end[i] - seg.start[i]
    seg.omega = seg.growth = 0.0
    seg.unit = UNIT_XYZ
    seg.length = norm(delta, UNIT_XYZ)
    if seg.length < LINEAR_MOTION and norm(delta, UNIT_UVW) > seg.length:
        seg.unit = UNIT_UVW
        seg.length = norm(delta, UNIT_UVW)
    if seg.length < LINEAR_MOTION and norm(delta, UNIT_ABC) > seg.length:
        seg.unit = UNIT_ABC
        seg.length = norm(delta, UNIT_ABC)
    for i in range(AXES):
        seg.rate[i] = delta[i] / seg.length if seg.length > 0.0 else 0.0


cdef int _shape_arc(Segment* seg, const TpSegment* given) noexcept nogil:
    """An arc turns about `normal` through `center`; radius and height change in proportion to the angle."""
    cdef double n[3]
    cdef double from_center[3]
    cdef double to_center[3]
    cdef double height[2]
    cdef double scale, end_radius, angle
    cdef int i
    scale = sqrt(dot3(given.normal, given.normal))
    if not isfinite(scale) or scale < SHORTEST_RADIUS or not isfinite(dot3(given.center, given.center)):
        return TP_BAD
    for i in range(3):
        n[i] = given.normal[i] / scale
        from_center[i] = seg.start[i] - given.center[i]
        to_center[i] = seg.end[i] - given.center[i]
    height[0] = dot3(from_center, n)
    height[1] = dot3(to_center, n)
    for i in range(3):
        from_center[i] -= height[0] * n[i]
        to_center[i] -= height[1] * n[i]
        seg.center[i] = given.center[i] + height[0] * n[i]
    seg.radius = sqrt(dot3(from_center, from_center))
    end_radius = sqrt(dot3(to_center, to_center))
    if seg.radius < SHORTEST_RADIUS or end_radius < SHORTEST_RADIUS:
        return TP_BAD
    for i in range(3):
        seg.e1[i] = from_center[i] / seg.radius
    seg.e2[0] = n[1] * seg.e1[2] - n[2] * seg.e1[1]
    seg.e2[1] = n[2] * seg.e1[0] - n[0] * seg.e1[2]
    seg.e2[2] = n[0] * seg.e1[1] - n[1] * seg.e1[0]
    angle = _turned(atan2(dot3(to_center, seg.e2), dot3(to_center, seg.e1)), given.turn)
    seg.unit = UNIT_XYZ
    seg.length = hypot(hypot(0.5 * (seg.radius + end_radius) * angle, end_radius - seg.radius), height[1] - height[0])
    seg.omega = angle / seg.length
    seg.growth = (end_radius - seg.radius) / seg.length
    for i in range(3):
        seg.rate[i] = n[i] * (height[1] - height[0]) / seg.length
    for i in range(3, AXES):
        seg.rate[i] = (seg.end[i] - seg.start[i]) / seg.length
    return TP_OK


cdef double _turned(double angle, int turn) noexcept nogil:
    """Angle of an arc whose end lies at `angle` from its start: counter-clockwise for turn >= 0, plus whole turns."""
    if turn >= 0:
        angle -= 2.0 * M_PI * (ceil(angle / (2.0 * M_PI)) - 1.0)
        if angle < FULL_TURN_ANGLE:
            angle += 2.0 * M_PI
        return angle + 2.0 * M_PI * turn
    return -_turned(-angle, -turn - 1)


cdef void position(const Segment* seg, double u, double* q) noexcept nogil:
    """Position at parameter u of the segment, exact at both ends."""
    cdef int i
    cdef double r, c, s
    if u >= seg.length:
        for i in range(AXES):
            q[i] = seg.end[i]
        return
    for i in range(AXES):
        q[i] = seg.start[i] + seg.rate[i] * u
    if seg.kind == TP_ARC:
        r = seg.radius + seg.growth * u
        c = r * cos(seg.omega * u)
        s = r * sin(seg.omega * u)
        for i in range(3):
            q[i] = seg.center[i] + c * seg.e1[i] + s * seg.e2[i] + seg.rate[i] * u


cdef void derivatives(const Segment* seg, double u, double* dq, double* ddq) noexcept nogil:
    """First and second derivative by u."""
    cdef int i
    cdef double r, c, s, g, v
    for i in range(AXES):
        dq[i] = seg.rate[i]
        ddq[i] = 0.0
    if seg.kind == TP_ARC:
        r = seg.radius + seg.growth * u
        c = cos(seg.omega * u)
        s = sin(seg.omega * u)
        g = seg.growth
        v = seg.omega
        for i in range(3):
            dq[i] += (g * c - r * v * s) * seg.e1[i] + (g * s + r * v * c) * seg.e2[i]
            ddq[i] = -v * (2.0 * g * s + r * v * c) * seg.e1[i] + v * (2.0 * g * c - r * v * s) * seg.e2[i]
