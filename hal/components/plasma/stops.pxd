"""See ``stops.pyx``."""

from hal.components.plasmac cimport Plasmac

cdef void see_stops(Plasmac* s) noexcept nogil
cdef void see_end_of_cut(Plasmac* s) noexcept nogil
cdef void switch_off(Plasmac* s) noexcept nogil
cdef void tell_jogging(Plasmac* s) noexcept nogil
cdef void hold(Plasmac* s) noexcept nogil
