"""The HAL's shared segment: records of components, pins, parameters, signals, functions and threads.

Every process of a controller that speaks HAL maps it (`Segment`), and ``hal.core`` keeps the rules. Here are only storage,
the mutex and typed views of the records.

* Records lie in fixed arrays and hold indices and distances, never addresses, so the segment works wherever it is mapped.
* One robust mutex guards structural changes. A process killed while holding it is noticed by the next one, which repairs
  what is derived (`link` words follow from `signal` indices) and goes on. Values of pins and signals need no lock.
* Each process holds a shared flock on the segment while it is attached; the last to leave removes it.
"""

from libc.errno cimport errno
from libc.string cimport memcpy, memset, strcmp, strncpy
from posix.fcntl cimport O_CLOEXEC, O_CREAT, O_RDWR
from posix.mman cimport MAP_FAILED, MAP_SHARED, PROT_READ, PROT_WRITE, mmap, munmap
from posix.time cimport CLOCK_REALTIME, clock_gettime, timespec
from posix.unistd cimport close, ftruncate, getpid, usleep

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
    int pthread_mutex_timedlock(pthread_mutex_t*, timespec*)
    int pthread_mutex_unlock(pthread_mutex_t*)
    int pthread_mutex_consistent(pthread_mutex_t*)

cdef extern from *:
    """
    #define store_release(where, value) __atomic_store_n(where, value, __ATOMIC_RELEASE)
    #define load_acquire(where) __atomic_load_n(where, __ATOMIC_ACQUIRE)
    """
    void store_state "store_release"(int32_t* where, int32_t value) nogil
    int32_t load_state "load_acquire"(int32_t* where) nogil
    void store_link "store_release"(int64_t* where, int64_t value) nogil
    void store_magic "store_release"(uint64_t* where, uint64_t value) nogil
    uint64_t load_magic "load_acquire"(uint64_t* where) nogil

cdef enum:
    VERSION = 1
    ATTACH_TRIES = 5000  # of 1 ms: how long another process may take to set the segment up
    LOCK_SECONDS = 5

cdef uint64_t MAGIC = 0x6C61682E636D6579

# The type and direction numbers of LinuxCNC's hal.h
BIT, FLOAT, S32, U32, PORT, S64, U64 = 1, 2, 3, 4, 5, 6, 7
IN, OUT, IO = 16, 32, 48
RO, RW = 64, 192
PIN, PARAM = 0, 1
USER, REALTIME, THREAD_COMP = 0, 1, 2


cdef uint32_t hash_name(const char* name) noexcept nogil:
    cdef uint32_t h = 2166136261
    while name[0]:
        h = (h ^ <uint8_t>name[0]) * 16777619
        name += 1
    return h


cdef int set_name(char* field, uint32_t* hash, str name) except -1:
    cdef bytes raw = name.encode()
    if len(raw) >= NAME_SIZE:
        raise HalError(f"name '{name}' is too long: {len(raw)} characters, {NAME_SIZE - 1} are allowed", -22)
    memset(field, 0, NAME_SIZE)
    memcpy(field, <const char*>raw, len(raw))
    hash[0] = hash_name(<const char*>raw)
    return 0


