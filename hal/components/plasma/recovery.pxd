"""See ``recovery.pyx``."""

from hal.components.plasmac cimport Plasmac

cdef bint busy_while_paused(Plasmac* s) noexcept nogil
cdef bint laser_in_the_way(Plasmac* s) noexcept nogil
cdef void paused_motion(Plasmac* s) noexcept nogil
cdef void go_to_change(Plasmac* s) noexcept nogil
cdef void return_from_change(Plasmac* s) noexcept nogil
cdef void recover(Plasmac* s) noexcept nogil
cdef void end_recovery(Plasmac* s) noexcept nogil
