"""C face of the program files: see source.pyx."""

cdef enum:
    CHUNK = 65536


cdef class Source:
    cdef public str path
    cdef int fd
    cdef long start             # offset in the file of the buffer's first byte
    cdef int size               # bytes in the buffer
    cdef public long position   # offset of the next line
    cdef public int line        # number of lines before it
    cdef readonly long bytes    # size of the file
    cdef readonly tuple version # another one when the file has been edited or replaced
    cdef char[CHUNK] buffer
    cdef int next_line(self, char* out, int capacity, int longest) except -3
    cdef bint fill(self, long position) except -1
