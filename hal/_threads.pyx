"""Native threads of the realtime host: they call lists of functions by the clock and never take the GIL for it.

``hal.realtime`` is the only user. A `Scheduler` is one operating-system thread that runs one or more HAL threads by due
time, the faster first where two are due together. With realtime priority each HAL thread has a scheduler of its own; else one
scheduler runs them all, so that their functions interleave the same way every time, as on one realtime processor.

Due times count from an origin in nominal nanoseconds and are divided by the speed of the clock, so at any speed threads keep the
exact ratio of their periods. A scheduler that is late catches up by running without sleep, up to `CATCH_UP_NS`; what is
more is given up for all of its threads together.
"""

import os

from libc.stdint cimport int32_t, int64_t, uint8_t, uint64_t
from libc.stdlib cimport calloc, free
from posix.time cimport CLOCK_MONOTONIC, CLOCK_THREAD_CPUTIME_ID, TIMER_ABSTIME, clock_gettime, clock_nanosleep, timespec
from posix.unistd cimport usleep

from hal._mapping cimport announce, hal_segment, hal_thread
from hal._records cimport Item, Thread
from hal._shm cimport Segment
from hal.cell cimport hal_at, hal_cell, hal_function, hal_pin

from nml.errors import HalError

cdef extern from "<pthread.h>" nogil:
    ctypedef unsigned long pthread_t
    ctypedef struct pthread_attr_t:
        pass
    ctypedef struct pthread_mutex_t:
        pass
    struct sched_param:
        int sched_priority
    ctypedef struct cpu_set_t:
        pass
    int SCHED_FIFO, PTHREAD_EXPLICIT_SCHED
    int pthread_attr_init(pthread_attr_t*)
    int pthread_attr_destroy(pthread_attr_t*)
    int pthread_attr_setstacksize(pthread_attr_t*, size_t)
    int pthread_attr_setinheritsched(pthread_attr_t*, int)
    int pthread_attr_setschedpolicy(pthread_attr_t*, int)
    int pthread_attr_setschedparam(pthread_attr_t*, sched_param*)
    int pthread_attr_setaffinity_np(pthread_attr_t*, size_t, cpu_set_t*)
    int pthread_create(pthread_t*, pthread_attr_t*, void* (*)(void*) noexcept nogil, void*)
    int pthread_join(pthread_t, void**)
    int pthread_mutex_init(pthread_mutex_t*, void*)
    int pthread_mutex_lock(pthread_mutex_t*)
    int pthread_mutex_unlock(pthread_mutex_t*)

cdef extern from "<sched.h>" nogil:
    void CPU_ZERO(cpu_set_t*)
    void CPU_SET(int, cpu_set_t*)

cdef extern from "<sys/mman.h>" nogil:
    int MCL_CURRENT, MCL_FUTURE
    int mlockall(int flags)

cdef extern from *:
    """
    #if defined(__x86_64__)
    static inline int64_t ticks(void) { return (int64_t)__builtin_ia32_rdtsc(); }
    #else
    #include <time.h>
    static inline int64_t ticks(void) {
        struct timespec t;
        clock_gettime(CLOCK_MONOTONIC, &t);
        return t.tv_sec * 1000000000LL + t.tv_nsec;
    }
    #endif
    #define prefetch(where) __builtin_prefetch(where)
    #define atomic_load(where) __atomic_load_n(where, __ATOMIC_SEQ_CST)
    #define atomic_store(where, value) __atomic_store_n(where, value, __ATOMIC_SEQ_CST)
    #define atomic_swap(where, value) __atomic_exchange_n(where, value, __ATOMIC_SEQ_CST)
    """
    void prefetch(void* where) nogil
    int64_t ticks() nogil  # the processor's counter: a tenth of the cost of asking the system
    int32_t load_int "atomic_load"(int32_t* where) nogil
    void store_int "atomic_store"(int32_t* where, int32_t value) nogil
    uint8_t load_flag "atomic_load"(uint8_t* where) nogil
    void store_flag "atomic_store"(uint8_t* where, uint8_t value) nogil
    uint64_t load_count "atomic_load"(uint64_t* where) nogil
    void store_count "atomic_store"(uint64_t* where, uint64_t value) nogil
    Calls* load_calls "atomic_load"(Calls** where) nogil
    Calls* swap_calls "atomic_swap"(Calls** where, Calls* value) nogil

