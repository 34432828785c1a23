"""the lathe cycles"""

from rs274ngc.block cimport *
from rs274ngc.state cimport State, fail, fail_word


cdef int lathe_cycle(State s, Block* b, int code) except -1:
    return fail(s, "Lathe cycles are not supported")

