"""Spindles: commands in, pins out, once a period."""

from libc.math cimport fabs

from emcmot._messages cimport Enables_SS
from emcmot.state cimport ORIENT_IN_PROGRESS, Motion, Spindle

cdef void orient_cycle(Motion* m, Spindle* s, int number) noexcept nogil
cdef void stop_spindle(Spindle* s) noexcept nogil
cdef void stop_spindles(Motion* m) noexcept nogil
cdef void orient_spindle(Spindle* s, double angle, int mode) noexcept nogil


cdef inline double wanted_speed(Motion* m, Spindle* s) noexcept nogil:
    """The commanded speed with constant surface speed, override and the spindle's limits, signed."""
    cdef double speed = s.speed
    cdef double radius, size
    if s.state == 0:
        return 0.0
    if s.css_factor != 0.0:
        radius = fabs(s.xoffset - m.pos_cmd[0])
        size = fabs(s.css_factor) / radius if radius > 0.0 else fabs(s.css_maximum)
        if s.css_maximum != 0.0 and size > fabs(s.css_maximum):
            size = fabs(s.css_maximum)
        speed = -size if s.css_factor < 0.0 or s.speed < 0.0 else size
    speed *= s.net_scale
    if s.tap_scale != 0.0:
        speed *= s.tap_scale
    if speed > 0.0:
        return min(max(speed, s.min_speed), s.max_speed)
    if speed < 0.0:
        return max(min(speed, s.min_reverse_speed), s.max_reverse_speed)
    return 0.0


cdef inline void spindle_cycle(Motion* m) noexcept nogil:
    cdef int n
    cdef Spindle* s
    for n in range(m.num_spindles):
        s = &m.spindle[n]
        s.net_scale = s.scale if m.enables & Enables_SS else 1.0
        if s.inhibit:
            s.net_scale = 0.0
        if s.orient_state == ORIENT_IN_PROGRESS:
            orient_cycle(m, s, n)
        s.speed_out = wanted_speed(m, s)
        s.speed_out_abs = fabs(s.speed_out)
        s.speed_out_rps = s.speed_out / 60.0
        s.speed_out_rps_abs = s.speed_out_abs / 60.0
        s.speed_cmd_rps = s.speed / 60.0
        s.on = s.speed_out != 0.0
        s.forward = s.speed_out > 0.0
        s.reverse = s.speed_out < 0.0


cdef inline int spindles_at_speed(Motion* m) noexcept nogil:
    """Bit mask of the spindles whose at-speed pin is true."""
    cdef int n
    cdef int mask = 0
    for n in range(m.num_spindles):
        if m.spindle[n].at_speed:
            mask |= 1 << n
    return mask
