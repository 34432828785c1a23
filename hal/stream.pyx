"""Streams: a lossless queue of samples between a realtime function and a process, in shared memory of its own.

One writer, one reader, no lock: each only moves its own counter. ``sampler`` and ``streamer`` (``hal.components.fifo``) are at
the realtime end, ``halsampler`` and ``halstreamer`` (``hal.sampling``) at the other; Python programs use `Stream`.
"""

import errno

from posix.fcntl cimport O_CLOEXEC, O_CREAT, O_EXCL, O_RDWR, posix_fallocate
from posix.mman cimport MAP_FAILED, MAP_SHARED, PROT_READ, PROT_WRITE, mmap, munmap
from posix.unistd cimport close

from hal._shm import BIT, FLOAT, S32, S64, U32, U64
from nml.errors import HalError
from nml.namespace import shm_name

cdef extern from "<sys/mman.h>" nogil:
    int shm_open(const char* name, int flags, unsigned int mode)
    int shm_unlink(const char* name)

cdef extern from "<sys/stat.h>" nogil:
    ctypedef struct struct_stat "struct stat":
        long st_size
    int fstat(int fd, struct_stat* buf)

cdef extern from *:
    """
    #define store_release64(where, value) __atomic_store_n(where, value, __ATOMIC_RELEASE)
    #define load_acquire64(where) __atomic_load_n(where, __ATOMIC_ACQUIRE)
    """
    void store "store_release64"(uint64_t* where, uint64_t value) nogil
    uint64_t load "load_acquire64"(uint64_t* where) nogil

cdef uint64_t MAGIC = 0x6F6669662E6D6579

TYPE_LETTERS = {"b": BIT, "f": FLOAT, "s": S32, "u": U32, "l": S64, "k": U64}
LETTERS = {number: letter for letter, number in TYPE_LETTERS.items()}


def check_types(str text) -> str:
    """A string of column types in lower case; HalError for a letter that is none."""
    wanted = text.lower()
    for letter in wanted:
        if letter not in TYPE_LETTERS:
            raise HalError(f"'{letter}' in '{text}' is no column type; f b s u l k are known")
    if not 1 <= len(wanted) <= MAX_COLUMNS:
        raise HalError(f"'{text}': 1 to {MAX_COLUMNS} columns are possible")
    return wanted


cdef hal_cell* fifo_room(hal_fifo* fifo) noexcept nogil:
    """Where the next sample's columns go; NULL where the queue is full. Counts the attempt."""
    cdef hal_cell* cell
    fifo.attempts += 1
    if fifo.written - load(&fifo.read) >= fifo.depth:
        fifo.overruns += 1
        return NULL
    cell = &fifo.cells[(fifo.written % fifo.depth) * (fifo.columns + 1)]
    cell.k = fifo.attempts - 1
    return cell + 1


cdef void fifo_publish(hal_fifo* fifo) noexcept nogil:
    """The sample in the room is complete."""
    store(&fifo.written, fifo.written + 1)


cdef hal_cell* fifo_next(hal_fifo* fifo) noexcept nogil:
    """The oldest sample: its number, then its columns; NULL where there is none."""
    if load(&fifo.written) == fifo.read:
        return NULL
    return &fifo.cells[(fifo.read % fifo.depth) * (fifo.columns + 1)]


cdef void fifo_release(hal_fifo* fifo) noexcept nogil:
    """The oldest sample has been taken."""
    store(&fifo.read, fifo.read + 1)


cdef uint32_t fifo_depth(hal_fifo* fifo) noexcept nogil:
    """Samples waiting."""
    return <uint32_t>(load(&fifo.written) - load(&fifo.read))


