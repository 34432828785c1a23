"""C face of the spindle-synchronised moves: see threads.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int check_g76(State s, Block* b, int code) except -1
cdef int check_threading(State s, Block* b, int code) except -1
cdef int spindle_feed(State s, Block* b, int code) except -1
cdef int rigid_tap(State s, Block* b, int code) except -1
cdef int threading_cycle(State s, Block* b, int code) except -1
