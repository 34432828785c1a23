"""The fastest motion of a single coordinate to a standstill with limited speed, acceleration and jerk.

A motion is a row of phases of constant jerk: a change of speed (three phases) to a peak, a cruise where the peak is the
speed limit, and a change of speed to 0. The peak is found by bisection: the way grows with it. Begun outside of the
limits, a motion first comes back under them. Units: lu or degrees and seconds.
"""

from libc.math cimport fabs, sqrt

cdef double NEGLIGIBLE = 1e-11   # lu or deg: a stop that misses the target by less meets it
cdef int BISECTIONS = 60


cdef inline void add_phase(SCurve* c, double jerk, double time) noexcept nogil:
    if time > 0.0:
        c.jerk[c.phases] = jerk
        c.time[c.phases] = time
        c.phases += 1


cdef inline void travel(SCurveState* s, double jerk, double time) noexcept nogil:
    s.pos += time * (s.vel + time * (0.5 * s.acc + time * jerk / 6.0))
    s.vel += time * (s.acc + 0.5 * time * jerk)
    s.acc += time * jerk


cdef void change_speed(SCurve* c, SCurveState* s, double vel, const SCurveLimits* limits) noexcept nogil:
    """Append the fastest change to the speed ``vel`` at acceleration 0, and let ``s`` be its end."""
    cdef double natural = s.vel + 0.5 * s.acc * fabs(s.acc) / limits.jerk   # where the speed ends without a push
    cdef double way = 1.0 if vel >= natural else -1.0
    cdef double acc = way * s.acc
    cdef double gain = way * (vel - s.vel)
    cdef double jerk = limits.jerk
    cdef double top = limits.acc
    cdef double rise, hold, fall
    cdef int first = c.phases
    cdef int n
    if acc > top:
        rise = (acc - top) / jerk
        hold = (gain - 0.5 * acc * acc / jerk) / top
        add_phase(c, -way * jerk, rise)
    else:
        if jerk * gain + 0.5 * acc * acc < top * top:
            top = sqrt(max(0.0, jerk * gain + 0.5 * acc * acc))
            hold = 0.0
        else:
            hold = (gain - (top * top - 0.5 * acc * acc) / jerk) / top
        rise = (top - acc) / jerk
        add_phase(c, way * jerk, rise)
    fall = top / jerk
    add_phase(c, 0.0, hold)
    add_phase(c, -way * jerk, fall)
    for n in range(first, c.phases):
        travel(s, c.jerk[n], c.time[n])
    s.vel = vel
    s.acc = 0.0


cdef double end_with_peak(
    SCurve* c, const SCurveState* start, double peak, double cruise, const SCurveLimits* limits
) noexcept nogil:
    """Make the motion over this peak speed, and return where it ends."""
    cdef SCurveState s = start[0]
    c.phases = 0
    change_speed(c, &s, peak, limits)
    add_phase(c, 0.0, cruise)
    s.pos += peak * cruise
    if peak != 0.0:
        change_speed(c, &s, 0.0, limits)
    return s.pos


cdef void scurve_stop(SCurve* c, const SCurveState* start, const SCurveLimits* limits) noexcept nogil:
    """Come to rest."""
    end_with_peak(c, start, 0.0, 0.0, limits)


cdef double scurve_stop_point(const SCurveState* start, const SCurveLimits* limits) noexcept nogil:
    """Where a motion that is stopped now comes to rest."""
    cdef SCurve c
    return end_with_peak(&c, start, 0.0, 0.0, limits)


cdef void scurve_to(SCurve* c, const SCurveState* start, double target, const SCurveLimits* limits) noexcept nogil:
    """Come to rest at ``target``."""
    cdef double gap = target - end_with_peak(c, start, 0.0, 0.0, limits)
    cdef double way = 1.0 if gap > 0.0 else -1.0
    cdef double low = 0.0
    cdef double high = limits.vel
    cdef double peak
    cdef int n
    if fabs(gap) <= NEGLIGIBLE:
        return
    gap = way * (target - end_with_peak(c, start, way * high, 0.0, limits))
    if gap >= 0.0:
        end_with_peak(c, start, way * high, gap / high, limits)
        return
    for n in range(BISECTIONS):
        peak = 0.5 * (low + high)
        if way * (target - end_with_peak(c, start, way * peak, 0.0, limits)) > 0.0:
            low = peak
        else:
            high = peak
    end_with_peak(c, start, way * low, 0.0, limits)


cdef void scurve_advance(SCurve* c, SCurveState* state, double dt) noexcept nogil:
    """Go on for ``dt``; what is over is taken out."""
    cdef double time
    cdef int n
    cdef int over = 0
    while over < c.phases and dt > 0.0:
        time = min(dt, c.time[over])
        travel(state, c.jerk[over], time)
        c.time[over] -= time
        dt -= time
        if c.time[over] <= 0.0:
            over += 1
    c.phases -= over
    for n in range(c.phases):
        c.jerk[n] = c.jerk[n + over]
        c.time[n] = c.time[n + over]
