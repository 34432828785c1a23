"""A process's hold on a buffer in shared memory: what ``nml.channel`` reads and writes with. Rules: ``_shm.pyx``."""

cimport cython
from cpython.bytearray cimport PyByteArray_AS_STRING, PyByteArray_GET_SIZE
from cpython.exc cimport PyErr_CheckSignals
from libc.errno cimport EBUSY, ETIMEDOUT
from libc.stddef cimport size_t
from libc.stdint cimport int32_t, int64_t, uint32_t, uint64_t
from libc.string cimport memcpy, memset, strerror, strncpy
from posix.unistd cimport getpid

from nml._layout cimport *
from nml._shm cimport drop_until_room, queue_append, queue_commit_read, queue_forget, ring_write, slot_write

from nml.errors import BufferError_, ChannelTimeout, QueueFull, TooLong

cdef enum:
    SERIAL_AT = 16
    SERIAL_END = 20
    LONGEST_SLEEP_NS = 100_000_000


@cython.no_gc_clear  # the memory must outlive `let_go`
cdef class Buffer:
    """A process's hold on one buffer; for one thread at a time, except ``wait``.

    An observer sees every message, takes none from anybody and marks none as read.
    """

    def __cinit__(
        self,
        memory,
        *,
        keeper=None,
        double timeout=-1.0,
        bint lock_writes=True,
        bint shared=False,
        bint observe=False,
        int c_num=-1,
        str process="",
    ):
        cdef unsigned char[::1] view = memory
        self.memory = memory
        self.keeper = keeper
        self.head = <Head*>&view[0]
        self.name = self.head.name.decode()
        self.timeout = timeout
        self.lock_writes = lock_writes
        self.shared = shared
        self.observe = observe
        self.pid = getpid()
        if c_num >= 0:
            self.diag = <Diag*>(<char*>self.head + aligned(sizeof(Head))) + c_num
            memset(self.diag, 0, sizeof(Diag))
            encoded = process.encode()
            strncpy(self.diag.name, encoded, sizeof(self.diag.name) - 1)
            self.diag.pid = self.pid
        if self.head.kind == KIND_BROADCAST:
            self.first = nml_load(&self.head.seen)
            self.seek(self.first)
        elif self.head.kind == KIND_QUEUE:
            self.cursor_id = paired(&self.head.read_counter, self.head.head, &self.cursor_at)

    @property
    def address(self) -> int:
        """Address of the head, for the C functions."""
        self.check_open()
        return <size_t>self.head

    @property
    def kind(self) -> int:
        self.check_open()
        return self.head.kind

    @property
    def pulse(self) -> int:
        """Signs of life of the process that writes the buffer (``nml.pulse``)."""
        self.check_open()
        return nml_load(&self.head.pulse)

    @property
    def write_counter(self) -> int:
        """Messages ever written."""
        self.check_open()
        return nml_load(&self.head.write_counter)

    @property
    def longest(self) -> int:
        """Length of the longest message that fits."""
        self.check_open()
        return self.head.capacity if self.head.kind == KIND_SLOT else self.head.capacity - sizeof(Record)

    cdef int check_open(self) except -1:
        if self.closed:
            raise BufferError_(f"buffer {self.name}: the channel is closed")
        return 0

    cdef int lock(self, pthread_mutex_t* mutex) except -1:
        """Take a lock within the timeout; a dead owner's lock is taken over."""
        cdef int failed = pthread_mutex_trylock(mutex)
        cdef double seconds = self.timeout
        if failed == EBUSY and seconds != 0.0:
            with nogil:
                failed = nml_lock_until(mutex, seconds)
        if failed == EOWNERDEAD:
            failed = pthread_mutex_consistent(mutex)
        if failed == EBUSY or failed == ETIMEDOUT:
            raise ChannelTimeout(f"buffer {self.name}: in use by another process for {seconds} s")
        if failed:
            raise BufferError_(f"buffer {self.name}: lock failed: {strerror(failed).decode()}")
        return 0

    def hold_lock(self) -> None:
        """Take the writers' lock and keep it until ``close``: nobody else writes meanwhile."""
        self.lock(&self.head.write_lock)
        self.holding = True

    cdef void let_go(self) noexcept:
        """Drop the memory; a lock that were still held would stay in this thread's list of robust locks."""
        if self.holding:
            self.holding = False
            pthread_mutex_unlock(&self.head.write_lock)
        self.memory = None
        self.keeper = None

    def __dealloc__(self):
        self.let_go()

    cdef void account(self, bint wrote, size_t size, int32_t type_id, bint new) noexcept:
        cdef Diag* diag = self.diag
        cdef int64_t now = now_ns(), gap
        if diag.last_ns:
            gap = now - diag.last_ns
            diag.shortest_ns = gap if not diag.shortest_ns else min(gap, diag.shortest_ns)
            diag.longest_ns = max(gap, diag.longest_ns)
        else:
            diag.first_ns = now
        diag.last_ns = now
        if wrote:
            diag.writes += 1
            diag.bytes_written += size
        else:
            diag.reads += 1
            diag.new_reads += new
            diag.bytes_read += size
        if new:
            diag.last_type = type_id

    def write(self, data, bint serial=False, bint only_if_read=False) -> int:
        """Publish a message and return its number; 0 if ``only_if_read`` and the last one was not read yet.

        ``serial`` stores the number at the place of ``serial_number``, also in ``data``.
        """
        cdef bytearray source = data if type(data) is bytearray else bytearray(data)
        cdef char* src = PyByteArray_AS_STRING(source)
        cdef uint64_t size = PyByteArray_GET_SIZE(source)
        cdef Head* head = self.head
        cdef uint64_t number, tail
        cdef int failed = 0
        self.check_open()
        if size > self.longest:
            raise TooLong(f"buffer {self.name}: {size} bytes, the longest message has {self.longest}")
        if self.lock_writes:
            self.lock(&head.write_lock)
        if only_if_read and not self.was_read():
            if self.lock_writes:
                pthread_mutex_unlock(&head.write_lock)
            return 0
        number = head.write_counter + 1
        if serial and size >= SERIAL_END:
            (<int32_t*>(src + SERIAL_AT))[0] = <int32_t>number
        if head.kind == KIND_SLOT:
            slot_of(head, number).writer = self.pid
            slot_write(head, src, size)
        elif head.kind == KIND_QUEUE:
            failed = queue_append(head, src, size, self.pid)
        else:
            paired(&head.write_counter, head.tail, &tail)
            drop_until_room(head, tail, record_size(size))
            ring_write(head, tail, src, size, self.pid)
        if self.lock_writes:
            pthread_mutex_unlock(&head.write_lock)
        if failed:
            raise QueueFull(f"buffer {self.name}: the queue has no room for {size} bytes")
        if self.diag is not NULL:
            self.account(True, size, (<int32_t*>src)[0] if size >= 4 else 0, True)
        return number

    def read(self):
        """The next message as a bytearray, taken from a queue; None if there is nothing new."""
        return self.take(True)

    def peek(self):
        """As ``read``, but a queue keeps the message and a single slot is not marked as read."""
        return self.take(False)

    cdef object take(self, bint consume):
        self.check_open()
        if self.head.kind == KIND_SLOT:
            message = self.take_slot(None)
            if message is not None and consume and not self.observe:
                nml_store_max(&self.head.seen, self.last)
        elif self.head.kind == KIND_QUEUE:
            message = self.take_observed() if self.observe else self.take_queue(consume)
        else:
            message = self.take_broadcast(consume)
        if self.diag is not NULL:
            new = message is not None
            self.account(False, len(message) if new else 0, type_of(message) if new else 0, new)
        return message

    def poll_into(self, bytearray into not None) -> bool:
        """Single slot: copy a new message over the start of ``into``; False if there is none. Marks nothing as read."""
        if self.closed:
            self.check_open()
        if nml_load(&self.head.write_counter) == self.last:
            return False
        return self.take_slot(into) is not None

    cdef object take_slot(self, bytearray into):
        """The newest message if it is new to this channel; copied to ``into`` if given."""
        cdef Head* head = self.head
        cdef Record* slot
        cdef uint64_t number, length
        while True:
            number = nml_load(&head.write_counter)
            if number == self.last or number <= nml_load(&head.cleared):
                return None
            slot = slot_of(head, number)
            if nml_load(&slot.id) != number:
                if nml_load(&head.write_counter) == number:
                    self.last = number
                    raise self.damaged(f"message {number} is not where it should be")
                continue
            length = min(slot.length, head.capacity)
            message = bytearray(length) if into is None else into
            if <uint64_t>PyByteArray_GET_SIZE(message) < length:
                raise BufferError_(f"buffer {self.name}: the message has {length} bytes, the reader {len(message)}")
            memcpy(PyByteArray_AS_STRING(message), slot + 1, length)
            self.last_time_ns = slot.time_ns
            nml_fence()  # SYNC POINT: nothing was overwritten if the id is still the same
            if nml_load(&slot.id) == number:
                self.last = number
                return message

    cdef object take_queue(self, bint consume):
        cdef Head* head = self.head
        cdef uint64_t at, number, length
        if nml_load(&head.write_counter) == nml_load(&head.read_counter):
            return None
        self.lock(&head.read_lock)
        number = paired(&head.read_counter, head.head, &at)
        if nml_load(&head.write_counter) == number:
            pthread_mutex_unlock(&head.read_lock)
            return None
        length = record_at(head, at).length
        if length > head.capacity - sizeof(Record):
            queue_forget(head)
            pthread_mutex_unlock(&head.read_lock)
            raise self.damaged(f"a record of {length} bytes cannot be; the queue was emptied")
        self.last_time_ns = record_at(head, at).time_ns
        message = bytearray(length)
        ring_get(head, at + sizeof(Record), PyByteArray_AS_STRING(message), length)
        if consume:
            queue_commit_read(head, number + 1, at + record_size(length))
        pthread_mutex_unlock(&head.read_lock)
        self.last = number + 1
        return message

    cdef object take_observed(self):
        """The queue's next message after this observer's cursor, whether or not somebody has taken it meanwhile."""
        cdef Head* head = self.head
        cdef Record* record
        cdef uint64_t number, length, at
        while nml_load(&head.write_counter) > self.cursor_id:
            record = record_at(head, self.cursor_at)
            length = record.length
            if record.id == self.cursor_id + 1 and length <= head.capacity:
                message = bytearray(length)
                ring_get(head, self.cursor_at + sizeof(Record), PyByteArray_AS_STRING(message), length)
                self.last_time_ns = record.time_ns
                nml_fence()  # SYNC POINT: the record was whole if nothing was reserved that overlaps it
                if nml_load(&head.reserved) <= self.cursor_at + head.capacity:
                    self.cursor_id += 1
                    self.cursor_at += record_size(length)
                    self.last = self.cursor_id
                    return message
            number = paired(&head.read_counter, head.head, &at)
            if number <= self.cursor_id:
                self.cursor_id = paired(&head.write_counter, head.tail, &self.cursor_at)
                raise self.damaged(f"no record {number + 1} in the queue")
            self.missed += number - self.cursor_id
            self.cursor_id, self.cursor_at = number, at
        return None

    cdef void seek(self, uint64_t target) noexcept:
        """Broadcast: put the cursor behind message ``target``, or before the oldest one that is still there."""
        cdef Head* head = self.head
        cdef uint64_t first, at, number
        cdef Record* record
        while True:
            number = first = paired(&head.read_counter, head.head, &at)
            while number < target:
                record = record_at(head, at)
                if record.id != number + 1 or record.length > head.capacity:
                    break
                at += record_size(record.length)
                number += 1
            nml_fence()  # SYNC POINT: the records were whole if none of them is dropped yet
            if nml_load(&head.read_counter) == first:
                self.cursor_id, self.cursor_at = number, at
                return

    cdef object take_broadcast(self, bint consume):
        cdef uint64_t taken
        if not self.shared:
            return self.follow(consume)
        self.lock(&self.head.read_lock)
        try:
            taken = max(self.head.shared_id, self.first)
            self.seek(taken)
            self.missed += self.cursor_id - taken
            message = self.follow(consume)
            if consume and message is not None:
                nml_store(&self.head.shared_id, self.cursor_id)
            return message
        finally:
            pthread_mutex_unlock(&self.head.read_lock)

    cdef object follow(self, bint consume):
        """Broadcast: the message after this reader's cursor."""
        cdef Head* head = self.head
        cdef Record* record
        cdef uint64_t oldest, at, length
        while nml_load(&head.write_counter) > self.cursor_id:
            oldest = paired(&head.read_counter, head.head, &at)
            if oldest > self.cursor_id:
                self.missed += oldest - self.cursor_id
                self.cursor_id, self.cursor_at = oldest, at
                continue
            record = record_at(head, self.cursor_at)
            length = record.length
            whole = record.id == self.cursor_id + 1 and length <= head.capacity - sizeof(Record)
            if whole:
                message = bytearray(length)
                ring_get(head, self.cursor_at + sizeof(Record), PyByteArray_AS_STRING(message), length)
                self.last_time_ns = record.time_ns
            nml_fence()  # SYNC POINT: the record was whole if it is not dropped yet
            if nml_load(&head.read_counter) > self.cursor_id:
                continue
            if not whole:
                self.cursor_id = paired(&head.write_counter, head.tail, &self.cursor_at)
                raise self.damaged("a record is not where it should be")
            self.last = self.cursor_id + 1
            if consume:
                self.cursor_id += 1
                self.cursor_at += record_size(length)
                if not self.observe:
                    nml_store_max(&head.seen, self.cursor_id)
            return message
        return None

    cdef object damaged(self, str what):
        """The error for memory that no writer of ours left so."""
        return BufferError_(f"buffer {self.name} is damaged: {what}")

    def has_news(self) -> bool:
        """Whether ``read`` would return a message."""
        self.check_open()
        cdef uint64_t number = nml_load(&self.head.write_counter)
        if self.head.kind == KIND_SLOT:
            return number != self.last and number > nml_load(&self.head.cleared)
        if self.head.kind == KIND_QUEUE and not self.observe:
            return number != nml_load(&self.head.read_counter)
        if self.shared:
            return number > max(self.head.shared_id, self.first)
        return number > self.cursor_id

    def mark_read(self) -> None:
        """Single slot: let the newest message count as read."""
        self.check_open()
        nml_store_max(&self.head.seen, nml_load(&self.head.write_counter))

    def was_read(self) -> bool:
        """Whether somebody has read the newest message (queue: all of them)."""
        self.check_open()
        if self.head.kind == KIND_QUEUE:
            return nml_load(&self.head.write_counter) == nml_load(&self.head.read_counter)
        return nml_load(&self.head.seen) >= nml_load(&self.head.write_counter)

    def wait(self, double seconds) -> bool:
        """Sleep until there is something new to read, at most ``seconds`` (host time; negative: for ever)."""
        cdef uint32_t signal
        cdef int64_t left, until = now_ns() + <int64_t>(seconds * 1e9)
        cdef Head* head = self.head
        self.check_open()
        if self.diag is not NULL:
            self.diag.waits += 1
        self.sleepers += 1
        try:
            while not self.closed:
                signal = nml_load32(&head.signal)
                if self.has_news():
                    return True
                left = LONGEST_SLEEP_NS if seconds < 0.0 else min(until - now_ns(), <int64_t>LONGEST_SLEEP_NS)
                if left <= 0:
                    return False
                with nogil:
                    nml_sleep(&head.signal, &head.waiters, signal, left)
                PyErr_CheckSignals()
            return False
        finally:
            self.sleepers -= 1
            if self.closed and not self.sleepers:
                self.let_go()

    def queue_length(self) -> int:
        """Messages that wait for this reader; 0 for a single slot."""
        self.check_open()
        if self.head.kind == KIND_SLOT:
            return 0
        if self.head.kind == KIND_QUEUE:
            return nml_load(&self.head.write_counter) - nml_load(&self.head.read_counter)
        oldest = max(self.cursor_id, nml_load(&self.head.read_counter))
        return nml_load(&self.head.write_counter) - oldest

    def space(self) -> int:
        """Bytes of the longest message that could be written now."""
        cdef uint64_t start, tail, free
        self.check_open()
        if self.head.kind != KIND_QUEUE:
            return self.longest
        paired(&self.head.read_counter, self.head.head, &start)
        paired(&self.head.write_counter, self.head.tail, &tail)
        free = self.head.capacity - (tail - start)
        return free - sizeof(Record) if free > sizeof(Record) else 0

    def clear(self) -> None:
        """Forget every message; numbers go on."""
        cdef Head* head = self.head
        self.check_open()
        if head.kind == KIND_SLOT:
            nml_store(&head.cleared, nml_load(&head.write_counter))
            return
        if head.kind == KIND_BROADCAST:
            nml_store_max(&head.seen, nml_load(&head.write_counter))
            return
        self.lock(&head.read_lock)
        queue_forget(head)
        pthread_mutex_unlock(&head.read_lock)

    def age(self) -> float | None:
        """Seconds since the newest message was written; None if there never was one."""
        cdef Record* record = self.newest()
        return None if record is NULL else (now_ns() - record.time_ns) * 1e-9

    def last_writer(self) -> int:
        """Process id of the writer of the newest message; 0 if unknown (a native thread)."""
        cdef Record* record = self.newest()
        return 0 if record is NULL else record.writer

    cdef Record* newest(self) except? NULL:
        cdef Head* head = self.head
        self.check_open()
        cdef uint64_t number = nml_load(&head.write_counter)
        return slot_of(head, number) if number and head.kind == KIND_SLOT else NULL

    def diagnostics(self) -> list[dict[str, object]]:
        """The counts of every process that has used a buffer declared ``diag``."""
        cdef Diag* diag = <Diag*>(<char*>self.head + aligned(sizeof(Head)))
        self.check_open()
        return [dict(diag[i], name=diag[i].name.decode(), c_num=i) for i in range(self.head.max_procs) if diag[i].pid]

    def close(self) -> None:
        """Let go of the memory; a ``wait`` in another thread ends."""
        if not self.closed:
            self.closed = True
            if self.sleepers:
                nml_wake(&self.head.signal, &self.head.waiters)
            else:
                self.let_go()


cdef int32_t type_of(bytearray message) noexcept:
    if message is None or PyByteArray_GET_SIZE(message) < 4:
        return 0
    return (<int32_t*>PyByteArray_AS_STRING(message))[0]
