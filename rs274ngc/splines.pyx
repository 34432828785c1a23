"""the splines"""

from rs274ngc.block cimport *
from rs274ngc.state cimport State, fail, fail_word


cdef int cubic_spline(State s, Block* b, int code) except -1:
    return fail(s, "Splines are not supported")


cdef int quadratic_spline(State s, Block* b, int code) except -1:
    return fail(s, "Splines are not supported")


cdef int nurbs_point(State s, Block* b, int code) except -1:
    return fail(s, "Splines are not supported")


cdef int nurbs_end(State s, Block* b, int code) except -1:
    return fail(s, "Splines are not supported")

