"""C face of the cutter compensation: see compensation.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int set_compensation(State s, Block* b, int code) except -1
cdef int compensated_straight(State s, Block* b, int code, const double* end) except -1
cdef int compensated_arc(State s, Block* b, int code, const double* end) except -1
cdef int flush(State s) except -1
cdef int drop(State s) except -1
