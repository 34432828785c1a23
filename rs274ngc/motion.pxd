"""C face of the motion codes: see motion.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int dwell(State s, Block* b, int code) except -1
cdef int check_dwell(State s, Block* b, int code) except -1
cdef int check_machine_coordinates(State s, Block* b, int code) except -1
cdef int straight(State s, Block* b, int code) except -1
cdef int arc(State s, Block* b, int code) except -1
cdef int probe(State s, Block* b, int code) except -1
cdef int check_home(State s, Block* b, int code) except -1
cdef int home(State s, Block* b, int code) except -1
cdef int reference_move(State s, Block* b, int code) except -1
cdef int cancel_motion(State s, Block* b, int code) except -1
cdef int check_turns(State s, Block* b, int code) except -1
