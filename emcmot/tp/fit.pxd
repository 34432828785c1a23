"""A spline through runs of short moves, where jerk is limited."""

from libc.stdint cimport int64_t

from emcmot.tp.model cimport TpState

cdef int run_goes_on(const TpState* tp) noexcept nogil
cdef int run_ahead(const TpState* tp, int64_t index) noexcept nogil
cdef int run_begins(const TpState* tp) noexcept nogil
cdef void begin_run(TpState* tp) noexcept nogil
cdef void close_run(TpState* tp) noexcept nogil
cdef int fit_next(TpState* tp) noexcept nogil
