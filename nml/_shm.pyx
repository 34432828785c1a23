"""Buffers in shared memory: one message (the newest), a queue, or a queue in which every reader has its own cursor.

A segment is ``Head``, one ``Diag`` per possible process, then the data. What a reader may see is decided by single
atomic words that are stored last; until then a write or a read has not happened, so a process may be killed anywhere.

* Single slot: message *n* lies in slot *n* mod 4, and the slot's ``id`` is 0 while it is being written. A reader copies
  and looks at the id again; it never holds up the writer, and nobody waits for it.
* Queue: a ring of records. A write copies the record, then its end (``tail``), then the write counter: that commits it;
  a read does the same with ``head`` and the read counter. ``tail`` and ``head`` exist twice, for even and odd counters,
  so that the value that belongs to the committed counter is always intact.
* Broadcast queue: the writer drops the oldest records; a reader that was too slow learns how many it missed.

Writers among themselves, and readers of a queue among themselves, take a robust mutex; when its owner was killed the
next one gets it and finds everything as it was committed. A native thread that is the only writer (or reader) uses the
C functions and no lock.
"""

from libc.stddef cimport size_t
from libc.stdint cimport int64_t, uint32_t, uint64_t
from libc.string cimport memcpy, memset, strncpy

from nml._layout cimport *

from nml.errors import BufferError_

LAYOUT_VERSION = 0x4C4D4E_0004
cdef uint64_t VERSION = LAYOUT_VERSION

SLOT, QUEUE, BROADCAST = KIND_SLOT, KIND_QUEUE, KIND_BROADCAST


cdef void* slot_begin(void* buffer) noexcept nogil:
    """Where the next message is to be written; an older one of this buffer lies there. For the only writer."""
    cdef Head* head = <Head*>buffer
    cdef Record* slot = slot_of(head, head.write_counter + 1)
    nml_store(&slot.id, 0)
    nml_fence()  # SYNC POINT: a reader that sees new bytes also sees id 0
    return slot + 1


cdef void slot_commit(void* buffer, size_t size) noexcept nogil:
    """Publish what was written since ``slot_begin``: a message of at most ``capacity`` bytes."""
    cdef Head* head = <Head*>buffer
    cdef uint64_t number = head.write_counter + 1
    cdef Record* slot = slot_of(head, number)
    slot.length = size
    slot.time_ns = now_ns()
    nml_store(&slot.id, number)
    nml_store(&head.write_counter, number)  # SYNC POINT: published
    nml_wake(&head.signal, &head.waiters)


cdef void slot_write(void* buffer, const void* src, size_t size) noexcept nogil:
    """Publish a message of at most ``capacity`` bytes. For the only writer of the buffer."""
    memcpy(slot_begin(buffer), src, size)
    slot_commit(buffer, size)


cdef uint64_t write_count(void* buffer) noexcept nogil:
    """Messages ever written to the buffer."""
    return nml_load(&(<Head*>buffer).write_counter)


cdef uint64_t pulse_count(void* buffer) noexcept nogil:
    """Signs of life of the buffer's writer; see ``nml.pulse``."""
    return nml_load(&(<Head*>buffer).pulse)


cdef void ring_commit(Head* head, uint64_t number, uint64_t tail) noexcept nogil:
    nml_store(&head.tail[number & 1], tail)
    nml_store(&head.write_counter, number)  # SYNC POINT: the record exists
    nml_wake(&head.signal, &head.waiters)


cdef void ring_write(Head* head, uint64_t tail, const char* src, uint64_t size, int64_t writer) noexcept nogil:
    cdef Record* record = record_at(head, tail)
    cdef uint64_t number = head.write_counter + 1
    nml_store(&head.reserved, tail + record_size(size))
    nml_fence()  # SYNC POINT: an observer that copies overwritten bytes sees what was reserved
    record.id = number
    record.length = size
    record.time_ns = now_ns()
    record.writer = writer
    ring_put(head, tail + sizeof(Record), src, size)
    ring_commit(head, number, tail + record_size(size))


cdef int queue_push(void* buffer, const void* src, size_t size) noexcept nogil:
    """Append a message; 0, or -1 if there is no room. For the only writer of the buffer."""
    return queue_append(<Head*>buffer, src, size, 0)


cdef int queue_append(Head* head, const void* src, size_t size, int64_t writer) noexcept nogil:
    cdef uint64_t start, tail
    paired(&head.read_counter, head.head, &start)
    paired(&head.write_counter, head.tail, &tail)
    if record_size(size) > head.capacity - (tail - start):
        return -1
    ring_write(head, tail, <const char*>src, size, writer)
    return 0


