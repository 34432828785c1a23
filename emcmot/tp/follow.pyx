"""Moves that follow a spindle: threads (position) and feed per revolution (velocity).

A chain of position-synchronised moves begins at rest, at the spindle's index pulse. It speeds up as hard as the axes allow
until it is as fast as the spindle asks; the revolutions that this took are the same for every pass, so passes meet in one
groove. From then on the way travelled, counted in revolutions, is held to the spindle's: the speed asked for is the
spindle's plus a correction that the error decays with.
Called by advance for the executing segment; the look-ahead counts these moves at their largest velocity.
"""

from libc.math cimport fabs, fmax, fmin, sqrt

from emcmot.tp.model cimport (
    AXES,
    CHAIN_ACCELERATING,
    CHAIN_FOLLOWING,
    CHAIN_NONE,
    CHAIN_WAITING,
    Segment,
    TpState,
)

cdef double DECAY = 0.1          # share of the position error that one servo period corrects,
cdef double SMOOTH_DECAY = 0.25  # and that is corrected in the time in which an acceleration comes and goes


cdef int follows_position(const Segment* seg) noexcept nogil:
    return seg.spindle >= 0 and seg.sync_revs > 0.0 and not seg.sync_velocity


cdef int follows_velocity(const Segment* seg) noexcept nogil:
    return seg.spindle >= 0 and seg.sync_revs > 0.0 and seg.sync_velocity


cdef int waits_for_index(TpState* tp, const Segment* seg) noexcept nogil:
    """Whether a chain of position-synchronised moves that begins with `seg` must still wait. Asked at rest before it."""
    if tp.chain == CHAIN_NONE:
        tp.chain = CHAIN_WAITING
        tp.index_seen = 0
    if tp.chain == CHAIN_WAITING and tp.index_seen:
        tp.chain = CHAIN_ACCELERATING
        tp.chain_revs = 0.0
    return tp.chain == CHAIN_WAITING


cdef double spindle_speed(TpState* tp, const Segment* seg) noexcept nogil:
    """du/dt that the spindle asks for in this period.

    Positions are compared once in a period, at its start, where both are of the same instant.
    """
    if seg.sync_velocity:
        return fabs(tp.spindle_rps[seg.spindle]) * seg.sync_revs
    if not tp.lead_known:
        tp.lead_rps = _lead(tp, seg)
        tp.lead_known = 1
    return tp.lead_rps * seg.sync_revs


cdef double _lead(TpState* tp, const Segment* seg) noexcept nogil:
    """Revolutions per second that the way should make: the spindle's, and what corrects the error."""
    cdef double rps = fabs(tp.spindle_rps[seg.spindle]), turned = fabs(tp.spindle_revs[seg.spindle])
    cdef double error, correction
    if tp.chain == CHAIN_ACCELERATING:
        if sqrt(tp.w) < rps * seg.sync_revs * (1.0 - 1e-9):
            return rps
        tp.chain = CHAIN_FOLLOWING
        tp.chain_origin = turned - tp.chain_revs
    error = turned - tp.chain_origin - tp.chain_revs
    correction = fmin(_decay(tp, seg) * fabs(error), sqrt(fabs(error) * _acceleration(tp, seg) / seg.sync_revs))
    return fmax(0.0, rps + (correction if error > 0.0 else -correction))


cdef double _decay(const TpState* tp, const Segment* seg) noexcept nogil:
    """How fast errors decay, 1/s: where jerk is limited, more slowly than accelerations come and go."""
    cdef double decay = DECAY / tp.dt
    cdef int i
    if tp.smooth:
        for i in range(AXES):
            if seg.rate[i] != 0.0:
                decay = fmin(decay, SMOOTH_DECAY * tp.jmax[i] / tp.amax[i])
    return decay


cdef double _acceleration(const TpState* tp, const Segment* seg) noexcept nogil:
    """Half of the acceleration that the axes allow along a straight move: what corrections may use."""
    cdef double a = 1e300
    cdef int i
    for i in range(AXES):
        if seg.rate[i] != 0.0:
            a = fmin(a, tp.amax[i] / fabs(seg.rate[i]))
    return 0.5 * a


cdef void count_way(TpState* tp, const Segment* seg, double way) noexcept nogil:
    """Count the way that was travelled on `seg`; a move of another kind ends the chain."""
    if follows_position(seg):
        tp.chain_revs += way / seg.sync_revs
    else:
        tp.chain = CHAIN_NONE
