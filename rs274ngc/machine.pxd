"""C face of the machine functions: see machine.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int spindle(State s, Block* b, int code) except -1
cdef int orient(State s, Block* b, int code) except -1
cdef int coolant(State s, Block* b, int code) except -1
cdef int overrides(State s, Block* b, int code) except -1
cdef int output(State s, Block* b, int code) except -1
cdef int analog_output(State s, Block* b, int code) except -1
cdef int wait_input(State s, Block* b, int code) except -1
cdef int program_stop(State s, Block* b, int code) except -1
cdef int program_end(State s, Block* b, int code) except -1
cdef int user_code(State s, Block* b, int code) except -1
cdef int check_orient(State s, Block* b, int code) except -1
cdef int subprogram_end(State s, Block* b, int code) except -1
