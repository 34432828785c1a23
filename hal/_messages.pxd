"""What realtime functions say; see ``_messages.pyx``."""

cdef enum:
    MESSAGE_BYTES = 512

cdef void say_copy(const char* text) noexcept nogil
cdef void say(const char* text) noexcept nogil
