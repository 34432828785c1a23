"""See ``states.pyx``."""

from hal.components.plasmac cimport Plasmac

cdef void step(Plasmac* s) noexcept nogil
