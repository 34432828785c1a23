"""The HAL's shared segment as memory: its life, its mutex and its header; ``hal._shm`` adds the records.

* Records lie in fixed arrays and hold indices and distances, never addresses, so the segment works wherever it is mapped.
* One robust mutex guards structural changes. A process killed while holding it is noticed by the next one, which repairs
  what is derived (`link` words follow from `signal` indices) and goes on. Values of pins and signals need no lock.
* Each process holds a shared flock on the segment while it is attached; the last to leave removes it.
"""

from libc.errno cimport errno
from posix.fcntl cimport O_CLOEXEC, O_CREAT, O_RDWR, posix_fallocate
from posix.mman cimport MAP_FAILED, MAP_SHARED, PROT_READ, PROT_WRITE, mmap, munmap
from posix.time cimport CLOCK_MONOTONIC, clock_gettime, clockid_t, timespec
from posix.unistd cimport close, getpid, usleep

from hal.port cimport hal_port

from nml.errors import HalError
from nml.namespace import shm_name

cdef extern from "<errno.h>" nogil:
    int EOWNERDEAD, ETIMEDOUT

cdef extern from "<sys/mman.h>" nogil:
    int shm_open(const char* name, int flags, unsigned int mode)
    int shm_unlink(const char* name)

cdef extern from "<sys/file.h>" nogil:
    int flock(int fd, int operation)
    int LOCK_SH, LOCK_EX, LOCK_NB, LOCK_UN

cdef extern from "<sys/stat.h>" nogil:
    ctypedef struct struct_stat "struct stat":
        long st_nlink
        long st_size
    int fstat(int fd, struct_stat* buf)

cdef extern from "<pthread.h>" nogil:
    ctypedef struct pthread_mutexattr_t:
        pass
    int PTHREAD_PROCESS_SHARED, PTHREAD_MUTEX_ROBUST, PTHREAD_MUTEX_RECURSIVE
    int pthread_mutexattr_init(pthread_mutexattr_t*)
    int pthread_mutexattr_setpshared(pthread_mutexattr_t*, int)
    int pthread_mutexattr_setrobust(pthread_mutexattr_t*, int)
    int pthread_mutexattr_settype(pthread_mutexattr_t*, int)
    int pthread_mutex_init(pthread_mutex_t*, pthread_mutexattr_t*)
    int pthread_mutex_clocklock(pthread_mutex_t*, clockid_t, timespec*)
    int pthread_mutex_unlock(pthread_mutex_t*)
    int pthread_mutex_consistent(pthread_mutex_t*)

cdef enum:
    VERSION = 2
    ATTACH_TRIES = 5000  # of 1 ms: how long another process may take to set the segment up
    LOCK_SECONDS = 5

cdef int64_t WATCH_NS = 1_000_000_000

cdef uint64_t MAGIC = 0x6C61682E636D6579


