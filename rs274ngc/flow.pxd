"""C face of the program flow: see flow.pyx."""

from rs274ngc.source cimport Source
from rs274ngc.state cimport State

cdef enum:
    LEVELS_MAX = 10         # subroutine calls inside one another
    ARGUMENTS_MAX = 30


cdef class Flow:
    cdef State s
    cdef public Source source           # the file being read; None for commands typed in
    cdef public list search_path        # folders of subroutine files
    cdef public dict defined            # line of each label of a condition or loop, by subroutine and label
    cdef long line_start                # offset of the line that was read last
    cdef int read_raw(self) except -2
    cdef int jump(self, long position, int line) except -1
    cdef tuple read_head(self, int* at)
    cdef int o_word_at(self, int size) noexcept
    cdef int o_line(self, int at) except -1
    cdef int bare(self, str label, int at) except -1
    cdef double value(self, int* at, str keyword) except? -1.0e300
    cdef int end_of_line(self, int at) except -1
