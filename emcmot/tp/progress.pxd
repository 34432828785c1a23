"""How far the machine has come along the planned path."""

from libc.stdint cimport int64_t

from emcmot.tp.model cimport Span, TpState

cdef double reached(const TpState* tp, const Span* span) noexcept nogil
cdef int64_t current_segment(const TpState* tp) noexcept nogil
cdef int64_t current_raw(const TpState* tp) noexcept nogil
cdef int64_t current_id(const TpState* tp) noexcept nogil
cdef int holding(const TpState* tp) noexcept nogil
cdef double target_w(TpState* tp) noexcept nogil
cdef int waiting(TpState* tp) noexcept nogil
cdef int next_span(TpState* tp, Span* span) noexcept nogil
cdef void run_tap(TpState* tp, const Span* span) noexcept nogil