cdef class Segment:
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
        if fresh and ftruncate(self.fd, sizeof(hal_segment)) != 0:
            raise HalError("no room for the HAL segment in shared memory", -12)
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
        clock_gettime(CLOCK_REALTIME, &until)
        until.tv_sec += LOCK_SECONDS
        with nogil:
            code = pthread_mutex_timedlock(&self.at.mutex, &until)
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

    def used(self) -> dict:
        """By table: records in use, slots ever used, bytes of a record."""
        return {
            "components": (len(self.comps()), self.at.used_comps, sizeof(hal_comp)),
            "pins": (len(self.items(PIN)), self.at.used_pins, sizeof(hal_item)),
            "parameters": (len(self.items(PARAM)), self.at.used_params, sizeof(hal_item)),
            "signals": (len(self.signals()), self.at.used_signals, sizeof(hal_signal)),
            "functions": (len(self.functs()), self.at.used_functs, sizeof(hal_funct)),
            "threads": (len(self.threads()), self.at.used_threads, sizeof(hal_thread)),
        }

    # ---- tables ----

    cdef hal_record* _slot(self, hal_record* first, size_t stride, int32_t* used, int limit, str what) except NULL:
        """A free slot of a table, cleared."""
        cdef hal_record* record = first
        cdef int i
        for i in range(used[0]):
            record = <hal_record*>(<char*>first + i * stride)
            if not record.state:
                memset(record, 0, stride)
                return record
        if used[0] >= limit:
            raise HalError(f"no room for another {what}: {limit} exist", -12)
        record = <hal_record*>(<char*>first + used[0] * stride)
        memset(record, 0, stride)
        used[0] += 1
        return record

    cdef hal_record* _find(self, hal_record* first, size_t stride, int used, str name):
        cdef bytes raw = name.encode()
        cdef const char* text = raw
        cdef uint32_t wanted = hash_name(text)
        cdef hal_record* record
        cdef int i
        for i in range(used):
            record = <hal_record*>(<char*>first + i * stride)
            if record.hash == wanted and load_state(&record.state) and strcmp(record.name, text) == 0:
                return record
        return NULL

    # pins and parameters

    cdef Item _item(self, hal_item* item):
        cdef Item view = Item.__new__(Item)
        view.segment, view.item, view.head, view.word = self, item, &item.head, word_of(self.at, item)
        return view

    def new_item(self, int kind, str name, int type, int dir, int owner) -> Item:
        """A pin or parameter of value 0; the caller holds the mutex and has checked that the name is free."""
        cdef hal_item* item
        if kind == PIN:
            item = <hal_item*>self._slot(&self.at.pins[0].head, sizeof(hal_item), &self.at.used_pins, MAX_PINS, "pin")
        else:
            item = <hal_item*>self._slot(
                &self.at.params[0].head, sizeof(hal_item), &self.at.used_params, MAX_PARAMS, "parameter")
        set_name(item.head.name, &item.head.hash, name)
        item.type, item.dir, item.owner = type, dir, owner
        word_of(self.at, item).cell.k = 0
        point(self.at, item, 0)
        store_state(&item.head.state, 1)
        return self._item(item)

    def find_item(self, int kind, str name):
        """The pin or parameter of that name or alias; None where there is none."""
        cdef hal_item* first = &self.at.pins[0] if kind == PIN else &self.at.params[0]
        cdef int used = self.at.used_pins if kind == PIN else self.at.used_params
        cdef hal_item* found = <hal_item*>self._find(&first[0].head, sizeof(hal_item), used, name)
        if found != NULL:
            return self._item(found)
        cdef bytes raw = name.encode()
        cdef uint32_t wanted = hash_name(raw)
        for i in range(used):
            if first[i].alias_hash == wanted and first[i].head.state and strcmp(first[i].alias, raw) == 0:
                return self._item(&first[i])
        return None

    def items(self, int kind) -> list:
        """All pins or parameters, sorted by the name that they show."""
        cdef hal_item* first = &self.at.pins[0] if kind == PIN else &self.at.params[0]
        cdef int used = self.at.used_pins if kind == PIN else self.at.used_params
        return sorted([self._item(&first[i]) for i in range(used) if load_state(&first[i].head.state)], key=shown_name)

    # signals

    cdef Signal _signal(self, hal_signal* signal):
        cdef Signal view = Signal.__new__(Signal)
        view.segment, view.signal, view.head = self, signal, &signal.head
        view.cell = &self.at.cells[signal - &self.at.signals[0]]
        return view

    def new_signal(self, str name, int type) -> Signal:
        cdef hal_signal* signal = <hal_signal*>self._slot(
            &self.at.signals[0].head, sizeof(hal_signal), &self.at.used_signals, MAX_SIGNALS, "signal")
        set_name(signal.head.name, &signal.head.hash, name)
        signal.type = type
        self.at.cells[signal - &self.at.signals[0]].k = 0
        store_state(&signal.head.state, 1)
        return self._signal(signal)

    def find_signal(self, str name):
        found = <size_t>self._find(&self.at.signals[0].head, sizeof(hal_signal), self.at.used_signals, name)
        return self._signal(<hal_signal*><size_t>found) if found else None

    def signals(self) -> list:
        """All signals, sorted by name."""
        return sorted([self._signal(&self.at.signals[i]) for i in range(self.at.used_signals)
                       if load_state(&self.at.signals[i].head.state)], key=record_name)

    # components

    cdef Comp _comp(self, hal_comp* comp):
        cdef Comp view = Comp.__new__(Comp)
        view.segment, view.comp, view.head = self, comp, &comp.head
        return view

    def new_comp(self, str name, int kind, int pid, uint64_t start) -> Comp:
        cdef hal_comp* comp = <hal_comp*>self._slot(
            &self.at.comps[0].head, sizeof(hal_comp), &self.at.used_comps, MAX_COMPS, "component")
        set_name(comp.head.name, &comp.head.hash, name)
        comp.id, comp.kind, comp.pid, comp.start = self.new_id(), kind, pid, start
        store_state(&comp.head.state, 1)
        return self._comp(comp)

    def find_comp(self, str name):
        found = <size_t>self._find(&self.at.comps[0].head, sizeof(hal_comp), self.at.used_comps, name)
        return self._comp(<hal_comp*><size_t>found) if found else None

    def comps(self) -> list:
        """All components, newest first."""
        return sorted([self._comp(&self.at.comps[i]) for i in range(self.at.used_comps)
                       if load_state(&self.at.comps[i].head.state)], key=newest_first)

    # functions

    cdef Funct _funct(self, hal_funct* funct):
        cdef Funct view = Funct.__new__(Funct)
        view.segment, view.funct, view.head = self, funct, &funct.head
        return view

    def new_funct(self, str name, int owner, uint64_t code, uint64_t arg, bint uses_fp, bint reentrant) -> Funct:
        cdef hal_funct* funct = <hal_funct*>self._slot(
            &self.at.functs[0].head, sizeof(hal_funct), &self.at.used_functs, MAX_FUNCTS, "function")
        set_name(funct.head.name, &funct.head.hash, name)
        funct.owner, funct.code, funct.arg, funct.uses_fp, funct.reentrant = owner, code, arg, uses_fp, reentrant
        store_state(&funct.head.state, 1)
        return self._funct(funct)

    def find_funct(self, str name):
        found = <size_t>self._find(&self.at.functs[0].head, sizeof(hal_funct), self.at.used_functs, name)
        return self._funct(<hal_funct*><size_t>found) if found else None

    def functs(self) -> list:
        """All functions, sorted by name."""
        return sorted([self._funct(&self.at.functs[i]) for i in range(self.at.used_functs)
                       if load_state(&self.at.functs[i].head.state)], key=record_name)

    # threads

    cdef Thread _thread(self, hal_thread* thread):
        cdef Thread view = Thread.__new__(Thread)
        view.segment, view.thread, view.head = self, thread, &thread.head
        return view

    def new_thread(self, str name, int owner, int64_t period_ns, bint uses_fp) -> Thread:
        cdef hal_thread* thread = <hal_thread*>self._slot(
            &self.at.threads[0].head, sizeof(hal_thread), &self.at.used_threads, MAX_THREADS, "thread")
        set_name(thread.head.name, &thread.head.hash, name)
        thread.owner, thread.period_ns, thread.uses_fp = owner, period_ns, uses_fp
        store_state(&thread.head.state, 1)
        return self._thread(thread)

    def find_thread(self, str name):
        found = <size_t>self._find(&self.at.threads[0].head, sizeof(hal_thread), self.at.used_threads, name)
        return self._thread(<hal_thread*><size_t>found) if found else None

    def threads(self) -> list:
        """All threads, in the order in which they were made."""
        return [self._thread(&self.at.threads[i]) for i in range(self.at.used_threads)
                if load_state(&self.at.threads[i].head.state)]