cdef class Stream:
    """A queue of samples, made with a depth and column types (``"ffb"``), or attached to where ``depth`` is 0."""

    def __cinit__(self):
        self.fifo = NULL

    def __init__(self, str key, size_t depth = 0, str types = ""):
        self.path = shm_name(f"hal.stream.{key}").encode()
        self.owner = depth > 0
        if self.owner:
            self._make(depth, check_types(types))
        else:
            self._attach(key)
        self.element_types = "".join(LETTERS[self.fifo.types[i]] for i in range(self.fifo.columns))
        if types and check_types(types) != self.element_types:
            raise HalError(f"stream '{key}' has columns '{self.element_types}', not '{types}'")

    cdef _map(self, int fd):
        cdef void* where = mmap(NULL, self.size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0)
        close(fd)
        if where == MAP_FAILED:
            raise HalError("no memory for the stream", -12)
        self.fifo = <hal_fifo*>where

    def _make(self, size_t depth, str types):
        cdef int fd
        shm_unlink(self.path)  # left by a process that was killed
        fd = shm_open(self.path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0o600)
        depth = max(depth - 1, <size_t>1)  # as in LinuxCNC, where one place of the ring stays free
        self.size = sizeof(hal_fifo) + depth * (len(types) + 1) * sizeof(hal_cell)
        if fd < 0 or posix_fallocate(fd, 0, self.size) != 0:
            raise HalError(f"cannot make the stream {self.path.decode()}", -12)
        self._map(fd)
        self.fifo.depth, self.fifo.columns = depth, len(types)
        for i, letter in enumerate(types):
            self.fifo.types[i] = TYPE_LETTERS[letter]
        store(&self.fifo.magic, MAGIC)

    def _attach(self, str key):
        cdef struct_stat st
        cdef int fd = shm_open(self.path, O_RDWR | O_CLOEXEC, 0)
        if fd < 0:
            raise HalError(f"there is no stream '{key}'; its realtime component is not loaded", -2)
        fstat(fd, &st)
        self.size = st.st_size
        if self.size < sizeof(hal_fifo):
            close(fd)
            raise HalError(f"stream '{key}' is not ready", -2)
        self._map(fd)
        if load(&self.fifo.magic) != MAGIC:
            raise HalError(f"stream '{key}' is not ready", -2)

    def __dealloc__(self):
        if self.fifo != NULL:
            if self.owner:
                shm_unlink(self.path)
            munmap(self.fifo, self.size)

    def close(self) -> None:
        """Let go of it; who made it removes it."""
        if self.fifo != NULL:
            if self.owner:
                self.fifo.magic = 0  # whoever is attached sees that it is over
                shm_unlink(self.path)
            munmap(self.fifo, self.size)
            self.fifo = NULL

    cdef _check(self):
        if self.fifo == NULL:
            raise HalError("the stream is closed")

    @property
    def address(self) -> int:
        return <size_t>self.fifo

    @property
    def alive(self) -> bool:
        """Whether its maker still has it open."""
        self._check()
        return load(&self.fifo.magic) == MAGIC

    @property
    def depth(self) -> int:
        """Samples waiting."""
        self._check()
        return fifo_depth(self.fifo)

    @property
    def maxdepth(self) -> int:
        self._check()
        return self.fifo.depth

    @property
    def readable(self) -> bool:
        return self.depth > 0

    @property
    def writable(self) -> bool:
        return self.depth < self.maxdepth

    @property
    def num_overruns(self) -> int:
        """Writes refused because the queue was full."""
        self._check()
        return self.fifo.overruns

    @property
    def num_underruns(self) -> int:
        """Reads that found nothing."""
        self._check()
        return self.fifo.underruns

    def read(self):
        """The oldest sample as a tuple, and its number, from 1, in ``sampleno``; None where there is none."""
        self._check()
        cdef hal_cell* cell = fifo_next(self.fifo)
        if cell == NULL:
            self.fifo.underruns += 1
            return None
        self.sampleno = cell.k + 1
        cdef list values = []
        cdef hal_cell* column
        cdef int i
        for i in range(self.fifo.columns):
            column = cell + 1 + i
            type_ = self.fifo.types[i]
            values.append(
                column.f if type_ == FLOAT else column.b != 0 if type_ == BIT else column.s if type_ == S32
                else column.u if type_ == U32 else column.l if type_ == S64 else column.k)
        fifo_release(self.fifo)
        return tuple(values)

    def write(self, values) -> None:
        """Append a sample; OSError where the queue is full."""
        self._check()
        if len(values) != self.fifo.columns:
            raise ValueError(f"a sample of {len(values)} columns; {self.fifo.columns} would be right")
        cdef hal_cell* cell = fifo_room(self.fifo)
        cdef int i
        if cell == NULL:
            raise OSError(errno.ENOSPC, f"the stream is full: {self.fifo.depth} samples wait to be read")
        for i in range(self.fifo.columns):
            type_ = self.fifo.types[i]
            if type_ == FLOAT:
                cell[i].f = values[i]
            elif type_ == BIT:
                cell[i].b = 1 if values[i] else 0
            elif type_ == S32 or type_ == S64:
                cell[i].l = values[i]
            else:
                cell[i].k = values[i]
        fifo_publish(self.fifo)
