"""Byte streams between two pins, for native code: the buffer of a signal of type port; all inline.

The cell of such a signal holds the distance in bytes from itself to the buffer, 0 before ``sets`` has given it a size. One
writer, one reader, no lock: each moves only its own counter.
"""

from libc.stdint cimport uint32_t, uint64_t
from libc.string cimport memcpy

from hal.cell cimport hal_at, hal_pin

cdef extern from *:
    """
    #define port_store(where, value) __atomic_store_n(where, value, __ATOMIC_RELEASE)
    #define port_load(where) __atomic_load_n(where, __ATOMIC_ACQUIRE)
    """
    void port_store(uint64_t* where, uint64_t value) nogil
    uint64_t port_load(uint64_t* where) nogil

cdef struct hal_port:
    uint32_t room  # bytes of the block behind this header
    uint32_t size  # of the buffer; 0: the block is free
    uint64_t read  # bytes ever read; the reader's
    uint64_t written  # bytes ever written; the writer's
    char bytes[0]


cdef inline hal_port* port_of(hal_pin pin) noexcept nogil:
    """The buffer that a pin reads or writes now; NULL where it has none."""
    cdef char* cell = <char*>hal_at(pin)
    return NULL if hal_at(pin).l == 0 else <hal_port*>(cell + hal_at(pin).l)


cdef inline uint32_t port_readable(hal_port* port) noexcept nogil:
    """Bytes that wait to be read."""
    return 0 if port == NULL else <uint32_t>(port_load(&port.written) - port_load(&port.read))


cdef inline uint32_t port_writable(hal_port* port) noexcept nogil:
    """Bytes for which there is room; as with LinuxCNC's ports, one byte of the size is never used."""
    return 0 if port == NULL or port.size == 0 else port.size - 1 - port_readable(port)


cdef inline bint port_peek(hal_port* port, char* into, uint32_t count) noexcept nogil:
    """Copy the next bytes and leave them there; False where there are not as many."""
    cdef uint32_t start, first
    if port == NULL or port_readable(port) < count:
        return False
    start = port.read % port.size
    first = min(count, port.size - start)
    memcpy(into, port.bytes + start, first)
    memcpy(into + first, port.bytes, count - first)
    return True


cdef inline bint port_commit(hal_port* port, uint32_t count) noexcept nogil:
    """Drop the next bytes; False where there are not as many."""
    if port == NULL or port_readable(port) < count:
        return False
    port_store(&port.read, port.read + count)
    return True


cdef inline bint port_write(hal_port* port, const char* source, uint32_t count) noexcept nogil:
    """Append all bytes or, where there is no room for them, none."""
    cdef uint32_t start, first
    if port == NULL or port_writable(port) < count:
        return False
    start = port.written % port.size
    first = min(count, port.size - start)
    memcpy(port.bytes + start, source, first)
    memcpy(port.bytes, source + first, count - first)
    port_store(&port.written, port.written + count)
    return True


cdef inline void port_clear(hal_port* port) noexcept nogil:
    """Drop all that waits; for the reader."""
    if port != NULL:
        port_store(&port.read, port_load(&port.written))