def record_name(Record record):
    """Sort key: the name."""
    return record.head.name


def shown_name(Item item):
    """Sort key: the alias where there is one, else the name."""
    return item.item.alias if item.item.alias[0] else item.head.name


def newest_first(Comp comp):
    """Sort key: components in falling order of number."""
    return -comp.comp.id


cdef hal_word* word_of(hal_segment* at, hal_item* item) noexcept nogil:
    """The word of a pin or parameter."""
    cdef ssize_t index = item - &at.pins[0]
    if 0 <= index < MAX_PINS:
        return &at.pin_words[index]
    return &at.param_words[item - &at.params[0]]


cdef void point(hal_segment* at, hal_item* item, int signal) noexcept nogil:
    """Aim a pin's link at signal number `signal` - 1, or at the pin's own cell where it is 0."""
    cdef hal_word* word = word_of(at, item)
    cdef char* cell = <char*>&word.cell if signal == 0 else <char*>&at.cells[signal - 1]
    store_link(&word.link, cell - <char*>&word.link)


cdef object cell_value(hal_cell* cell, int type):
    """A cell as a Python number."""
    if type == FLOAT:
        return cell.f
    if type == BIT:
        return cell.b != 0
    if type == S32:
        return cell.s
    if type == U32:
        return cell.u
    if type == S64:
        return cell.l
    if type == U64:
        return cell.k
    return cell.s


