"""C face of the offsets: see offsets.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int check_g10(State s, Block* b, int code) except -1
cdef int set_data(State s, Block* b, int code) except -1
cdef int select_origin(State s, Block* b, int code) except -1
cdef int check_axis_offset(State s, Block* b, int code) except -1
cdef int axis_offset(State s, Block* b, int code) except -1
cdef int store_reference(State s, Block* b, int code) except -1
cdef int tool_length(State s, Block* b, int code) except -1
cdef int activate_origin(State s, int index) except -1
cdef int change_origin(State s, int index) except -1
cdef int shift_tool_offset(State s, tuple offset) except -1
cdef int send_origin(State s) except -1
cdef int send_g92(State s) except -1
cdef int send_tool_offset(State s) except -1
