"""Spindles: commands in, pins out, once a period."""

from emcmot.state cimport Motion, Spindle

cdef void spindle_cycle(Motion* m) noexcept nogil
cdef void stop_spindle(Spindle* s) noexcept nogil
cdef void stop_spindles(Motion* m) noexcept nogil
cdef void orient_spindle(Spindle* s, double angle, int mode) noexcept nogil
cdef int spindles_at_speed(Motion* m) noexcept nogil
