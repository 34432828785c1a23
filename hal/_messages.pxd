"""What realtime functions say; see ``_messages.pyx``."""

cdef void say(const char* text) noexcept nogil
