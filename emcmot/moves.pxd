"""Commands that queue something in the planner."""

from emcmot._messages cimport EMCMOT_COMMAND
from emcmot.state cimport Motion

cdef int set_line(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int set_circle(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int probe(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int rigid_tap(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int clear_probe_flags(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int set_spindle_sync(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int set_dout(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int set_aout(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
