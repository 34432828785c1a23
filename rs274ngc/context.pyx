"""the saved modal states"""

from rs274ngc.block cimport *
from rs274ngc.state cimport State, fail, fail_word


cdef int context(State s, Block* b, int code) except -1:
    return fail(s, "Saving the modal state is not supported")