cdef enum:
    MAX_HAL_THREADS = 32
    STACK_BYTES = 1 << 20
    LONGEST_SLEEP_NS = 10_000_000  # how late a new thread may be seen
    AHEAD = 2  # functions
    FAR_AHEAD = 4
    GRACE_TRIES = 20000  # of 100 us: how long a function may take before its thread counts as stuck

cdef double CATCH_UP_NS = 50e6  # host time
cdef int64_t ANNOUNCE_NS = 900_000  # host time


cdef struct Call:
    hal_function code
    void* arg
    void* first  # what `arg` points to begins with: the first pin of a declared component
    hal_pin time  # s32, ns
    hal_cell* tmax  # s32, ns; a parameter's cell never moves
    hal_cell* increased  # bit
    int64_t longest  # ticks: what tmax stands for, so that most periods need not look at it
    bint was_increased

cdef struct Calls:
    int count
    Call call[0]  # and `FAR_AHEAD` empty ones, which are fetched ahead like others

cdef struct HalThread:
    hal_segment* segment
    hal_thread* record
    Calls* calls
    hal_pin time
    hal_pin tmax
    hal_pin beat
    double due  # nominal ns since the scheduler's origin
    int64_t period_ns
    int64_t announced_ns  # host time
    int64_t overworked_ns  # processor time of the longest period whose functions need more than there is; 0: none
    bint was_long  # the period before took longer than it may

cdef struct State:
    pthread_t thread
    pthread_mutex_t mutex  # of the list below; never held while sleeping or running
    HalThread* threads[MAX_HAL_THREADS]
    int count
    int32_t quit
    double speed
    int64_t origin  # host ns


cdef int64_t now_ns() noexcept nogil:
    cdef timespec t
    clock_gettime(CLOCK_MONOTONIC, &t)
    return <int64_t>t.tv_sec * 1000000000 + t.tv_nsec


cdef int64_t processor_ns() noexcept nogil:
    """Time that this thread has run; what others took from it does not count."""
    cdef timespec t
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t)
    return <int64_t>t.tv_sec * 1000000000 + t.tv_nsec


cdef void sleep_until(int64_t ns) noexcept nogil:
    cdef timespec t
    t.tv_sec = ns // 1000000000
    t.tv_nsec = ns % 1000000000
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL)


cdef enum:
    TICKS_SHIFT = 24

cdef double ns_per_tick = 1.0
cdef int64_t ns_of_many_ticks = 1 << TICKS_SHIFT


cdef void measure_ticks() noexcept nogil:
    """How long a tick of the processor's counter is, against the system's clock over 2 ms."""
    global ns_per_tick, ns_of_many_ticks
    cdef int64_t begin_ns = now_ns(), begin = ticks(), end_ns
    usleep(2000)
    end_ns = now_ns()
    ns_per_tick = (end_ns - begin_ns) / <double>(ticks() - begin)
    ns_of_many_ticks = <int64_t>(ns_per_tick * (1 << TICKS_SHIFT))


cdef inline int32_t nanoseconds(int64_t count) noexcept nogil:
    """Of so many ticks, in whole numbers: this is worked out for each function of each period."""
    return <int32_t>(count * ns_of_many_ticks >> TICKS_SHIFT)


cdef void* first_word(void** arg) noexcept nogil:
    return NULL if arg == NULL else arg[0]


cdef void keep_longest(Call* call, int32_t took, int64_t took_ticks) noexcept nogil:
    """A period longer than all before, or the one after it."""
    if took > call.tmax.s:
        call.tmax.s = took
        call.longest = took_ticks
        call.increased.b = call.was_increased = 1
    else:
        call.increased.b = call.was_increased = 0


cdef void judge_length(HalThread* thread, int32_t took, int64_t begun_at) noexcept nogil:
    """Note a period whose functions themselves need more time than it has.

    The processor's time is asked for (``begun_at``) only after a period that was too long, so a thread that keeps its time pays
    nothing, and one that was merely interrupted is not blamed.
    """
    if took <= thread.period_ns:
        thread.was_long = False
        return
    cdef int64_t needed = processor_ns() - begun_at if thread.was_long else 0
    if needed > max(thread.period_ns, thread.overworked_ns):
        thread.overworked_ns = needed
    thread.was_long = True


