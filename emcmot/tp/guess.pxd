"""The first guess of a speed plan."""

from libc.stdint cimport int64_t

from emcmot.tp.model cimport TpState

cdef int fixed(const TpState* tp, int64_t index) noexcept nogil
cdef double plan_cap(const TpState* tp, int64_t index) noexcept nogil
cdef void guess_plan(TpState* tp) noexcept nogil
