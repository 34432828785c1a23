"""See ``thc.pyx``."""

from hal.components.plasmac cimport Plasmac

cdef void control_height(Plasmac* s) noexcept nogil
cdef void begin_cut(Plasmac* s) noexcept nogil
cdef void tell_thc(Plasmac* s) noexcept nogil
cdef void hear_voltage(Plasmac* s) noexcept nogil
