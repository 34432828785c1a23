"""Cutter radius compensation: G40, G41, G42, G41.1, G42.1 and the moves under them."""

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_SIDE_OFF
from rs274ngc.state cimport State, fail, fail_word

cdef int SIDE_OFF = CANON_SIDE_OFF


cdef int set_compensation(State s, Block* b, int code) except -1:
    """G40 to G42.1"""
    if code == 400:
        s.canon.comment("interpreter: cutter radius compensation off")
        s.comp_side = SIDE_OFF
        return 0
    return fail(s, "Cutter radius compensation is not supported", b.g_at[7])


cdef int compensated_straight(State s, Block* b, int code, const double* end) except -1:
    return 0


cdef int compensated_arc(State s, Block* b, int code, const double* end) except -1:
    return 0


cdef int flush(State s) except -1:
    return 0
