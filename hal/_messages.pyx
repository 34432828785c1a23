"""Messages of realtime functions, for the realtime host to pass on: a ring that takes them without waiting.

`say` only stores the address of a text, which must live as long as the process, `say_copy` keeps a copy; what finds the
ring full is lost.
"""

from libc.stdint cimport uint64_t
from libc.string cimport strncpy

cdef extern from *:
    """
    #define message_place(where) __atomic_fetch_add(where, 1, __ATOMIC_ACQ_REL)
    #define message_count(where) __atomic_load_n(where, __ATOMIC_ACQUIRE)
    #define message_put(where, value) __atomic_store_n(where, value, __ATOMIC_RELEASE)
    #define message_take(where) __atomic_exchange_n(where, (const char *)0, __ATOMIC_ACQ_REL)
    """
    uint64_t message_place(uint64_t* where) nogil
    uint64_t message_count(uint64_t* where) nogil
    void message_put(const char** where, const char* value) nogil
    const char* message_take(const char** where) nogil

cdef enum:
    PLACES = 64

cdef const char* ring[PLACES]
cdef char copies[PLACES][MESSAGE_BYTES]
cdef uint64_t said = 0
cdef uint64_t heard = 0


cdef void say(const char* text) noexcept nogil:
    """Pass a text on; from any thread."""
    if message_count(&said) - message_count(&heard) < PLACES:
        message_put(&ring[message_place(&said) % PLACES], text)


cdef void say_copy(const char* text) noexcept nogil:
    """Pass a copy on, of `MESSAGE_BYTES` with its closing zero at most; from any thread."""
    cdef uint64_t place
    if message_count(&said) - message_count(&heard) < PLACES:
        place = message_place(&said) % PLACES
        strncpy(copies[place], text, MESSAGE_BYTES - 1)
        message_put(&ring[place], copies[place])


def hear() -> list:
    """The texts said since the last call, in order."""
    global heard
    cdef list texts = []
    cdef const char* text
    while heard < message_count(&said):
        text = message_take(&ring[heard % PLACES])
        if text == NULL:  # its thread is about to store it
            break
        texts.append(text.decode(errors="replace").rstrip("\n"))
        heard += 1
    return texts