cdef int set_cell(hal_cell* cell, int type, object value) except -1:
    """Store a Python number; OverflowError where it does not fit the type."""
    if type == FLOAT:
        cell.f = value
    elif type == BIT:
        cell.b = 1 if value else 0
    elif type == S32:
        cell.s = value
    elif type == U32:
        cell.u = value
    elif type == S64:
        cell.l = value
    elif type == U64:
        cell.k = value
    else:
        cell.s = value
    return 0


cdef class Record:
    """A view of one record; two views are equal where they show the same record."""

    @property
    def name(self) -> str:
        return self.head.name.decode()

    @property
    def exists(self) -> bool:
        return self.head.state != 0

    @property
    def address(self) -> int:
        return <size_t>self.head

    def free(self) -> None:
        """Give the slot back; the caller holds the mutex and has undone what points here."""
        store_state(&self.head.state, 0)

    def __eq__(self, other):
        return isinstance(other, Record) and (<Record>other).head == self.head

    def __hash__(self):
        return hash(<size_t>self.head)

    def __repr__(self):
        return f"<{type(self).__name__} {self.name}>"


cdef class Item(Record):
    """A pin or a parameter."""

    @property
    def address(self) -> int:
        """What native code takes as its `hal_pin`."""
        return <size_t>&self.word.link

    cdef hal_cell* cell(self) noexcept:
        return <hal_cell*>(<char*>&self.word.link + self.word.link)

    def show_same(self, Item other) -> None:
        """Become a view of what another one shows; for subclasses."""
        self.segment, self.head, self.item, self.word = other.segment, other.head, other.item, other.word

    @property
    def type(self) -> int:
        return self.item.type

    @property
    def dir(self) -> int:
        return self.item.dir

    @property
    def owner(self) -> int:
        return self.item.owner

    @property
    def alias(self) -> str:
        return self.item.alias.decode()

    @alias.setter
    def alias(self, str text):
        self.item.alias_hash = 0
        if text:
            set_name(self.item.alias, &self.item.alias_hash, text)
        else:
            memset(self.item.alias, 0, NAME_SIZE)

    @property
    def shown(self) -> str:
        """The name that listings show: the alias where there is one."""
        return self.item.alias.decode() if self.item.alias[0] else self.name

    def get(self):
        return cell_value(self.cell(), self.item.type)

    def set(self, value) -> None:
        set_cell(self.cell(), self.item.type, value)

    value = property(get, set)

    def set_safe(self, value) -> None:
        """The value that the pin takes when its owner dies."""
        set_cell(&self.item.safe, self.item.type, value)
        self.item.has_safe = 1

    def fall_safe(self) -> None:
        """Take the declared safe value, if there is one."""
        if self.item.has_safe:
            self.cell()[0] = self.item.safe

    @property
    def signal(self):
        """The signal that this pin is linked to, or None."""
        if not self.item.signal:
            return None
        return self.segment._signal(&self.segment.at.signals[self.item.signal - 1])

    def link(self, Signal signal) -> None:
        self.item.signal = <int>(signal.signal - self.segment.at.signals) + 1
        point(self.segment.at, self.item, self.item.signal)

    def unlink(self) -> None:
        """Cut the pin off; it keeps the signal's last value."""
        if self.item.signal:
            self.word.cell = self.cell()[0]
            point(self.segment.at, self.item, 0)
            self.item.signal = 0


