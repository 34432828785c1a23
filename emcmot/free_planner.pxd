"""The planner of a single coordinate: a motion that may get a new target, speed or limits at any period.

Used by joints in free mode, axes in teleop mode, external offsets and backlash. Without a jerk limit it is a trapezoid that
is exact in discrete time: with target and limits constant it lands on the target without overshoot, and its speed never
changes by more than acc_limit * dt. With a jerk limit it is the S-curve of ``scurve``. In lu or degrees and seconds.
"""

from libc.math cimport fabs, floor, sqrt

from emcmot.scurve cimport SCurve

ctypedef struct FreeOrder:       # what a motion was planned for
    double target
    double vel_limit
    double acc_limit
    double jerk_limit
    int enabled

ctypedef struct FreePlanner:
    double pos
    double vel
    double acc
    double target
    double vel_limit
    double acc_limit
    double jerk_limit   # 0: none
    int enabled         # 0: come to rest
    int active          # 1 while it moves or is not yet at its target
    SCurve curve
    FreeOrder planned


cdef inline double fastest_stoppable(double distance, double acc, double dt) noexcept nogil:
    """The highest speed for one period from which ``distance`` (>= 0) suffices to stop, decelerating acc * dt a period."""
    cdef double unit = acc * dt * dt
    cdef double d, k
    if unit <= 0.0:
        return 0.0
    d = distance / unit
    k = floor(0.5 * (sqrt(1.0 + 8.0 * d) - 1.0))
    return (k + (d - 0.5 * k * (k + 1.0)) / (k + 1.0)) * acc * dt


cdef void scurve_step(FreePlanner* p, double dt) noexcept nogil
cdef void free_planner_rest_at(FreePlanner* p, double pos) noexcept nogil      # stand still there
cdef double free_planner_stop_point(const FreePlanner* p, double dt) noexcept nogil  # where it rests when stopped now
cdef double free_planner_stopping_way(const FreePlanner* p) noexcept nogil     # from its greatest speed


cdef inline void trapezoid_step(FreePlanner* p, double dt) noexcept nogil:
    cdef double wanted = 0.0
    cdef double before = p.vel
    cdef double gap = p.target - p.pos
    cdef double step = p.acc_limit * dt
    cdef double limit = p.vel_limit
    cdef double rounding = 1e-12  # of 1 + |target|, on the way to it
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
    if p.enabled and fabs(gap - p.vel * dt) <= rounding * (1.0 + fabs(p.target)) and fabs(p.vel) <= step:
        p.pos = p.target
    else:
        p.pos += p.vel * dt
    p.acc = (p.vel - before) / dt
    p.active = p.vel != 0.0 or (p.enabled and p.pos != p.target)


cdef inline void free_planner_step(FreePlanner* p, double dt) noexcept nogil:
    """Advance by one period."""
    if p.jerk_limit > 0.0 and p.acc_limit > 0.0:
        scurve_step(p, dt)
    else:
        p.planned.jerk_limit = 0.0
        trapezoid_step(p, dt)