cdef void run_calls(HalThread* thread) noexcept nogil:
    """One period: every function in order, each with its time.

    Between two periods the processor's caches forget most of what functions touch, so it is fetched some functions ahead.
    """
    cdef Calls* calls = load_calls(&thread.calls)
    cdef int64_t begun_at = processor_ns() if thread.was_long else 0
    cdef int64_t begin = ticks()
    cdef int64_t before = begin
    cdef int64_t after = begin
    cdef Call* call
    cdef int32_t took
    cdef int i
    for i in range(calls.count):
        call = &calls.call[i]
        prefetch(call[FAR_AHEAD].arg)
        prefetch(call[FAR_AHEAD].time)
        prefetch(call[AHEAD].first)
        call.code(call.arg, thread.period_ns)
        after = ticks()
        took = nanoseconds(after - before)
        hal_at(call.time).s = took
        if after - before > call.longest or call.was_increased:
            keep_longest(call, took, after - before)
        before = after
    if calls.count > 0:  # one function each period: has somebody set its tmax?
        call = &calls.call[thread.record.cycles % <uint64_t>calls.count]
        call.longest = <int64_t>(call.tmax.s / ns_per_tick)
    took = nanoseconds(after - begin)
    hal_at(thread.time).s = took
    if took > hal_at(thread.tmax).s:
        hal_at(thread.tmax).s = took
    judge_length(thread, took, begun_at)
    hal_at(thread.beat).u += 1


cdef void run_cycle(HalThread* thread, int64_t begun_ns) noexcept nogil:
    """`running` is set before the flags and lists are read, so who changes them need only wait for it to fall.

    Who waits for changes is woken once in `ANNOUNCE_NS` at most, whatever the thread's period.
    """
    store_flag(&thread.record.running, 1)
    if load_int(&thread.segment.threads_running):
        run_calls(thread)
    store_count(&thread.record.cycles, thread.record.cycles + 1)
    store_flag(&thread.record.running, 0)
    if begun_ns - thread.announced_ns >= ANNOUNCE_NS:
        thread.announced_ns = begun_ns
        announce(thread.segment)


cdef HalThread* next_due(State* state) noexcept nogil:
    """The thread that is due first; the list is sorted by period, so the faster wins a tie."""
    cdef HalThread* first = NULL
    cdef int i
    for i in range(state.count):
        if first == NULL or state.threads[i].due < first.due:
            first = state.threads[i]
    return first


cdef void keep_time(State* state, HalThread* thread, int64_t late) noexcept nogil:
    """Count an overrun; give up, for all threads together, the time that cannot be caught up."""
    if late * state.speed > thread.period_ns:
        thread.record.overruns += 1
    if late > CATCH_UP_NS:
        state.origin += late
    thread.due += thread.period_ns


cdef void* scheduler_main(void* arg) noexcept nogil:
    cdef State* state = <State*>arg
    cdef HalThread* thread
    cdef int64_t start, now
    while not load_int(&state.quit):
        pthread_mutex_lock(&state.mutex)
        thread = next_due(state)
        now = now_ns()
        start = now + LONGEST_SLEEP_NS
        if thread != NULL:
            start = min(start, state.origin + <int64_t>(thread.due / state.speed))
        if start > now:
            pthread_mutex_unlock(&state.mutex)
            sleep_until(start)
            continue
        keep_time(state, thread, now - start)
        store_flag(&thread.record.running, 1)  # from here on `remove` waits
        pthread_mutex_unlock(&state.mutex)
        run_cycle(thread, now)
    return NULL


cdef class NativeThread:
    """A HAL thread as its scheduler knows it."""

    cdef HalThread* thread
    cdef Segment segment
    cdef readonly object record

    def __cinit__(self):
        self.thread = <HalThread*>calloc(1, sizeof(HalThread))
        if self.thread == NULL:
            raise MemoryError
        self.thread.calls = <Calls*>calloc(1, sizeof(Calls) + FAR_AHEAD * sizeof(Call))

    def __init__(self, Segment segment, Thread record, size_t time, size_t tmax, size_t beat):
        self.segment, self.record = segment, record
        self.thread.segment, self.thread.record = segment.at, record.thread
        self.thread.time, self.thread.tmax, self.thread.beat = <hal_pin>time, <hal_pin>tmax, <hal_pin>beat
        self.thread.period_ns = record.thread.period_ns

    def set_calls(self, list calls not None) -> bool:
        """Call these (code, arg, time, tmax, increased) addresses from the next period on; the old list is out of use then.

        False: a function of the old list has not returned for 2 s, so what it uses must not be freed.
        """
        cdef Calls* fresh = <Calls*>calloc(1, sizeof(Calls) + (len(calls) + FAR_AHEAD) * sizeof(Call))
        cdef Calls* old
        cdef int i
        cdef size_t code, arg, time, tmax, increased
        if fresh == NULL:
            raise MemoryError
        fresh.count = len(calls)
        for i, (code, arg, time, tmax, increased) in enumerate(calls):
            fresh.call[i] = Call(<hal_function>code, <void*>arg, first_word(<void**>arg), <hal_pin>time,
                                 hal_at(<hal_pin>tmax), hal_at(<hal_pin>increased), 0, True)
        old = swap_calls(&self.thread.calls, fresh)
        if not self.pause():
            return False
        free(old)
        return True

    @property
    def overworked_ns(self) -> int:
        """Processor time of the longest period whose functions needed more than the period has; 0: there was none."""
        return self.thread.overworked_ns

    def pause(self) -> bool:
        """Wait until the period that runs now, if any, is over; False where it does not end."""
        cdef uint64_t cycle = load_count(&self.thread.record.cycles)
        cdef int i
        for i in range(GRACE_TRIES):
            if not load_flag(&self.thread.record.running) or load_count(&self.thread.record.cycles) != cycle:
                return True
            with nogil:
                usleep(100)
        return False

    def __dealloc__(self):
        if self.thread != NULL:
            free(self.thread.calls)
            free(self.thread)