cdef class Signal(Record):
    """A signal: a named cell that pins are linked to."""

    @property
    def type(self) -> int:
        return self.signal.type

    def get(self):
        return cell_value(self.cell, self.signal.type)

    def set(self, value) -> None:
        set_cell(self.cell, self.signal.type, value)

    value = property(get, set)

    def pins(self) -> list:
        """The pins linked to it, sorted by shown name."""
        cdef int number = <int>(self.signal - self.segment.at.signals) + 1
        cdef hal_segment* at = self.segment.at
        cdef list found = []
        cdef int i
        for i in range(at.used_pins):
            if at.pins[i].signal == number and at.pins[i].head.state:
                found.append(self.segment._item(&at.pins[i]))
        return sorted(found, key=shown_name)

    def writer(self):
        """The output pin that drives it, or None."""
        for pin in self.pins():
            if pin.dir == OUT:
                return pin
        return None


cdef class Comp(Record):
    """A component: a user process, a realtime module or a thread."""

    @property
    def id(self) -> int:
        return self.comp.id

    @property
    def kind(self) -> int:
        return self.comp.kind

    @property
    def pid(self) -> int:
        return self.comp.pid

    @property
    def start(self) -> int:
        return self.comp.start

    @property
    def ready(self) -> bool:
        return self.comp.ready != 0

    @ready.setter
    def ready(self, bint value):
        self.comp.ready = value

    @property
    def args(self) -> str:
        """What loadrt was given, as `save` prints it."""
        return self.comp.args.decode()

    @args.setter
    def args(self, str text):
        cdef bytes raw = text.encode()[: ARGS_SIZE - 1]
        strncpy(self.comp.args, raw, ARGS_SIZE)


cdef class Funct(Record):
    """A realtime function that `addf` puts into a thread."""

    @property
    def owner(self) -> int:
        return self.funct.owner

    @property
    def users(self) -> int:
        return self.funct.users

    @property
    def uses_fp(self) -> bool:
        return self.funct.uses_fp != 0

    @property
    def reentrant(self) -> bool:
        return self.funct.reentrant != 0

    @property
    def code(self) -> int:
        return self.funct.code

    @property
    def arg(self) -> int:
        return self.funct.arg


cdef class Thread(Record):
    """A realtime thread and the functions that it calls in order."""

    @property
    def owner(self) -> int:
        return self.thread.owner

    @property
    def period_ns(self) -> int:
        return self.thread.period_ns

    @property
    def uses_fp(self) -> bool:
        return self.thread.uses_fp != 0

    @property
    def priority(self) -> int:
        return self.thread.priority

    @priority.setter
    def priority(self, int value):
        self.thread.priority = value

    @property
    def cycles(self) -> int:
        """Periods since the thread was made, running or stopped."""
        return self.thread.cycles

    @property
    def overruns(self) -> int:
        """Periods that began more than one period late."""
        return self.thread.overruns

    @property
    def running(self) -> bool:
        """Whether it is inside its functions now."""
        return self.thread.running != 0

    def functs(self) -> list:
        return [self.segment._funct(&self.segment.at.functs[self.thread.call[i]]) for i in range(self.thread.calls)]

    def set_functs(self, list functs) -> None:
        """Replace the list that is shown; the host replaces the one that is called."""
        cdef Funct funct
        cdef int i
        if len(functs) > MAX_CALLS:
            raise HalError(f"thread '{self.name}' has no room for more than {MAX_CALLS} functions", -12)
        for i in range(self.thread.calls):
            self.segment.at.functs[self.thread.call[i]].users -= 1
        for i, funct in enumerate(functs):
            self.thread.call[i] = <int>(funct.funct - self.segment.at.functs)
            funct.funct.users += 1
        self.thread.calls = len(functs)
