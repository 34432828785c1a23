"""Layout of a buffer's shared memory, and the functions with which native threads use it; see ``_shm.pyx``.

All C functions take the address of the buffer's head (``Channel.address``), never wait, never allocate and need no GIL.
"""

from libc.stddef cimport size_t
from libc.stdint cimport int32_t, int64_t, uint32_t, uint64_t

cdef extern from "<pthread.h>" nogil:
    ctypedef struct pthread_mutex_t:
        pass

cdef enum:
    KIND_SLOT = 1
    KIND_QUEUE = 2
    KIND_BROADCAST = 3
    SLOTS = 4
    NAME_LENGTH = 64

ctypedef struct Head:
    uint64_t version        # LAYOUT_VERSION; written last, so that whoever finds it finds a complete buffer
    uint64_t total          # bytes of the whole segment
    uint64_t capacity       # single slot: longest message; queue: bytes of the ring
    uint32_t kind
    uint32_t max_procs
    char name[NAME_LENGTH]
    uint64_t write_counter  # messages ever written; the last step of a write
    uint64_t tail[2]        # queue: where the next record goes, for an even and for an odd write counter
    uint64_t cleared        # single slot: messages up to this number are gone
    uint32_t signal         # futex: changes with every write
    uint32_t waiters        # not 0: somebody may sleep on it
    uint64_t read_counter   # queue: number of the last record taken (broadcast: dropped); the last step of a read
    uint64_t head[2]        # queue: where the oldest record starts, for an even and for an odd read counter
    uint64_t seen           # highest number that a reader has taken
    uint64_t shared_id      # broadcast: number of the last record taken by the readers that share one cursor
    uint64_t shared_at      # broadcast: its end; valid when shared_check == shared_id
    uint64_t shared_check
    pthread_mutex_t write_lock
    pthread_mutex_t read_lock

ctypedef struct Record:     # stands before every message, in a slot and in a queue
    uint64_t id             # write counter of the message; in a slot 0 while it is being written
    uint64_t length
    int64_t time_ns         # CLOCK_MONOTONIC when it was written
    int64_t writer          # process id

ctypedef struct Diag:       # one per possible process (c_num); counts of a buffer declared `diag`
    char name[32]
    int32_t pid
    int32_t last_type
    uint64_t reads
    uint64_t new_reads
    uint64_t writes
    uint64_t waits
    uint64_t bytes_read
    uint64_t bytes_written
    int64_t first_ns
    int64_t last_ns
    int64_t shortest_ns
    int64_t longest_ns

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
    cdef readonly int sleepers      # threads in `wait`
    cdef readonly uint64_t last     # number of the message that this channel has read or peeked last
    cdef uint64_t cursor_id
    cdef uint64_t cursor_at
    cdef bint shared
    cdef bint lock_writes
    cdef double timeout
    cdef readonly uint64_t missed

    cdef int lock(self, pthread_mutex_t* mutex) except -1
    cdef int check_open(self) except -1
    cdef object take_slot(self, bytearray into)
    cdef object take_queue(self, bint consume)
    cdef object take_broadcast(self, bint consume)
    cdef Record* newest(self)
    cdef void account(self, bint wrote, size_t size, int32_t type_id, bint new) noexcept