cdef class Mapping:
    """The mapped segment of this process's namespace; as a context manager it holds the mutex."""

    def __cinit__(self):
        self.fd = -1

    def __init__(self, str name = "hal"):
        self.path = shm_name(name).encode()
        self.pid = getpid()
        cdef int tries
        for tries in range(ATTACH_TRIES):
            if self._try_attach():
                return
            with nogil:
                usleep(1000)
        raise HalError(f"cannot attach the HAL segment {self.path.decode()}: another process does not finish making it")

    cdef bint _try_attach(self) except -1:
        cdef struct_stat st
        cdef void* where
        cdef bint fresh
        self.fd = shm_open(self.path, O_RDWR | O_CREAT | O_CLOEXEC, 0o600)
        if self.fd < 0:
            raise HalError(f"cannot open shared memory {self.path.decode()} (errno {errno})", -errno)
        flock(self.fd, LOCK_SH)
        fstat(self.fd, &st)
        fresh = st.st_size == 0
        if st.st_nlink == 0 or (fresh and flock(self.fd, LOCK_EX | LOCK_NB) != 0):
            return self._leave()
        if fresh and posix_fallocate(self.fd, 0, sizeof(hal_segment)) != 0:
            raise HalError(f"no room for the {sizeof(hal_segment)} bytes of the HAL segment in /dev/shm", -12)
        if not fresh and st.st_size != sizeof(hal_segment):
            self._leave()
            raise HalError(f"{self.path.decode()} was made by another version; end that session (halrun -U) first")
        where = mmap(NULL, sizeof(hal_segment), PROT_READ | PROT_WRITE, MAP_SHARED, self.fd, 0)
        if where == MAP_FAILED:
            raise HalError("cannot map the HAL segment", -12)
        self.at = <hal_segment*>where
        if load_magic(&self.at.magic) != MAGIC:
            # Only with the exclusive lock: its maker died before it was done.
            if not fresh and flock(self.fd, LOCK_EX | LOCK_NB) != 0:
                munmap(self.at, sizeof(hal_segment))
                self.at = NULL
                return self._leave()
            self._make()
        flock(self.fd, LOCK_SH)
        return True

    cdef bint _leave(self):
        close(self.fd)
        self.fd = -1
        return False

    cdef void _make(self):
        cdef pthread_mutexattr_t attr
        pthread_mutexattr_init(&attr)
        pthread_mutexattr_setpshared(&attr, PTHREAD_PROCESS_SHARED)
        pthread_mutexattr_setrobust(&attr, PTHREAD_MUTEX_ROBUST)
        pthread_mutexattr_settype(&attr, PTHREAD_MUTEX_RECURSIVE)
        pthread_mutex_init(&self.at.mutex, &attr)
        self.at.version = VERSION
        self.at.size = sizeof(hal_segment)
        self.at.next_id = 2
        (<hal_port*>self.at.port_blocks).room = sizeof(self.at.port_blocks) - sizeof(hal_port)
        store_magic(&self.at.magic, MAGIC)

    def __dealloc__(self):
        self.detach()
        if self.at != NULL:
            munmap(self.at, sizeof(hal_segment))

    cpdef detach(self):
        """Stop being a user of the segment; the last one to leave removes it, with all signals in it.

        The memory stays mapped as long as a view of it lives.
        """
        cdef struct_stat st
        if self.fd < 0:
            return
        # After a fork the lock is still the parent's, so a child only closes its copy.
        if getpid() == self.pid and flock(self.fd, LOCK_EX | LOCK_NB) == 0:
            if fstat(self.fd, &st) == 0 and st.st_nlink > 0:
                shm_unlink(self.path)
        close(self.fd)
        self.fd = -1

    cdef int take(self) except -1:
        cdef timespec until
        cdef int code
        if self.fd < 0:
            raise HalError("the HAL segment is detached", -22)
        clock_gettime(CLOCK_MONOTONIC, &until)
        until.tv_sec += LOCK_SECONDS
        with nogil:
            code = pthread_mutex_clocklock(&self.at.mutex, CLOCK_MONOTONIC, &until)
        if code == EOWNERDEAD:
            self._repair()
            pthread_mutex_consistent(&self.at.mutex)
            self.at.recoveries += 1
        elif code == ETIMEDOUT:
            raise HalError(f"process {self.at.mutex_pid} has held the HAL mutex for {LOCK_SECONDS} s", -110)
        elif code != 0:
            raise HalError(f"cannot take the HAL mutex (error {code})", -code)
        self.at.mutex_pid = getpid()
        return 0

    cdef void give(self) noexcept:
        pthread_mutex_unlock(&self.at.mutex)

    def __enter__(self):
        self.take()
        return self

    def __exit__(self, *exc):
        self.give()

    cdef void _repair(self):
        """Make `link` words agree with `signal` indices again after a process died in the middle of a change."""
        cdef int i, signal
        for i in range(self.at.used_pins):
            signal = self.at.pins[i].signal
            if signal and not self.at.signals[signal - 1].head.state:
                signal = self.at.pins[i].signal = 0
            point(self.at, &self.at.pins[i], signal)

    # ---- waiting for changes ----

    def changes(self) -> int:
        """Begin to watch: a count that moves with every change of a value from now on, for `WATCH_NS`."""
        store_time(&self.at.watched_until_ns, monotonic_ns() + WATCH_NS)
        return load_state(&self.at.changes)

    def sleep_unchanged(self, int seen, double seconds) -> None:
        """Sleep until the count is no more what `changes` gave, half of the watch's time at most."""
        cdef int64_t ns = min(<int64_t>(max(seconds, 0.0) * 1e9), WATCH_NS // 2)
        with nogil:
            sleep_on(&self.at.changes, seen, ns)

    # ---- buffers of ports ----

    cdef hal_port* new_port(self, uint32_t size) except NULL:
        """A buffer of that many bytes; the caller holds the mutex."""
        cdef char* end = <char*>self.at.port_blocks + sizeof(self.at.port_blocks)
        cdef hal_port* block = <hal_port*>self.at.port_blocks
        cdef uint32_t wanted = (size + 7) & ~7
        cdef hal_port* after
        while <char*>block < end:
            after = <hal_port*>(block.bytes + block.room)
            while block.size == 0 and <char*>after < end and after.size == 0:  # free neighbours become one
                block.room += sizeof(hal_port) + after.room
                after = <hal_port*>(block.bytes + block.room)
            if block.size == 0 and block.room >= wanted:
                if block.room >= wanted + 2 * sizeof(hal_port):
                    after = <hal_port*>(block.bytes + wanted)
                    after.room = block.room - wanted - sizeof(hal_port)
                    after.size = 0
                    block.room = wanted
                block.read = block.written = 0
                block.size = size
                return block
            block = after
        raise HalError(f"no room for a port of {size} bytes: {sizeof(self.at.port_blocks)} are for all ports together", -12)

    # ---- header ----

    def new_id(self) -> int:
        """The next component number; the caller holds the mutex."""
        cdef int given = self.at.next_id
        self.at.next_id += 1
        return given

    def skip_ids(self, int count) -> None:
        """Pass over component numbers, as LinuxCNC does for its loader and re-registering shell."""
        self.at.next_id += count

    @property
    def attached(self) -> bool:
        return self.fd >= 0

    @property
    def current(self) -> bool:
        """Whether this process is attached to the segment that others find; ``halrun -U`` takes its name away."""
        cdef struct_stat st
        return self.fd >= 0 and fstat(self.fd, &st) == 0 and st.st_nlink > 0

    @property
    def address(self) -> int:
        return <size_t>self.at

    @property
    def locks(self) -> int:
        """HAL_LOCK_* bits."""
        return self.at.locks

    @locks.setter
    def locks(self, int value):
        self.at.locks = value

    @property
    def threads_running(self) -> bool:
        return self.at.threads_running != 0

    @threads_running.setter
    def threads_running(self, bint value):
        store_state(&self.at.threads_running, value)

    @property
    def host(self) -> tuple:
        """(pid, start time) of the realtime host; (0, 0) where there is none."""
        return self.at.host_pid, self.at.host_start

    @host.setter
    def host(self, tuple value):
        self.at.host_pid, self.at.host_start = value

    @property
    def size(self) -> int:
        return sizeof(hal_segment)

    @property
    def recoveries(self) -> int:
        return self.at.recoveries
