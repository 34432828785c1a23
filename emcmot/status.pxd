"""EMCMOT_STATUS out of the state of motion."""

from emcmot._messages cimport EMCMOT_STATUS
from emcmot.state cimport Motion

cdef void fill_status(EMCMOT_STATUS* s, const Motion* m) noexcept nogil
