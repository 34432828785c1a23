"""A sign of life that no busy desktop delays: a native thread counts up a word of a buffer while its process works.

The reader, motion for one, sees that the word stands still as soon as the process has died or was halted. The thread needs
no GIL, so a long garbage collection or a large file does not silence it; but it falls silent as well when the process
has not called ``turn`` for a while, which means that its main loop hangs.
"""

from libc.stdint cimport int32_t, int64_t, uintptr_t
from libc.stdlib cimport free, malloc
from posix.time cimport nanosleep, timespec

from nml._layout cimport Head, nml_count, now_ns

from nml.errors import BufferError_

cdef extern from "<pthread.h>" nogil:
    ctypedef unsigned long pthread_t
    ctypedef struct pthread_attr_t:
        pass
    struct sched_param:
        int sched_priority
    int SCHED_FIFO, PTHREAD_EXPLICIT_SCHED
    int pthread_attr_init(pthread_attr_t*)
    int pthread_attr_destroy(pthread_attr_t*)
    int pthread_attr_setinheritsched(pthread_attr_t*, int)
    int pthread_attr_setschedpolicy(pthread_attr_t*, int)
    int pthread_attr_setschedparam(pthread_attr_t*, sched_param*)
    int pthread_create(pthread_t*, pthread_attr_t*, void* (*)(void*) noexcept nogil, void*)
    int pthread_join(pthread_t, void**)

cdef extern from "<signal.h>" nogil:
    ctypedef struct sigset_t:
        pass
    int SIG_BLOCK
    int sigfillset(sigset_t*)
    int pthread_sigmask(int, const sigset_t*, sigset_t*)

cdef extern from * nogil:
    """
    #define pulse_load(where) __atomic_load_n(where, __ATOMIC_ACQUIRE)
    #define pulse_store(where, value) __atomic_store_n(where, value, __ATOMIC_RELEASE)
    """
    int64_t load_time "pulse_load"(int64_t* where)
    void store_time "pulse_store"(int64_t* where, int64_t value)
    int32_t load_flag "pulse_load"(int32_t* where)
    void store_flag "pulse_store"(int32_t* where, int32_t value)

cdef struct Beat:
    Head* head
    pthread_t thread
    int64_t every_ns
    int64_t bound_ns     # without a turn for longer the process counts as hung
    int64_t turned_ns
    int32_t stop


cdef void* beat_main(void* arg) noexcept nogil:
    cdef Beat* beat = <Beat*>arg
    cdef sigset_t signals
    cdef timespec pause
    sigfillset(&signals)
    pthread_sigmask(SIG_BLOCK, &signals, NULL)  # they are for the main thread, which sleeps until one comes
    pause.tv_sec = beat.every_ns // 1_000_000_000
    pause.tv_nsec = beat.every_ns % 1_000_000_000
    while not load_flag(&beat.stop):
        if now_ns() - load_time(&beat.turned_ns) <= beat.bound_ns:
            nml_count(&beat.head.pulse)
        nanosleep(&pause, NULL)
    return NULL


cdef void* no_work(void* arg) noexcept nogil:
    return NULL


cdef int start_first(pthread_t* thread, void* (*work)(void*) noexcept nogil, void* arg) noexcept nogil:
    """Start a thread with the lowest realtime priority; an errno where that is not allowed."""
    cdef pthread_attr_t attr
    cdef sched_param param
    cdef int code
    pthread_attr_init(&attr)
    param.sched_priority = 1
    pthread_attr_setinheritsched(&attr, PTHREAD_EXPLICIT_SCHED)
    pthread_attr_setschedpolicy(&attr, SCHED_FIFO)
    pthread_attr_setschedparam(&attr, &param)
    code = pthread_create(thread, &attr, work, arg)
    pthread_attr_destroy(&attr)
    return code


cdef int start(Beat* beat) noexcept nogil:
    """Start the thread, with realtime priority where that is allowed; an errno."""
    if start_first(&beat.thread, beat_main, beat) == 0:
        return 0
    return pthread_create(&beat.thread, NULL, beat_main, beat)


def has_priority():
    """Would a pulse's thread have realtime priority here? Without, a healthy process may be late on a busy computer."""
    cdef pthread_t thread
    if start_first(&thread, no_work, NULL):
        return False
    pthread_join(thread, NULL)
    return True


cdef class Pulse:
    """Counts the pulse of a channel's buffer up every ``every_s`` while ``turn`` is called within ``bound_s``.

    Times are host time. Close it before the channel is closed.
    """

    cdef Beat* beat
    cdef object channel

    def __init__(self, channel, double every_s, double bound_s):
        cdef uintptr_t address = channel.address
        self.channel = channel
        self.beat = <Beat*>malloc(sizeof(Beat))
        if self.beat == NULL:
            raise MemoryError
        self.beat.head = <Head*>address
        self.beat.every_ns = <int64_t>(every_s * 1e9)
        self.beat.bound_ns = <int64_t>(bound_s * 1e9)
        self.beat.stop = 0
        self.turn()
        if start(self.beat):
            free(self.beat)
            self.beat = NULL
            raise BufferError_("no thread could be started for the sign of life")

    def turn(self):
        """The process's main loop has come around."""
        if self.beat != NULL:
            store_time(&self.beat.turned_ns, now_ns())

    def close(self):
        """End the thread; a second call does nothing."""
        if self.beat == NULL:
            return
        store_flag(&self.beat.stop, 1)
        with nogil:
            pthread_join(self.beat.thread, NULL)
        free(self.beat)
        self.beat = NULL

    def __dealloc__(self):
        self.close()
