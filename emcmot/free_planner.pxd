"""The planner of a single coordinate: a motion that may get a new target, speed or limits at any period.

Used by joints in free mode, axes in teleop mode, external offsets and backlash. Without a jerk limit it is a trapezoid that
is exact in discrete time: with target and limits constant it lands on the target without overshoot, and its speed never
changes by more than acc_limit * dt. With a jerk limit it is the S-curve of ``scurve``. In lu or degrees and seconds.
"""

from libc.math cimport floor, sqrt

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


cdef void free_planner_step(FreePlanner* p, double dt) noexcept nogil          # advance by one period
cdef void free_planner_rest_at(FreePlanner* p, double pos) noexcept nogil      # stand still there
cdef double free_planner_stop_point(const FreePlanner* p, double dt) noexcept nogil  # where it rests when stopped now
cdef double free_planner_stopping_way(const FreePlanner* p) noexcept nogil     # from its greatest speed