cdef size_t queue_pop(void* buffer, void* dst, size_t capacity) noexcept nogil:
    """Take the oldest message: its length, 0 if there is none; ``capacity`` bytes at most are copied.

    For the only reader of the buffer.
    """
    cdef Head* head = <Head*>buffer
    cdef uint64_t at
    cdef uint64_t number = paired(&head.read_counter, head.head, &at)
    if nml_load(&head.write_counter) == number:
        return 0
    cdef uint64_t length = record_at(head, at).length
    if length > head.capacity - sizeof(Record):
        queue_forget(head)  # damaged: no length that a writer could have stored
        return 0
    ring_get(head, at + sizeof(Record), <char*>dst, min(length, <uint64_t>capacity))
    queue_commit_read(head, number + 1, at + record_size(length))
    return length


cdef void queue_forget(Head* head) noexcept nogil:
    """Let every record of the queue count as read."""
    cdef uint64_t tail
    cdef uint64_t number = paired(&head.write_counter, head.tail, &tail)
    queue_commit_read(head, number, tail)


cdef void queue_commit_read(Head* head, uint64_t number, uint64_t start) noexcept nogil:
    nml_store(&head.head[number & 1], start)
    nml_store(&head.read_counter, number)  # SYNC POINT: the record is gone
    nml_store_max(&head.seen, number)


cdef void drop_until_room(Head* head, uint64_t tail, uint64_t size) noexcept nogil:
    """Broadcast: drop the oldest records until ``size`` bytes are free."""
    cdef uint64_t start
    cdef uint64_t number = paired(&head.read_counter, head.head, &start)
    while size > head.capacity - (tail - start):
        start += record_size(record_at(head, start).length)
        number += 1
        nml_store(&head.head[number & 1], start)
        nml_store(&head.read_counter, number)
    nml_fence()  # SYNC POINT: a reader that copies overwritten bytes sees the new read counter


def segment_size(int kind, uint64_t size, uint32_t max_procs) -> int:
    """Bytes of the segment for a buffer of ``size`` bytes."""
    cdef uint64_t data = SLOTS * aligned(sizeof(Record) + size) if kind == KIND_SLOT else aligned(size)
    return aligned(sizeof(Head)) + aligned(max_procs * sizeof(Diag)) + data


def format_segment(memory, str name, int kind, uint64_t size, uint32_t max_procs) -> None:
    """Make an empty buffer in ``memory``, which nobody else uses."""
    cdef unsigned char[::1] view = memory
    cdef Head* head = <Head*>&view[0]
    nml_store(&head.version, 0)
    memset(<char*>head + sizeof(uint64_t), 0, segment_size(kind, 0, max_procs) - sizeof(uint64_t))
    head.kind = kind
    head.max_procs = max_procs
    head.capacity = size if kind == KIND_SLOT else aligned(size)
    head.total = segment_size(kind, size, max_procs)
    if kind == KIND_SLOT:
        for number in range(SLOTS):
            slot_of(head, number).id = 0
    encoded = name.encode()
    strncpy(head.name, encoded, NAME_LENGTH - 1)
    renew_locks(memory)
    nml_store(&head.version, VERSION)  # SYNC POINT: complete


def renew_locks(memory) -> None:
    """Free both locks of a buffer that nobody else uses."""
    cdef unsigned char[::1] view = memory
    cdef Head* head = <Head*>&view[0]
    if nml_mutex_init(&head.write_lock) or nml_mutex_init(&head.read_lock):
        raise BufferError_("this system has no robust process-shared mutex")


def is_complete(memory) -> bool:
    """Whether a buffer was made to its end in ``memory``, by this version of the program."""
    cdef unsigned char[::1] view = memory
    return nml_load(&(<Head*>&view[0]).version) == VERSION


def check_segment(memory, str name, int kind, uint64_t size, uint32_t max_procs) -> None:
    """BufferError_ unless the complete buffer in ``memory`` has just this declaration."""
    cdef unsigned char[::1] view = memory
    cdef Head* head = <Head*>&view[0]
    found = (head.name.decode(), head.kind, head.total, head.max_procs)
    wanted = (name, kind, segment_size(kind, size, max_procs), max_procs)
    if found != wanted:
        raise BufferError_(
            f"buffer {name}: in use with another declaration: (name, kind, bytes, processes) {found}, here {wanted}"
        )
