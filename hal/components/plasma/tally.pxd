"""See ``tally.pyx``."""

from hal.components.plasmac cimport Plasmac

cdef void count_times(Plasmac* s) noexcept nogil
cdef void tell_feeds(Plasmac* s) noexcept nogil
