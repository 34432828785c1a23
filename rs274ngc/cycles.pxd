"""C face of the canned cycles: see cycles.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int canned_cycle(State s, Block* b, int code) except -1
