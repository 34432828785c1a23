"""External offsets: a shift of each axis by HAL, on top of whatever the planners command."""

from emcmot.state cimport Motion

cdef void eoffset_cycle(Motion* m) noexcept nogil
cdef int eoffsets_still(Motion* m) noexcept nogil
cdef void forget_eoffsets(Motion* m) noexcept nogil
