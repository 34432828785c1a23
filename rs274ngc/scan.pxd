"""C face of the scanner: see scan.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef enum:
    DEPTH_MAX = 120         # nested brackets, signs and indirect parameters of one value

cdef int strip(State s) except -1
cdef int scan_words(State s, int i) except -1
cdef int read_value(State s, int* i, double* out, int depth=*) except -1
cdef int read_integer(State s, int* i, int* out) except -1
cdef int read_unsigned(State s, int* i, int* out) except -1
cdef str read_name(State s, int* i)
cdef int skip_comments(State s, int* i) except -1
