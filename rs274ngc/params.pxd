"""C face of the parameters: see params.pyx."""

from rs274ngc.state cimport State

cdef int get_numbered(State s, int number, double* out, int at) except -1
cdef int set_numbered(State s, int number, double value) except -1
cdef double get_named(State s, str name, int at) except? -1.0e300
cdef int set_named(State s, str name, double value, int at) except -1
cdef bint named_exists(State s, str name) except -1
