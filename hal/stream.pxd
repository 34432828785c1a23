"""Layout of a stream, for the components that fill and drain it; see ``stream.pyx``."""

from libc.stdint cimport int32_t, uint8_t, uint32_t, uint64_t

from hal.cell cimport hal_cell

cdef enum:
    MAX_COLUMNS = 21

cdef struct hal_fifo:
    uint64_t magic  # written last
    uint32_t depth  # samples
    uint32_t columns
    uint8_t types[MAX_COLUMNS]
    uint64_t written  # samples ever written; the writer's
    uint64_t read  # samples ever read; the reader's
    uint64_t attempts  # writes tried: the next sample's number
    int32_t overruns
    int32_t underruns
    hal_cell cells[0]  # per sample: its number, then one cell for each column


cdef hal_cell* fifo_room(hal_fifo* fifo) noexcept nogil
cdef void fifo_publish(hal_fifo* fifo) noexcept nogil
cdef hal_cell* fifo_next(hal_fifo* fifo) noexcept nogil
cdef void fifo_release(hal_fifo* fifo) noexcept nogil
cdef uint32_t fifo_depth(hal_fifo* fifo) noexcept nogil


cdef class Stream:
    cdef hal_fifo* fifo
    cdef size_t size
    cdef bytes path
    cdef bint owner
    cdef readonly str element_types
    cdef readonly long sampleno

    cdef _map(self, int fd)
    cdef _check(self)
