"""C face of the splines: see splines.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int cubic_spline(State s, Block* b, int code) except -1
cdef int quadratic_spline(State s, Block* b, int code) except -1
cdef int nurbs_point(State s, Block* b, int code) except -1
cdef int nurbs_end(State s, Block* b, int code) except -1
cdef int nurbs_knot(State s, Block* b, int code) except -1
