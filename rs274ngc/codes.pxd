"""C face of the table of codes: see codes.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int enhance(State s, Block* b) except -1
cdef int check(State s, Block* b) except -1
cdef int run(State s, Block* b) except -1
