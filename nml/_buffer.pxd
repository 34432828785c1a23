"""A process's hold on a buffer; see ``_buffer.pyx``."""

from libc.stdint cimport int32_t, int64_t, uint64_t

from nml._layout cimport Diag, Head, Record, pthread_mutex_t


cdef class Buffer:
    cdef Head* head
    cdef Diag* diag
    cdef object memory
    cdef object keeper          # what must live as long as the memory is used
    cdef readonly str name
    cdef bint closed
    cdef bint holding
    cdef readonly int sleepers      # threads in `wait`
    cdef readonly uint64_t last     # number of the message that this channel has read or peeked last
    cdef uint64_t cursor_id
    cdef uint64_t cursor_at
    cdef uint64_t first             # broadcast: what had been read when this reader came
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
    cdef Record* newest(self) except? NULL
    cdef object take(self, bint consume)
    cdef object follow(self, bint consume)
    cdef void seek(self, uint64_t target) noexcept
    cdef object damaged(self, str what)
    cdef void account(self, bint wrote, size_t size, int32_t type_id, bint new) noexcept
