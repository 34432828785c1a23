"""What native code needs to touch HAL pins and to be called by HAL threads; talks to nobody, it is all inline.

A pin's address (``hal_pin``) is that of its link word in the shared segment. The word holds the distance in bytes from
itself to the 8-byte cell in use: the pin's own, or its signal's. So a pin works at whatever address a process has mapped the
segment, and linking it is one atomic store. Parameters have a link word too, which never changes.

    from hal.cell cimport hal_at, hal_pin

    cdef void add(Sum* s, long period_ns) noexcept nogil:
        hal_at(s.out).f = hal_at(s.in0).f + hal_at(s.in1).f
"""

from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t, uint64_t


ctypedef union hal_cell:
    double f  # float
    int32_t s  # s32
    uint32_t u  # u32
    int64_t l  # s64
    uint64_t k  # u64
    uint8_t b  # bit

ctypedef int64_t* hal_pin

# What a thread calls each period; `period_ns` is the nominal period, whatever the clock's speed.
ctypedef void (*hal_function)(void* arg, long period_ns) noexcept nogil


cdef inline hal_cell* hal_at(hal_pin pin) noexcept nogil:
    """The cell that a pin reads or writes now."""
    return <hal_cell*>(<char*>pin + pin[0])
