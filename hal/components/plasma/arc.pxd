"""See ``arc.pyx``."""

from hal.components.plasmac cimport Plasmac

cdef void read_arc(Plasmac* s) noexcept nogil
cdef void read_voltage(Plasmac* s) noexcept nogil
cdef void read_sensors(Plasmac* s) noexcept nogil
cdef bint arc_ignored(Plasmac* s) noexcept nogil
