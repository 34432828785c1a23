"""Motion along the planned path, one servo period at a time."""

from libc.stdint cimport int64_t

from emcmot.tp.model cimport TpState

cdef void advance(TpState* tp) noexcept nogil
cdef int64_t current_segment(const TpState* tp) noexcept nogil
cdef int64_t current_raw(const TpState* tp) noexcept nogil
cdef int64_t current_id(const TpState* tp) noexcept nogil
