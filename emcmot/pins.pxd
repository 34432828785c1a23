"""The HAL pins of motion, as a list of ``Pin``."""

from emcmot.state cimport Motion

cdef list pins_of(Motion* m, int unlock_mask)
