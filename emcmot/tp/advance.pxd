"""Motion along the planned path, one servo period at a time."""

from emcmot.tp.model cimport TpState

cdef void advance(TpState* tp) noexcept nogil
