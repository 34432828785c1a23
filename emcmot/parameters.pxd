"""The SET_xxx family of commands, declared once each."""

from emcmot._messages cimport EMCMOT_COMMAND
from emcmot.state cimport Motion

cdef int set_parameters(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
