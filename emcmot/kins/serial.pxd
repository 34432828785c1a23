"""Chains of turning joints in Denavit and Hartenberg's terms; the texts are in ``serial.pyx``."""

cdef enum:
    LINKS = 6

ctypedef struct Link:
    double a         # along the x axis of the joint before
    double alpha     # rad, about it
    double d         # along the joint's own axis

cdef void frame_times_link(double* r, double* p, const Link* link, double theta) noexcept nogil
cdef void chain(const Link* links, const double* joints, double* r, double* p) noexcept nogil
cdef int solve6(double* a, double* b) noexcept nogil
