"""The equations for the speed plan."""

from libc.stdint cimport int64_t

from emcmot.tp.model cimport TpState

cdef double span_value(const TpState* tp, int64_t index, double share, double* worst) noexcept nogil
cdef void assemble_span(TpState* tp, int64_t index) noexcept nogil
cdef void clear_equations(TpState* tp) noexcept nogil
cdef void solve_equations(TpState* tp) noexcept nogil
cdef int is_within(TpState* tp, int64_t index) noexcept nogil
cdef double speed_reach(TpState* tp, int64_t index) noexcept nogil
