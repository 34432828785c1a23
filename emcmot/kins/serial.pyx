"""Chains of turning joints, described as J. J. Craig does it (modified Denavit-Hartenberg parameters), and a solver.

A frame is a matrix of rotation ``r`` (row by row) and a place ``p``. A link goes ``a`` along the x axis of the frame
before it, turns about that by ``alpha``, then turns about its own z axis by the joint's angle and goes ``d`` along it.
"""

from libc.math cimport cos, fabs, sin

from emcmot.kins.frames cimport DEGREE

cdef double SMALL_PIVOT = 1e-12


cdef void frame_times_link(double* r, double* p, const Link* link, double theta) noexcept nogil:
    """Go on from the frame over one link; ``theta`` in degrees."""
    cdef double ca = cos(link.alpha), sa = sin(link.alpha)
    cdef double ct = cos(theta * DEGREE), st = sin(theta * DEGREE)
    cdef double x, y, z
    cdef int i
    for i in range(3):
        x = r[3 * i]
        y = r[3 * i + 1] * ca + r[3 * i + 2] * sa
        z = r[3 * i + 2] * ca - r[3 * i + 1] * sa
        p[i] += x * link.a + z * link.d
        r[3 * i] = x * ct + y * st
        r[3 * i + 1] = y * ct - x * st
        r[3 * i + 2] = z


cdef void chain(const Link* links, const double* joints, double* r, double* p) noexcept nogil:
    """The frame of the last of six links; ``joints`` in degrees."""
    cdef int i
    for i in range(9):
        r[i] = i % 4 == 0
    for i in range(3):
        p[i] = 0.0
    for i in range(LINKS):
        frame_times_link(r, p, &links[i], joints[i])


cdef int solve6(double* a, double* b) noexcept nogil:
    """Gauss with column pivots: a (6 x 6) x = b, the solution in b; -1 where a is singular."""
    cdef int col, row, k, best
    cdef double swap, factor
    for col in range(LINKS):
        best = col
        for row in range(col + 1, LINKS):
            if fabs(a[6 * row + col]) > fabs(a[6 * best + col]):
                best = row
        if not fabs(a[6 * best + col]) > SMALL_PIVOT:
            return -1
        for k in range(LINKS):
            swap = a[6 * col + k]
            a[6 * col + k] = a[6 * best + k]
            a[6 * best + k] = swap
        swap = b[col]
        b[col] = b[best]
        b[best] = swap
        for row in range(col + 1, LINKS):
            factor = a[6 * row + col] / a[6 * col + col]
            for k in range(col, LINKS):
                a[6 * row + k] -= factor * a[6 * col + k]
            b[row] -= factor * b[col]
    for row in range(LINKS - 1, -1, -1):
        for k in range(row + 1, LINKS):
            b[row] -= a[6 * row + k] * b[k]
        b[row] /= a[6 * row + row]
    return 0
