"""Angles, rotation matrices (row by row) and the meeting point of three spheres, for several kinematics."""

from libc.math cimport atan2, cos, fabs, hypot, sin, sqrt

cdef double LOCKED = 1e-9      # a smaller cosine of b: a and c turn about the same line


cdef double nearest_turn(double angle, double to) noexcept nogil:
    """The same direction (degrees), at most half a turn from ``to``."""
    while angle - to > 180.0:
        angle -= 360.0
    while angle - to < -180.0:
        angle += 360.0
    return angle


cdef void attitude_matrix(const double* pose, double* r) noexcept nogil:
    """The matrix of a turn about x by a, then about y by b, then about z by c (degrees)."""
    cdef double sa = sin(pose[3] * DEGREE), ca = cos(pose[3] * DEGREE)
    cdef double sb = sin(pose[4] * DEGREE), cb = cos(pose[4] * DEGREE)
    cdef double sc = sin(pose[5] * DEGREE), cc = cos(pose[5] * DEGREE)
    r[0], r[1], r[2] = cc * cb, cc * sb * sa - sc * ca, cc * sb * ca + sc * sa
    r[3], r[4], r[5] = sc * cb, sc * sb * sa + cc * ca, sc * sb * ca - cc * sa
    r[6], r[7], r[8] = -sb, cb * sa, cb * ca


cdef void attitude_of_matrix(const double* r, double* pose) noexcept nogil:
    """a, b, c of such a matrix; where b is upright, a is 0 and c has the whole turn."""
    cdef double cb = hypot(r[0], r[3])
    pose[4] = atan2(-r[6], cb) / DEGREE
    if cb < LOCKED:
        pose[3] = 0.0
        pose[5] = atan2(-r[1], r[4]) / DEGREE
    else:
        pose[3] = atan2(r[7], r[8]) / DEGREE
        pose[5] = atan2(r[3], r[0]) / DEGREE


cdef void turn_plane(double* u, double* v, double degrees) noexcept nogil:
    """Turn the vector (u, v) counterclockwise."""
    cdef double c = cos(degrees * DEGREE), s = sin(degrees * DEGREE)
    cdef double turned = u[0] * c - v[0] * s
    v[0] = u[0] * s + v[0] * c
    u[0] = turned


cdef int lower_meeting_point(const double* centres, double radius, double* point) noexcept nogil:
    """The lower of the two points that have the distance ``radius`` from three centres; -1 where there is none.

    With the first centre as origin, two differences of the sphere equations give x and y as lines of z.
    """
    cdef double p[2][3]
    cdef double size[2]
    cdef double det, x0, x1, y0, y1, a, b, c, z
    cdef int i, k
    for k in range(2):
        size[k] = 0.0
        for i in range(3):
            p[k][i] = centres[3 * (k + 1) + i] - centres[i]
            size[k] += 0.5 * p[k][i] * p[k][i]
    det = p[0][0] * p[1][1] - p[1][0] * p[0][1]
    if fabs(det) < LOCKED:
        return -1
    x0 = (size[0] * p[1][1] - size[1] * p[0][1]) / det
    x1 = -(p[0][2] * p[1][1] - p[1][2] * p[0][1]) / det
    y0 = (p[0][0] * size[1] - p[1][0] * size[0]) / det
    y1 = -(p[0][0] * p[1][2] - p[1][0] * p[0][2]) / det
    a = x1 * x1 + y1 * y1 + 1.0
    b = x0 * x1 + y0 * y1
    c = x0 * x0 + y0 * y0 - radius * radius
    if b * b < a * c:
        return -1
    z = (-b - sqrt(b * b - a * c)) / a
    point[0] = centres[0] + x0 + x1 * z
    point[1] = centres[1] + y0 + y1 * z
    point[2] = centres[2] + z
    return 0
