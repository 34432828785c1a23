"""Makes the speed plan where jerk is limited."""

from emcmot.tp.model cimport TpState


cdef void forget_plan(TpState* tp) noexcept nogil
cdef int planning(const TpState* tp) noexcept nogil
cdef void plan_anew(TpState* tp) noexcept nogil
cdef void plan_ahead(TpState* tp) noexcept nogil
