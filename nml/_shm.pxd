"""Buffers in shared memory for native threads; see ``_shm.pyx``.

All C functions take the address of the buffer's head (``Channel.address``), never wait, never allocate and need no GIL.
"""

from libc.stddef cimport size_t
from libc.stdint cimport int32_t, int64_t, uint64_t

from nml._layout cimport Diag, Head, Record, pthread_mutex_t

cdef size_t queue_pop(void* buffer, void* dst, size_t capacity) noexcept nogil
cdef int queue_push(void* buffer, const void* src, size_t size) noexcept nogil
cdef void slot_write(void* buffer, const void* src, size_t size) noexcept nogil
cdef uint64_t write_count(void* buffer) noexcept nogil


cdef class Buffer:
    cdef Head* head
    cdef Diag* diag
    cdef char* data
    cdef object memory
    cdef readonly str name
    cdef bint closed
    cdef bint holding
    cdef readonly int sleepers      # threads in `wait`
    cdef readonly uint64_t last     # number of the message that this channel has read or peeked last
    cdef uint64_t cursor_id
    cdef uint64_t cursor_at
    cdef bint shared
    cdef bint observe
    cdef int64_t pid
    cdef readonly int64_t last_time_ns  # CLOCK_MONOTONIC at which that message was written
    cdef bint lock_writes
    cdef double timeout
    cdef readonly uint64_t missed

    cdef int lock(self, pthread_mutex_t* mutex) except -1
    cdef void let_go(self) noexcept
    cdef int check_open(self) except -1
    cdef object take_slot(self, bytearray into)
    cdef object take_queue(self, bint consume)
    cdef object take_observed(self)
    cdef object take_broadcast(self, bint consume)
    cdef Record* newest(self)
    cdef void account(self, bint wrote, size_t size, int32_t type_id, bint new) noexcept
