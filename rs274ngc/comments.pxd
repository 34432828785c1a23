"""C face of the comments: see comments.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int act_on_comment(State s, Block* b) except -1
