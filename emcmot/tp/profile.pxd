"""The speed plan as a quadratic spline."""

from libc.stdint cimport int64_t

from emcmot.tp.model cimport Cell, TpState

ctypedef struct Pace:        # speed along one span: w(x) = w + x (slope + x bend), x from its start
    double w
    double slope
    double bend


cdef inline double most_rate() noexcept nogil:
    """Largest rate of the plan's time to real time; velocities have room for it."""
    return 1.004


cdef double crawl(const TpState* tp, int64_t index) noexcept nogil
cdef int creeps(const TpState* tp, int64_t index) noexcept nogil
cdef int starts_at_rest(const TpState* tp, int64_t index) noexcept nogil
cdef int ends_at_rest(const TpState* tp, int64_t index, int64_t end) noexcept nogil
cdef Pace pace(const TpState* tp, int64_t index) noexcept nogil
cdef double fastest(const TpState* tp, int64_t index) noexcept nogil
cdef double pace_time(const TpState* tp, int64_t index) noexcept nogil
cdef double after(const Pace* p, double x, double time, double* v) noexcept nogil
cdef double time_to(const Pace* p, double x, double to) noexcept nogil
