"""The planner of a single coordinate: a trapezoid that may get a new target, speed or acceleration at any period.

Used by joints in free mode, axes in teleop mode and external offsets. It is exact in discrete time: with target and
limits constant it lands on the target without overshoot, and its speed never changes by more than acc_limit * dt.
Suffix-free names are in lu or degrees and seconds.
"""

from libc.math cimport fabs, floor, sqrt

ctypedef struct FreePlanner:
    double pos
    double vel
    double target
    double vel_limit
    double acc_limit
    int enabled      # 0: come to rest
    int active       # 1 while it moves or is not yet at its target


cdef inline double fastest_stoppable(double distance, double acc, double dt) noexcept nogil:
    """The highest speed for one period from which ``distance`` (>= 0) suffices to stop, decelerating acc * dt a period."""
    cdef double unit = acc * dt * dt
    cdef double d, k
    if unit <= 0.0:
        return 0.0
    d = distance / unit
    k = floor(0.5 * (sqrt(1.0 + 8.0 * d) - 1.0))
    return (k + (d - 0.5 * k * (k + 1.0)) / (k + 1.0)) * acc * dt


cdef inline void free_planner_step(FreePlanner* p, double dt) noexcept nogil:
    """Advance by one period."""
    cdef double wanted = 0.0
    cdef double gap = p.target - p.pos
    cdef double step = p.acc_limit * dt
    cdef double limit = p.vel_limit
    if p.enabled and gap != 0.0:
        wanted = fastest_stoppable(fabs(gap), p.acc_limit, dt)
        if wanted > limit:
            wanted = limit
        if gap < 0.0:
            wanted = -wanted
    if wanted > p.vel + step:
        p.vel += step
    elif wanted < p.vel - step:
        p.vel -= step
    else:
        p.vel = wanted
    if p.enabled and fabs(gap - p.vel * dt) <= 1e-12 * (1.0 + fabs(p.target)) and fabs(p.vel) <= step:
        p.pos = p.target
    else:
        p.pos += p.vel * dt
    p.active = p.vel != 0.0 or (p.enabled and p.pos != p.target)


cdef inline void free_planner_rest_at(FreePlanner* p, double pos) noexcept nogil:
    """Stand still at ``pos``."""
    p.pos = pos
    p.target = pos
    p.vel = 0.0
    p.enabled = 0
    p.active = 0


cdef inline double free_planner_stop_point(const FreePlanner* p, double dt) noexcept nogil:
    """Where it comes to rest when it is stopped now."""
    cdef double speed = fabs(p.vel)
    cdef double step = p.acc_limit * dt
    cdef double n, way
    if step <= 0.0:
        return p.pos
    n = floor(speed / step)
    way = (n * speed - 0.5 * n * (n + 1.0) * step) * dt
    return p.pos + way if p.vel > 0.0 else p.pos - way
