"""A program file read line by line: any line can be gone back to, and no more than one chunk is in memory."""

import os

from libc.string cimport memchr, memcpy
from posix.unistd cimport pread

from nml.errors import InterpError


cdef class Source:
    """An open program; ``position`` and ``line`` say where the next line begins, and may be set."""

    def __cinit__(self, str path):
        self.fd = -1
        self.path = path
        try:
            self.fd = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
            if os.path.isdir(path):
                raise IsADirectoryError(path)
            facts = os.fstat(self.fd)
            self.bytes = facts.st_size
            self.version = (facts.st_dev, facts.st_ino, facts.st_size, facts.st_mtime_ns)
        except OSError:
            raise InterpError(f"Unable to open file <{path}>") from None

    def __dealloc__(self):
        self.close()

    def close(self):
        """Give the file back."""
        if self.fd >= 0:
            os.close(self.fd)
            self.fd = -1

    cdef bint fill(self, long position) except -1:
        """Have the chunk at ``position`` in the buffer; False at the end of the file."""
        cdef ssize_t got = pread(self.fd, self.buffer, CHUNK, position)
        if got < 0:
            raise InterpError(f"Unable to read file <{self.path}>")
        self.start = position
        self.size = <int>got
        return got > 0

    cdef int next_line(self, char* out, int capacity, int longest) except -3:
        """Copy the next line without its end to ``out``: its length; -1 at the end of the file, -2 if it is too long."""
        cdef int used = 0, room
        cdef long at
        cdef char* begin
        cdef char* end
        cdef bint any_bytes = False
        while True:
            at = self.position - self.start
            if at < 0 or at >= self.size:
                if not self.fill(self.position):
                    if not any_bytes:
                        return -1
                    break
                at = 0
            any_bytes = True
            begin = self.buffer + at
            end = <char*>memchr(begin, c'\n', self.size - at)
            room = <int>((end - begin) if end != NULL else self.size - at)
            if used < capacity - 1:
                memcpy(out + used, begin, min(room, capacity - 1 - used))
            used += room
            self.position += room
            if end != NULL:
                self.position += 1
                break
            if used > (1 << 30):
                used = capacity     # no sum of such lengths overflows
        self.line += 1
        if used > longest:
            out[min(used, capacity - 1)] = 0
            return -2
        if used > 0 and out[used - 1] == c'\r':
            used -= 1
        out[used] = 0
        return used
