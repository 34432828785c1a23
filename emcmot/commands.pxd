"""The command handler: EMCMOT_COMMAND records in, effects on the state and a verdict out."""

from libc.stddef cimport size_t

from emcmot._messages cimport EMCMOT_COMMAND
from emcmot.state cimport Motion

cdef void sign_of_life(Motion* m) noexcept nogil
cdef void run(Motion* m, const EMCMOT_COMMAND* c, size_t size) noexcept nogil
