"""The planned path: spans of the queued segments, and the largest speed at the start of each."""

from libc.stdint cimport int64_t

from emcmot.tp.model cimport Segment, TpState

cdef void extend(TpState* tp) noexcept nogil
cdef void refresh(TpState* tp) noexcept nogil
cdef void look_ahead(TpState* tp) noexcept nogil
cdef int look_at(TpState* tp, int64_t index, int* shielded) noexcept nogil
cdef void stop_looking(TpState* tp) noexcept nogil
cdef int body_left(const TpState* tp) noexcept nogil
cdef void sweep_caps(TpState* tp) noexcept nogil
cdef double exit_limit(const TpState* tp, int64_t index) noexcept nogil
cdef double feed_cap(const TpState* tp, int64_t index) noexcept nogil
cdef double full_cap(const TpState* tp, int64_t index) noexcept nogil
cdef double feed_scale(const TpState* tp, const Segment* seg) noexcept nogil
cdef double feed(const TpState* tp, const Segment* seg) noexcept nogil
