"""A step on the way of one axis to a target, with limits of velocity and acceleration; all inline, no state of its own."""

from libc.math cimport fabs, sqrt

cdef struct Profile:
    double pos
    double vel  # per s


cdef inline bint approach(Profile* way, double target, double maxvel, double maxaccel, double dt) noexcept nogil:
    """One period; whether it still moves. Its velocity is the highest from which `maxaccel` stops at the target."""
    cdef double step = maxaccel * dt
    cdef double rest = target - way.pos
    cdef double v = 0.0
    if fabs(rest) > step * dt * 1e-3:
        v = sqrt(2.0 * maxaccel * fabs(rest) + step * step) - step
        v = -v if rest < 0.0 else v
    v = min(max(v, -maxvel), maxvel)
    way.vel = min(max(v, way.vel - step), way.vel + step)
    way.pos += way.vel * dt
    return way.vel != 0.0 or v != 0.0


cdef inline bint slow_down(Profile* way, double maxaccel, double dt) noexcept nogil:
    """One period of coming to rest; whether it still moves."""
    cdef double step = maxaccel * dt
    way.vel = min(max(0.0, way.vel - step), way.vel + step)
    way.pos += way.vel * dt
    return way.vel != 0.0
