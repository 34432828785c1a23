"""C face of the modes: see modes.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int set_plane(State s, Block* b, int code) except -1
cdef int set_units(State s, Block* b, int code) except -1
cdef int set_distance(State s, Block* b, int code) except -1
cdef int set_ijk_distance(State s, Block* b, int code) except -1
cdef int set_diameter_mode(State s, Block* b, int code) except -1
cdef int set_retract(State s, Block* b, int code) except -1
cdef int set_feed_mode(State s, Block* b, int code) except -1
cdef int set_spindle_mode(State s, Block* b, int code) except -1
cdef int set_control(State s, Block* b, int code) except -1
cdef int set_feed(State s, Block* b) except -1
cdef int set_speed(State s, Block* b) except -1
cdef int read_spindle(State s, Block* b, str message) except -1
cdef int synchronised_spindle(State s, Block* b, str message) except -1
cdef int read_spindles(State s, Block* b, str message, int* first, int* last) except -1
cdef int send_control(State s) except -1
cdef int check_spindle_mode(State s, Block* b, int code) except -1
