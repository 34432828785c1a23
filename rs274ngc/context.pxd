"""C face of the saved modal states: see context.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int context(State s, Block* b, int code) except -1
cdef int restore(State s, saved) except -1