cdef class Scheduler:
    """One operating-system thread that runs HAL threads; `priority` 0: an ordinary one, `cpu` -1: any processor."""

    cdef State* state
    cdef list members

    def __cinit__(self):
        self.state = <State*>calloc(1, sizeof(State))
        if self.state == NULL:
            raise MemoryError
        self.members = []

    def __init__(self, double speed, int priority = 0, int cpu = -1):
        cdef pthread_attr_t attr
        cdef sched_param param
        cdef cpu_set_t cpus
        cdef int code
        self.state.speed = speed
        self.state.origin = now_ns()
        pthread_mutex_init(&self.state.mutex, NULL)
        pthread_attr_init(&attr)
        pthread_attr_setstacksize(&attr, STACK_BYTES)
        if priority > 0:
            param.sched_priority = priority
            pthread_attr_setinheritsched(&attr, PTHREAD_EXPLICIT_SCHED)
            pthread_attr_setschedpolicy(&attr, SCHED_FIFO)
            pthread_attr_setschedparam(&attr, &param)
        if cpu >= 0:
            CPU_ZERO(&cpus)
            CPU_SET(cpu, &cpus)
            pthread_attr_setaffinity_np(&attr, sizeof(cpus), &cpus)
        code = pthread_create(&self.state.thread, &attr, scheduler_main, self.state)
        pthread_attr_destroy(&attr)
        if code != 0:
            free(self.state)
            self.state = NULL
            raise HalError(f"cannot start a realtime thread: {os.strerror(code)}", -code)

    def add(self, NativeThread member) -> None:
        """Run this thread too, first at the next whole multiple of its period."""
        cdef HalThread* thread = member.thread
        cdef HalThread* moved
        cdef int i
        if self.state.count >= MAX_HAL_THREADS:
            raise HalError(f"no room for more than {MAX_HAL_THREADS} threads", -12)
        self.members.append(member)
        pthread_mutex_lock(&self.state.mutex)
        passed = (now_ns() - self.state.origin) * self.state.speed
        thread.due = (passed // thread.period_ns + 1) * thread.period_ns
        for i in range(self.state.count):
            if thread.period_ns < self.state.threads[i].period_ns:
                moved = self.state.threads[i]
                self.state.threads[i] = thread
                thread = moved
        self.state.threads[self.state.count] = thread
        self.state.count += 1
        pthread_mutex_unlock(&self.state.mutex)

    def remove(self, NativeThread member) -> None:
        """Run this thread no more; on return it is out of its functions."""
        cdef int i, kept = 0
        pthread_mutex_lock(&self.state.mutex)
        for i in range(self.state.count):
            if self.state.threads[i] != member.thread:
                self.state.threads[kept] = self.state.threads[i]
                kept += 1
        self.state.count = kept
        pthread_mutex_unlock(&self.state.mutex)
        if member.pause():
            self.members.remove(member)

    @property
    def empty(self) -> bool:
        return self.state.count == 0

    def close(self) -> None:
        """End the operating-system thread; waits for the period that it runs."""
        if self.state == NULL:
            return
        store_int(&self.state.quit, 1)
        cdef pthread_t thread = self.state.thread
        with nogil:
            pthread_join(thread, NULL)
        free(self.state)
        self.state = NULL


measure_ticks()


def lock_memory() -> bool:
    """Keep all memory of this process in RAM; False where the system refuses."""
    return mlockall(MCL_CURRENT | MCL_FUTURE) == 0
