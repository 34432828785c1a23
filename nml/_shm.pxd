"""Buffers in shared memory for native threads; see ``_shm.pyx``.

The functions take the address of the buffer's head (``Channel.address``), never wait, never allocate and need no GIL.
"""

from libc.stddef cimport size_t
from libc.stdint cimport int64_t, uint64_t

from nml._layout cimport Head

# For a thread that is the only writer or the only reader of its buffer.
cdef size_t queue_pop(void* buffer, void* dst, size_t capacity) noexcept nogil
cdef int queue_push(void* buffer, const void* src, size_t size) noexcept nogil
cdef void* slot_begin(void* buffer) noexcept nogil
cdef void slot_commit(void* buffer, size_t size) noexcept nogil
cdef void slot_write(void* buffer, const void* src, size_t size) noexcept nogil
cdef uint64_t write_count(void* buffer) noexcept nogil
cdef uint64_t pulse_count(void* buffer) noexcept nogil

# What they are made of; for nml._buffer, which holds the lock of the side that it is on.
cdef int queue_append(Head* head, const void* src, size_t size, int64_t writer) noexcept nogil
cdef void ring_write(Head* head, uint64_t tail, const char* src, uint64_t size, int64_t writer) noexcept nogil
cdef void queue_commit_read(Head* head, uint64_t number, uint64_t start) noexcept nogil
cdef void queue_forget(Head* head) noexcept nogil
cdef void drop_until_room(Head* head, uint64_t tail, uint64_t size) noexcept nogil
