"""Layout of the HAL's shared segment and who may change it; ``_mapping.pyx`` has the rules. Threads and views cimport it."""

from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t, uint64_t

from hal.cell cimport hal_cell
from hal.port cimport hal_port

cdef extern from "<pthread.h>" nogil:
    ctypedef struct pthread_mutex_t:
        pass

cdef enum:
    NAME_SIZE = 48  # with the closing zero
    ARGS_SIZE = 2048
    MAX_COMPS = 1024
    MAX_PINS = 16384
    MAX_PARAMS = 8192
    MAX_SIGNALS = 8192
    MAX_FUNCTS = 4096
    MAX_THREADS = 32
    MAX_CALLS = 1024  # functions in one thread
    PORT_WORDS = 1 << 17  # 8 bytes each: buffers of all ports, with their headers

# Every record starts with `state`: 0 is a free slot; it is stored last when a record is made and first when it is freed,
# so a killed process leaves a whole record or none.
cdef struct hal_record:
    int32_t state
    uint32_t hash  # of the name
    char name[NAME_SIZE]

# What native code reaches through a `hal_pin`. The words of a component lie side by side, so that few cache lines hold them.
cdef struct hal_word:
    int64_t link  # bytes from here to the cell in use: the next one, or a signal's
    hal_cell cell

cdef struct hal_item:  # a pin or a parameter; its word has the same index
    hal_record head
    hal_cell safe  # taken when the owner dies, where has_safe
    int32_t owner  # component id
    int32_t signal  # index + 1 of the signal, 0 unlinked; `link` follows from it
    uint32_t alias_hash
    uint8_t type
    uint8_t dir
    uint8_t has_safe
    char alias[NAME_SIZE]
    int64_t pointer  # of a C component's pin: where in the segment its pointer to the cell in use lies; 0 for others
    uint64_t base  # where the owner's process has the segment

cdef struct hal_signal:
    hal_record head
    uint8_t type

cdef struct hal_comp:
    hal_record head
    int32_t id
    int32_t pid
    uint64_t start  # of the process, in clock ticks since boot: tells a pid from its next user
    uint8_t kind
    uint8_t ready
    char args[ARGS_SIZE]

cdef struct hal_funct:
    hal_record head
    int32_t owner
    int32_t users
    uint8_t uses_fp
    uint8_t reentrant
    uint64_t code  # in the realtime host's memory
    uint64_t arg

cdef struct hal_thread:
    hal_record head
    int32_t owner
    int32_t priority
    int64_t period_ns
    int32_t uses_fp
    int32_t calls
    int32_t call[MAX_CALLS]  # indices into functs, in calling order
    uint64_t cycles
    uint64_t overruns
    uint8_t running  # inside its functions

cdef struct hal_segment:
    uint64_t magic  # written last
    uint32_t version
    uint32_t size
    pthread_mutex_t mutex
    int32_t mutex_pid
    int32_t next_id
    int32_t locks  # HAL_LOCK_* bits
    int32_t threads_running
    int32_t host_pid
    uint64_t host_start
    int32_t recoveries  # times that a killed process was found to hold the mutex
    int32_t changes  # a futex: moves when values have changed while somebody watches
    int64_t watched_until_ns  # CLOCK_MONOTONIC: nobody watches later, so a killed watcher costs nothing
    int32_t used_comps, used_pins, used_params, used_signals, used_functs, used_threads  # slots ever used
    hal_word pin_words[MAX_PINS]
    hal_word param_words[MAX_PARAMS]
    hal_cell cells[MAX_SIGNALS]
    hal_comp comps[MAX_COMPS]
    hal_item pins[MAX_PINS]
    hal_item params[MAX_PARAMS]
    hal_signal signals[MAX_SIGNALS]
    hal_funct functs[MAX_FUNCTS]
    hal_thread threads[MAX_THREADS]
    uint64_t port_blocks[PORT_WORDS]  # hal_port records, one behind the other

cdef extern from *:
    """
    #define store_release(where, value) __atomic_store_n(where, value, __ATOMIC_RELEASE)
    #define load_acquire(where) __atomic_load_n(where, __ATOMIC_ACQUIRE)
    """
    void store_state "store_release"(int32_t* where, int32_t value) nogil
    int32_t load_state "load_acquire"(int32_t* where) nogil
    void store_link "store_release"(int64_t* where, int64_t value) nogil
    void store_pointer "store_release"(uint64_t* where, uint64_t value) nogil
    void store_magic "store_release"(uint64_t* where, uint64_t value) nogil
    uint64_t load_magic "load_acquire"(uint64_t* where) nogil
    int64_t load_time "load_acquire"(int64_t* where) nogil
    void store_time "store_release"(int64_t* where, int64_t value) nogil

cdef extern from *:
    """
    #include <linux/futex.h>
    #include <limits.h>
    #include <sys/syscall.h>
    #include <time.h>
    #include <unistd.h>
    static inline int64_t monotonic_ns(void) {
        struct timespec t;
        clock_gettime(CLOCK_MONOTONIC, &t);
        return t.tv_sec * 1000000000LL + t.tv_nsec;
    }
    static inline void wake_watchers(int32_t* word) {
        __atomic_add_fetch(word, 1, __ATOMIC_SEQ_CST);
        syscall(SYS_futex, word, FUTEX_WAKE, INT_MAX, NULL, NULL, 0);
    }
    static inline void sleep_on(int32_t* word, int32_t seen, int64_t ns) {
        struct timespec t = {ns / 1000000000LL, ns % 1000000000LL};
        syscall(SYS_futex, word, FUTEX_WAIT, seen, &t, NULL, 0);
    }
    """
    int64_t monotonic_ns() nogil
    void wake_watchers(int32_t* word) nogil
    void sleep_on(int32_t* word, int32_t seen, int64_t ns) nogil


cdef inline void announce(hal_segment* at) noexcept nogil:
    """Values have changed: wake who watches. Costs one look at memory where nobody does."""
    cdef int64_t until = load_time(&at.watched_until_ns)
    if until == 0:
        return
    if monotonic_ns() > until:
        store_time(&at.watched_until_ns, 0)
    else:
        wake_watchers(&at.changes)


cdef inline hal_word* word_of(hal_segment* at, hal_item* item) noexcept nogil:
    """The word of a pin or parameter."""
    cdef ssize_t index = item - &at.pins[0]
    if 0 <= index < MAX_PINS:
        return &at.pin_words[index]
    return &at.param_words[item - &at.params[0]]


cdef inline void point(hal_segment* at, hal_item* item, int signal) noexcept nogil:
    """Aim a pin's link at signal number `signal` - 1, or at the pin's own cell where it is 0."""
    cdef hal_word* word = word_of(at, item)
    cdef char* cell = <char*>&word.cell if signal == 0 else <char*>&at.cells[signal - 1]
    store_link(&word.link, cell - <char*>&word.link)
    if item.pointer:
        store_pointer(<uint64_t*>(<char*>at + item.pointer), item.base + <uint64_t>(cell - <char*>at))


cdef class Mapping:
    cdef hal_segment* at
    cdef int fd
    cdef int pid  # of the process that attached
    cdef bytes path

    cdef bint _try_attach(self) except -1
    cdef bint _leave(self)
    cdef void _make(self)
    cpdef detach(self)
    cdef int take(self) except -1
    cdef void give(self) noexcept
    cdef void _repair(self)
    cdef hal_port* new_port(self, uint32_t size) except NULL
