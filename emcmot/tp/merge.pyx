"""From raws to segments: runs of short moves become chords.

CAM programs describe curves by short moves with rounded coordinates, and rounding bends the corners between them far more
than the curve does. Within the tolerance P, half of it is spent on this: as many moves as stay within P/2 of one chord
become that chord, and the other half is left for the blends between chords, which then follow the curve smoothly. Chords of
a curve are made of similar length, because a blend can only be as long as the shorter of its neighbours.
Called by path (building); tp asks `can_join` for each new raw.
"""

from libc.math cimport INFINITY, fmax, fmin, sqrt
from libc.stdint cimport int64_t

from emcmot.tp.model cimport AXES, Segment, TpState
from emcmot.tp.tp cimport TP_LINE, TP_TERM_BLEND

cdef enum:
    LONGEST_RUN = 64             # raws in one chord

cdef double SHARE = 0.5          # of the tolerance that chords may use,
cdef double SMOOTH_SHARE = 0.1  # and where jerk is limited: there corners are as wide as several chords
cdef double SHARPEST_JOINT = 0.3 # difference of unit tangents; sharper corners are meant, unless less than P stands out
cdef double ALIKE = 0.75         # ratio of the tolerances of neighbours below which a run ends
cdef double GROWTH = 1.3         # of one chord over the one before


cdef inline Segment* _raw(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.raws[index & tp.raw_mask]


cdef inline Segment* _seg(const TpState* tp, int64_t index) noexcept nogil:
    return &tp.segs[index & tp.seg_mask]


cdef int can_join(const Segment* before, const Segment* raw) noexcept nogil:
    """Whether two moves may be parts of one chord: short moves of one curve under the same conditions."""
    cdef double bend = 0.0
    cdef int i
    if before.kind != TP_LINE or raw.kind != TP_LINE or raw.term != TP_TERM_BLEND or before.term != TP_TERM_BLEND:
        return 0
    if raw.has_io or raw.wait_spindles or raw.indexer >= 0 or raw.spindle >= 0 or before.spindle >= 0:
        return 0
    if raw.motion_type != before.motion_type or raw.enables != before.enables or raw.unit != before.unit:
        return 0
    if raw.vel != before.vel or raw.tolerance <= 0.0 or before.tolerance <= 0.0:
        return 0
    if fmin(raw.tolerance, before.tolerance) < ALIKE * fmax(raw.tolerance, before.tolerance):
        return 0
    for i in range(AXES):
        bend += (raw.rate[i] - before.rate[i]) * (raw.rate[i] - before.rate[i])
    bend = sqrt(bend)
    return bend < SHARPEST_JOINT or (bend < 1.0 and bend * fmin(before.length, raw.length) < raw.tolerance)


cdef int take_segment(TpState* tp, int urgent) noexcept nogil:
    """Make the next segment, of how many raws; 0 when there is none, or it is not urgent and the run may still go on."""
    cdef int64_t first = tp.raw_next
    cdef int available = <int>min(tp.raw_tail - first, LONGEST_RUN), count = 1, run, cut
    cdef double longest
    cdef Segment* seg = _seg(tp, tp.seg_tail)
    if available <= 0:
        return 0
    longest = _longest_chord(tp, first)
    while count < available and _raw(tp, first + count).joins and _deviation(tp, first, count + 1, longest) >= 0.0:
        count += 1
    cut = count == available and count < LONGEST_RUN
    if cut and not urgent:
        return 0
    if count > 1:
        run = _run_beyond(tp, first + count, count)
        if run < count:
            count = (count + run + 1) // 2
    seg[0] = _raw(tp, first)[0]
    seg.raw_first = first
    seg.raw_count = count
    seg.cut = cut
    seg.deviation = 0.0
    if count > 1:
        seg.deviation = _deviation(tp, first, count, INFINITY)
        _make_chord(tp, seg, first, count)
    tp.raw_next += count
    tp.seg_tail += 1
    return count


cdef double _longest_chord(const TpState* tp, int64_t first) noexcept nogil:
    """Length that keeps the next chord similar to the one before, where they are parts of one run."""
    cdef const Segment* raw = _raw(tp, first)
    if tp.seg_tail <= tp.seg_head or not raw.joins or _seg(tp, tp.seg_tail - 1).cut:
        return INFINITY
    return fmax(GROWTH * _seg(tp, tp.seg_tail - 1).length, 1.5 * raw.length)


cdef int _run_beyond(const TpState* tp, int64_t index, int count) noexcept nogil:
    """How many raws, up to `count`, follow in the same run."""
    cdef int run = 0
    if index + count > tp.raw_tail:
        return count
    while run < count and _raw(tp, index + run).joins:
        run += 1
    return run


cdef double _deviation(const TpState* tp, int64_t first, int count, double longest) noexcept nogil:
    """Distance of the corners of `count` raws from their chord; -1 where the chord is too long, they are further from it
    than their share of the tolerance, or do not follow each other along it."""
    cdef const double* start = _raw(tp, first).start
    cdef const double* end = _raw(tp, first + count - 1).end
    cdef const double* q
    cdef double chord[AXES]
    cdef double square = 0.0, allowed = INFINITY, along, off, t, d, last = 0.0, worst = 0.0
    cdef int i, k
    for i in range(AXES):
        chord[i] = end[i] - start[i]
        square += chord[i] * chord[i]
    if square > longest * longest or square == 0.0:
        return -1.0
    for k in range(count):
        allowed = fmin(allowed, (SMOOTH_SHARE if tp.smooth else SHARE) * _raw(tp, first + k).tolerance)
    allowed *= allowed
    for k in range(count - 1):
        q = _raw(tp, first + k).end
        along = 0.0
        for i in range(AXES):
            along += (q[i] - start[i]) * chord[i]
        t = along / square
        if t <= last or t >= 1.0:
            return -1.0
        last = t
        off = 0.0
        for i in range(AXES):
            d = q[i] - start[i] - t * chord[i]
            off += d * d
        if off > allowed:
            return -1.0
        worst = fmax(worst, off)
    return sqrt(worst)


cdef void _make_chord(const TpState* tp, Segment* seg, int64_t first, int count) noexcept nogil:
    """Let `seg` be the chord of `count` raws."""
    cdef const Segment* last = _raw(tp, first + count - 1)
    cdef double length = 0.0
    cdef int i, k
    cdef int base = 0 if seg.unit == 0 else 3 if seg.unit == 1 else 6
    for i in range(AXES):
        seg.end[i] = last.end[i]
    for i in range(base, base + 3):
        length += (seg.end[i] - seg.start[i]) * (seg.end[i] - seg.start[i])
    seg.length = sqrt(length)
    for i in range(AXES):
        seg.rate[i] = (seg.end[i] - seg.start[i]) / seg.length
    for k in range(1, count):
        seg.vel_max = fmin(seg.vel_max, _raw(tp, first + k).vel_max)
        seg.tolerance = fmin(seg.tolerance, _raw(tp, first + k).tolerance)
        if _raw(tp, first + k).acc > 0.0:
            seg.acc = fmin(seg.acc, _raw(tp, first + k).acc)
