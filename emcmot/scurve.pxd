"""The fastest motion of a single coordinate to a standstill with limited speed, acceleration and jerk."""

cdef enum:
    SCURVE_PHASES = 7

ctypedef struct SCurve:
    int phases               # still to come
    double jerk[SCURVE_PHASES]
    double time[SCURVE_PHASES]   # s left of each phase

ctypedef struct SCurveState:
    double pos
    double vel
    double acc

ctypedef struct SCurveLimits:
    double vel
    double acc
    double jerk

cdef void scurve_to(SCurve* c, const SCurveState* start, double target, const SCurveLimits* limits) noexcept nogil
cdef void scurve_stop(SCurve* c, const SCurveState* start, const SCurveLimits* limits) noexcept nogil
cdef void scurve_advance(SCurve* c, SCurveState* state, double dt) noexcept nogil
cdef double scurve_stop_point(const SCurveState* start, const SCurveLimits* limits) noexcept nogil
