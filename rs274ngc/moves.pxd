"""C face of the moves: see moves.pyx."""

from rs274ngc.canon cimport Canon
from rs274ngc.coords cimport Coordinates

cdef enum:
    CHAIN_MAX = 100


cdef struct Limits:
    double vel, acc
    bint cartesian


cdef struct Arc:
    double start[9]
    double end[9]
    double centre[3]
    double normal[3]
    double radius, angle, height


cdef class MoveCanon(Canon):
    cdef readonly Coordinates coords
    cdef readonly int motion_mode, term_cond
    cdef readonly double tolerance, naivecam_tolerance, linear_feed, angular_feed, turn_feed
    cdef double join_tolerance
    cdef readonly bint synched
    cdef readonly int feed_mode, feed_spindle
    cdef public int indexer
    cdef int axis_mask
    cdef double max_vel[9]
    cdef double max_acc[9]
    cdef double end[9]
    cdef double chain[CHAIN_MAX][9]
    cdef int chain_length, chain_line

    cpdef void line(self, int line, int kind, double x, double y, double z, double a, double b, double c, double u, double v, double w, double vel, double ini_maxvel, double acc) except *
    cpdef void arc(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, double cx, double cy, double cz, double nx, double ny, double nz, int turn, double vel, double ini_maxvel, double acc) except *
    cpdef void probe(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, double vel, double ini_maxvel, double acc, int probe_type) except *
    cpdef void tap(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, double vel, double ini_maxvel, double acc, double scale) except *
    cdef void _limit_joining(self) noexcept
    cdef double* programmed_end(self) noexcept nogil
    cpdef void flush(self) except *
    cdef Limits straight_limits(self, const double* start, const double* to) noexcept nogil
    cdef Limits arc_limits(self, const Arc* arc) noexcept nogil
    cdef double requested_velocity(self, Limits limits) noexcept nogil
    cdef void feed_to(self, int line, const double* to) except *
    cdef bint may_join(self, const double* to) noexcept nogil
    cdef void join(self, int line, const double* to) except *
    cdef bint arc_may_join(self, const Arc* arc) noexcept nogil
    cdef void join_arc(self, int line, const Arc* arc) except *
    cdef void send_line(self, int line, int kind, const double* to) except *
