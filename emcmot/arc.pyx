"""How far an arc reaches between its end points, for the check of soft limits before it is queued."""

from libc.math cimport M_PI, atan2, fabs, fmod, sqrt

from emcmot.tp.tp cimport TpSegment

from emcmot.layout import same_size

same_size(__name__, "TpSegment", sizeof(TpSegment))

cdef double FULL = 2.0 * M_PI


cdef double dot(const double* a, const double* b) noexcept nogil:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


cdef double positive_angle(double angle) noexcept nogil:
    """The same direction as ``angle``, from 0 to a full turn."""
    angle = fmod(angle, FULL)
    return angle + FULL if angle < 0.0 else angle


cdef void widen(double value, double* low, double* high) noexcept nogil:
    if value < low[0]:
        low[0] = value
    if value > high[0]:
        high[0] = value


cdef void arc_box(const double* start, const TpSegment* s, double* low, double* high) noexcept nogil:
    """The smallest and largest x, y and z of the arc from ``start``; of a spiral, those of its larger circle.

    In the plane of the arc, u points from the centre to the start and v a quarter turn on, counter-clockwise about the
    normal. Coordinate i is largest at the angle atan2(v[i], u[i]) and smallest half a turn from there.
    """
    cdef double n[3]
    cdef double u[3]
    cdef double v[3]
    cdef double e[3]
    cdef double size, radius, end_radius, sweep, angle, reach, along_start, along_end
    cdef int i, turns, half
    for i in range(3):
        low[i] = min(start[i], s.end[i])
        high[i] = max(start[i], s.end[i])
    size = sqrt(dot(s.normal, s.normal))
    if not size > 0.0:
        return
    for i in range(3):
        n[i] = s.normal[i] / size
        u[i] = start[i] - s.center[i]
        e[i] = s.end[i] - s.center[i]
    along_start = dot(u, n)
    along_end = dot(e, n)
    for i in range(3):
        u[i] -= along_start * n[i]
        e[i] -= along_end * n[i]
    radius = sqrt(dot(u, u))
    end_radius = sqrt(dot(e, e))
    if not radius > 0.0:
        return
    for i in range(3):
        u[i] /= radius
    v[0] = n[1] * u[2] - n[2] * u[1]
    v[1] = n[2] * u[0] - n[0] * u[2]
    v[2] = n[0] * u[1] - n[1] * u[0]
    sweep = positive_angle(atan2(dot(e, v), dot(e, u)))
    turns = s.turn
    if turns < 0:
        sweep = FULL - sweep
        turns = -turns - 1
    if sweep < 1e-9:
        sweep = FULL
    radius = max(radius, end_radius)
    for i in range(3):
        reach = radius * sqrt(u[i] * u[i] + v[i] * v[i])
        for half in range(2):
            angle = atan2(v[i], u[i]) + half * M_PI
            angle = positive_angle(angle if s.turn >= 0 else -angle)
            if turns > 0 or angle <= sweep:
                size = reach if half == 0 else -reach
                widen(s.center[i] + size + min(along_start * n[i], along_end * n[i]), &low[i], &high[i])
                widen(s.center[i] + size + max(along_start * n[i], along_end * n[i]), &low[i], &high[i])
