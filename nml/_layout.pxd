"""Layout of a buffer's memory and the steps that reading and writing are made of; inlined into ``_shm.pyx``.

A segment is ``Head``, one ``Diag`` per possible process, then the data: four slots, or a ring of records. Positions in
a ring count bytes for ever; where one lies is its remainder. Records start at multiples of RECORD_STEP, so that their
heads are never split by the end of the ring.
"""

from libc.stdint cimport int32_t, int64_t, uint32_t, uint64_t
from libc.string cimport memcpy
from posix.time cimport CLOCK_MONOTONIC, clock_gettime, timespec

cdef extern from "<pthread.h>" nogil:
    ctypedef struct pthread_mutex_t:
        pass

cdef enum:
    ALIGNMENT = 64
    RECORD_STEP = 32
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
    uint64_t reserved       # queue: end of the record that is being written, or was written last
    uint64_t cleared        # single slot: messages up to this number are gone
    uint32_t signal         # futex: changes with every write
    uint32_t waiters        # not 0: somebody may sleep on it
    uint64_t read_counter   # queue: number of the last record taken (broadcast: dropped); the last step of a read
    uint64_t head[2]        # queue: where the oldest record starts, for an even and for an odd read counter
    uint64_t seen           # highest number that a reader has taken
    uint64_t shared_id      # broadcast: number of the last record taken by the readers that share one cursor
    uint64_t pulse          # counted up by a writer that lives (nml.pulse)
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

cdef extern from * nogil:
    """
    #include <errno.h>
    #include <pthread.h>
    #include <time.h>
    #include <unistd.h>
    #include <limits.h>
    #include <sys/syscall.h>
    #include <linux/futex.h>

    #define nml_load(p) __atomic_load_n((p), __ATOMIC_ACQUIRE)
    #define nml_store(p, v) __atomic_store_n((p), (v), __ATOMIC_RELEASE)
    #define nml_count(p) __atomic_add_fetch((p), 1, __ATOMIC_RELEASE)
    #define nml_fence() __atomic_thread_fence(__ATOMIC_SEQ_CST)

    static void nml_store_max(uint64_t *p, uint64_t v) {
        uint64_t old = __atomic_load_n(p, __ATOMIC_RELAXED);
        while (old < v && !__atomic_compare_exchange_n(p, &old, v, 0, __ATOMIC_RELEASE, __ATOMIC_RELAXED)) {}
    }
    static void nml_wake(uint32_t *word, uint32_t *waiters) {
        __atomic_add_fetch(word, 1, __ATOMIC_SEQ_CST);
        if (__atomic_exchange_n(waiters, 0, __ATOMIC_SEQ_CST))
            syscall(SYS_futex, word, FUTEX_WAKE, INT_MAX, NULL, NULL, 0);
    }
    static int nml_sleep(uint32_t *word, uint32_t *waiters, uint32_t expected, long ns) {
        struct timespec t = {ns / 1000000000L, ns % 1000000000L};
        __atomic_store_n(waiters, 1, __ATOMIC_SEQ_CST);
        if (__atomic_load_n(word, __ATOMIC_SEQ_CST) != expected) return 0;
        return syscall(SYS_futex, word, FUTEX_WAIT, expected, &t, NULL, 0);
    }
    static int nml_mutex_init(pthread_mutex_t *m) {
        pthread_mutexattr_t a;
        pthread_mutexattr_init(&a);
        pthread_mutexattr_setpshared(&a, PTHREAD_PROCESS_SHARED);
        pthread_mutexattr_setrobust(&a, PTHREAD_MUTEX_ROBUST);
        int failed = pthread_mutex_init(m, &a);
        pthread_mutexattr_destroy(&a);
        return failed;
    }
    static int nml_lock_until(pthread_mutex_t *m, double seconds) {
        if (seconds < 0) return pthread_mutex_lock(m);
        struct timespec t;
        clock_gettime(CLOCK_MONOTONIC, &t);
        long ns = t.tv_nsec + (long)((seconds - (long)seconds) * 1e9);
        t.tv_sec += (long)seconds + ns / 1000000000L;
        t.tv_nsec = ns % 1000000000L;
        return pthread_mutex_clocklock(m, CLOCK_MONOTONIC, &t);
    }
    """
    uint64_t nml_load(uint64_t* p)
    uint32_t nml_load32 "nml_load"(uint32_t* p)
    void nml_store(uint64_t* p, uint64_t v)
    uint64_t nml_count(uint64_t* p)
    void nml_fence()
    void nml_store_max(uint64_t* p, uint64_t v)
    void nml_wake(uint32_t* word, uint32_t* waiters)
    int nml_sleep(uint32_t* word, uint32_t* waiters, uint32_t expected, long ns)
    int nml_mutex_init(pthread_mutex_t* m)
    int nml_lock_until(pthread_mutex_t* m, double seconds)
    int pthread_mutex_trylock(pthread_mutex_t* m)
    int pthread_mutex_unlock(pthread_mutex_t* m)
    int pthread_mutex_consistent(pthread_mutex_t* m)
    int EOWNERDEAD


cdef inline uint64_t aligned(uint64_t size) noexcept nogil:
    return (size + ALIGNMENT - 1) & ~<uint64_t>(ALIGNMENT - 1)


cdef inline char* data_of(Head* head) noexcept nogil:
    return <char*>head + aligned(sizeof(Head)) + aligned(head.max_procs * sizeof(Diag))


cdef inline int64_t now_ns() noexcept nogil:
    cdef timespec t
    clock_gettime(CLOCK_MONOTONIC, &t)
    return <int64_t>t.tv_sec * 1_000_000_000 + t.tv_nsec


cdef inline Record* slot_of(Head* head, uint64_t number) noexcept nogil:
    return <Record*>(data_of(head) + (number % SLOTS) * aligned(sizeof(Record) + head.capacity))


cdef inline uint64_t record_size(uint64_t length) noexcept nogil:
    return (sizeof(Record) + length + RECORD_STEP - 1) & ~<uint64_t>(RECORD_STEP - 1)


cdef inline Record* record_at(Head* head, uint64_t at) noexcept nogil:
    """The record that starts at a position of the endless tape that the ring shows; never split, see RECORD_STEP."""
    return <Record*>(data_of(head) + at % head.capacity)


cdef inline void ring_put(Head* head, uint64_t at, const char* src, uint64_t size) noexcept nogil:
    cdef uint64_t start = at % head.capacity
    cdef uint64_t first = min(size, head.capacity - start)
    memcpy(data_of(head) + start, src, first)
    if first < size:
        memcpy(data_of(head), src + first, size - first)


cdef inline void ring_get(Head* head, uint64_t at, char* dst, uint64_t size) noexcept nogil:
    cdef uint64_t start = at % head.capacity
    cdef uint64_t first = min(size, head.capacity - start)
    memcpy(dst, data_of(head) + start, first)
    if first < size:
        memcpy(dst + first, data_of(head), size - first)


cdef inline uint64_t paired(uint64_t* counter, uint64_t* position, uint64_t* at) noexcept nogil:
    """A committed counter and, in ``at``, the position that belongs to it."""
    cdef uint64_t again, number = nml_load(counter)
    while True:
        at[0] = nml_load(&position[number & 1])
        again = nml_load(counter)
        if again == number:
            return number
        number = again
