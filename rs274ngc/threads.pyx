"""the spindle-synchronised moves"""

from rs274ngc.block cimport *
from rs274ngc.state cimport State, fail, fail_word


cdef int check_threading(State s, Block* b, int code) except -1:
    return fail(s, "Spindle-synchronised moves are not supported")


cdef int spindle_feed(State s, Block* b, int code) except -1:
    return fail(s, "Spindle-synchronised moves are not supported")


cdef int rigid_tap(State s, Block* b, int code) except -1:
    return fail(s, "Spindle-synchronised moves are not supported")


cdef int threading_cycle(State s, Block* b, int code) except -1:
    return fail(s, "Spindle-synchronised moves are not supported")

