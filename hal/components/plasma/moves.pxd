"""How `plasmac` moves the axes by offsets, and waits; all inline. Each call does one period of it."""

from libc.math cimport fabs, sqrt
from libc.stdint cimport int32_t

from hal.cell cimport hal_at as at

from hal.components.plasmac cimport Plasmac


cdef inline bint over(float* time, double dt) noexcept nogil:
    """Whether a time that is counted down is over; else one period of it."""
    if time[0] <= 0.0:
        return True
    time[0] = <float>(time[0] - dt)
    return False

cdef inline int32_t counted(Plasmac* s, double distance) noexcept nogil:
    return <int32_t>(distance / s.scale) if s.scale != 0.0 else 0

cdef inline int32_t counts_for(Plasmac* s, double height) noexcept nogil:
    """The offset with which the Z axis is at a height of the machine."""
    return counted(s, height - (at(s.axis_z_position).f - at(s.z_offset_current).f))

cdef inline int32_t nearer(int32_t now, int32_t target, int32_t most) noexcept nogil:
    return min(now + most, target) if now < target else max(now - most, target)

cdef inline int32_t setup_step(Plasmac* s) noexcept nogil:
    return <int32_t>(at(s.setup_feed_rate).f * s.rate)

cdef inline double xy_step(Plasmac* s, double feed) noexcept nogil:
    return feed / 60.0 * s.dt / s.scale if s.scale != 0.0 else 0.0

cdef inline bint z_reached(Plasmac* s) noexcept nogil:
    """Whether the Z axis is at its target; else one period on the way."""
    if at(s.z_offset_counts).s == s.z_target:
        return True
    at(s.z_offset_counts).s = nearer(at(s.z_offset_counts).s, s.z_target, setup_step(s))
    return False

cdef inline void aim_xy(Plasmac* s, int32_t x, int32_t y, double step) noexcept nogil:
    """Begin a straight line of X and Y, so many counts a period."""
    cdef double dx = <double>x - at(s.x_offset_counts).s, dy = <double>y - at(s.y_offset_counts).s
    cdef double rest = sqrt(dx * dx + dy * dy)
    s.x_target = x
    s.y_target = y
    s.x_step = <int32_t>(step * fabs(dx) / rest) if rest > 0.0 else 0
    s.y_step = <int32_t>(step * fabs(dy) / rest) if rest > 0.0 else 0

cdef inline bint xy_reached(Plasmac* s) noexcept nogil:
    """Whether X and Y are at their targets; else one period on the way."""
    if at(s.x_offset_counts).s == s.x_target and at(s.y_offset_counts).s == s.y_target:
        return True
    at(s.x_offset_counts).s = nearer(at(s.x_offset_counts).s, s.x_target, s.x_step)
    at(s.y_offset_counts).s = nearer(at(s.y_offset_counts).s, s.y_target, s.y_step)
    return False
