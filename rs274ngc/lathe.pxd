"""C face of the lathe cycles: see lathe.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int lathe_cycle(State s, Block* b, int code) except -1
