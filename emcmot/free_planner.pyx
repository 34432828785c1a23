"""The planner of a single coordinate, see ``free_planner.pxd``."""

from libc.math cimport fabs

from emcmot.scurve cimport SCurveLimits, SCurveState, scurve_advance, scurve_stop, scurve_stop_point, scurve_to


cdef inline SCurveState state_of(const FreePlanner* p) noexcept nogil:
    return SCurveState(p.pos, p.vel, p.acc)


cdef inline SCurveLimits limits_of(const FreePlanner* p) noexcept nogil:
    return SCurveLimits(p.vel_limit, p.acc_limit, p.jerk_limit)


cdef int plan_holds(const FreePlanner* p) noexcept nogil:
    """Whether the curve is the one for what is wanted now; a stop has no target and needs no speed."""
    cdef const FreeOrder* o = &p.planned
    if o.enabled != p.enabled or o.acc_limit != p.acc_limit or o.jerk_limit != p.jerk_limit:
        return 0
    return not p.enabled or (o.target == p.target and o.vel_limit == p.vel_limit)


cdef void plan(FreePlanner* p) noexcept nogil:
    cdef SCurveState start = state_of(p)
    cdef SCurveLimits limits = limits_of(p)
    if p.enabled and limits.vel > 0.0:
        scurve_to(&p.curve, &start, p.target, &limits)
    else:
        scurve_stop(&p.curve, &start, &limits)
    p.planned = FreeOrder(p.target, p.vel_limit, p.acc_limit, p.jerk_limit, p.enabled)


cdef void scurve_step(FreePlanner* p, double dt) noexcept nogil:
    cdef SCurveState state
    if not plan_holds(p):
        plan(p)
    state = state_of(p)
    scurve_advance(&p.curve, &state, dt)
    p.pos, p.vel, p.acc = state.pos, state.vel, state.acc
    if p.curve.phases == 0:
        p.vel = p.acc = 0.0
        if p.enabled and p.vel_limit > 0.0:
            p.pos = p.target
    p.active = p.curve.phases > 0 or (p.enabled and p.pos != p.target)


cdef void free_planner_rest_at(FreePlanner* p, double pos) noexcept nogil:
    p.pos = pos
    p.target = pos
    p.vel = 0.0
    p.acc = 0.0
    p.enabled = 0
    p.active = 0
    p.curve.phases = 0
    p.planned.jerk_limit = 0.0   # the next motion is planned anew


cdef double free_planner_stop_point(const FreePlanner* p, double dt) noexcept nogil:
    cdef SCurveState start = state_of(p)
    cdef SCurveLimits limits = limits_of(p)
    cdef double speed = fabs(p.vel)
    cdef double step = p.acc_limit * dt
    cdef double n, way
    if step <= 0.0:
        return p.pos
    if p.jerk_limit > 0.0:
        return scurve_stop_point(&start, &limits)
    n = floor(speed / step)
    way = (n * speed - 0.5 * n * (n + 1.0) * step) * dt
    return p.pos + way if p.vel > 0.0 else p.pos - way


cdef double free_planner_stopping_way(const FreePlanner* p) noexcept nogil:
    cdef SCurveState start = SCurveState(0.0, p.vel_limit, 0.0)
    cdef SCurveLimits limits = limits_of(p)
    if p.jerk_limit > 0.0:
        return scurve_stop_point(&start, &limits)
    return p.vel_limit * p.vel_limit / (2.0 * p.acc_limit)
