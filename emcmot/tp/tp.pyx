"""The planner's C face (tp.pxd): creation, limits, the queue of segments, commands, status.

Called by motion on the servo thread and by the Python face in planner.pyx; uses geometry to shape segments, advance to
move. All memory is taken in tp_create.
"""

from libc.math cimport INFINITY, fmin, isfinite
from libc.stdint cimport int64_t
from libc.stdlib cimport calloc, free
from libc.string cimport memcpy, memset

from emcmot.tp.advance cimport advance
from emcmot.tp.geometry cimport norm, shape
from emcmot.tp.merge cimport can_join
from emcmot.tp.model cimport AXES, BACK_RING, CHAIN_WAITING, LIMITED, SPAN_BLEND, TAP_OUT, Cell, Segment, Span, TpState
from emcmot.tp.progress cimport current_id, current_raw, current_segment
from emcmot.tp.reverse cimport turn_back, turn_forward
from emcmot.tp.smooth cimport choose_smoothing
from emcmot.tp.tap cimport at_rest

from emcmot.layout import same_size

same_size(__name__, "TpSegment", sizeof(TpSegment))
same_size(__name__, "TpStatus", sizeof(TpStatus))

cdef enum:
    SPAN_RING = 8192
    SEGMENT_RING = 8192
    PAGE = 4096                  # bytes
    RAW_MARGIN = 8               # raws that a blend still needs behind the executing one
    RAW_HISTORY = 1024           # executed ones that are kept for a reverse run

cdef double SHORTEST_MOVE = 1e-9     # lu or degrees; shorter moves only hand their outputs to the next one


cdef inline TpState* _state(const Tp* tp) noexcept nogil:
    return <TpState*>tp


cdef inline Segment* _raw(const TpState* s, int64_t index) noexcept nogil:
    return &s.raws[index & s.raw_mask]


# --- life -------------------------------------------------------------------------------------------------------------

cdef void* _ring(size_t count, size_t size) noexcept nogil:
    """Zeroed memory, each page of which is touched: the servo thread shall not be the first to do so."""
    cdef volatile char* memory = <volatile char*>calloc(count, size)
    cdef size_t offset = 0
    if memory != NULL:
        while offset < count * size:
            memory[offset] = 0
            offset += PAGE
    return <void*>memory


cdef Tp* tp_create(int queue_size) noexcept nogil:
    """A planner for at least `queue_size` segments, at rest at the origin, without limits; NULL: no memory."""
    cdef TpState* s = <TpState*>calloc(1, sizeof(TpState))
    cdef int ring = 16, i
    if s == NULL:
        return NULL
    s.capacity = queue_size if queue_size > 4 else 4
    while ring < s.capacity + RAW_MARGIN + RAW_HISTORY:
        ring *= 2
    s.raw_mask = ring - 1
    s.seg_mask = SEGMENT_RING - 1
    s.span_mask = SPAN_RING - 1
    s.raws = <Segment*>_ring(ring, sizeof(Segment))
    s.ios = <TpIo*>_ring(ring, sizeof(TpIo))
    s.segs = <Segment*>_ring(SEGMENT_RING, sizeof(Segment))
    s.spans = <Span*>_ring(SPAN_RING, sizeof(Span))
    s.back_spans = <Span*>_ring(BACK_RING, sizeof(Span))
    s.cells = <Cell*>_ring(SPAN_RING, sizeof(Cell))
    s.cell_mask = SPAN_RING - 1
    if s.raws == NULL or s.ios == NULL or s.segs == NULL or s.spans == NULL or s.back_spans == NULL or s.cells == NULL:
        tp_free(<Tp*>s)
        return NULL
    s.dt = 0.001
    for i in range(LIMITED):
        s.vmax[i] = s.amax[i] = s.jmax[i] = INFINITY
    s.feed_scale = s.rapid_scale = s.adaptive_scale = s.rate_limit = 1.0
    s.sweep = s.held_span = s.looking = -1
    return <Tp*>s


cdef void tp_free(Tp* tp) noexcept nogil:
    cdef TpState* s = _state(tp)
    if s == NULL:
        return
    free(s.raws)
    free(s.ios)
    free(s.segs)
    free(s.ahead_spans if s.reversing else s.spans)
    free(s.back_spans)
    free(s.cells)
    free(s)


cdef void tp_set_cycle_time(Tp* tp, double seconds) noexcept nogil:
    _state(tp).dt = seconds


cdef int tp_set_axis_limits(Tp* tp, int axis, double vel, double acc, double jerk) noexcept nogil:
    """Limits of one axis; they hold for segments that are built from now on."""
    if axis < 0 or axis >= AXES or not vel > 0.0 or not acc > 0.0:
        return TP_BAD
    _state(tp).vmax[axis] = vel
    _state(tp).amax[axis] = acc
    _state(tp).jmax[axis] = jerk if jerk > 0.0 else INFINITY
    return TP_OK


cdef void tp_set_planner_type(Tp* tp, int type) noexcept nogil:
    """Whether jerk limits hold, from the next start at rest with an empty queue on."""
    _state(tp).limit_jerk = type == 1


cdef void tp_set_joints(
    Tp* tp, TpInverse inverse, const void* kins, int joints, const double* vel, const double* acc, const double* jerk
) noexcept nogil:
    """Limits of joints that are not axes; they hold for segments that are built from now on."""
    cdef TpState* s = _state(tp)
    cdef int k
    s.inverse = inverse
    s.kins = kins
    s.joints = min(joints, TP_JOINTS) if inverse != NULL else 0
    for k in range(s.joints):
        s.vmax[AXES + k] = vel[k] if vel[k] > 0.0 else INFINITY
        s.amax[AXES + k] = acc[k] if acc[k] > 0.0 else INFINITY
        s.jmax[AXES + k] = jerk[k] if jerk[k] > 0.0 else INFINITY


cdef inline int _idle(const TpState* s) noexcept nogil:
    return s.active >= s.span_tail and s.raw_next >= s.raw_tail and s.seg_built >= s.seg_tail


cdef int tp_set_pos(Tp* tp, const double* pos) noexcept nogil:
    """Where the machine is; TP_BAD unless the queue is empty and the machine at rest."""
    cdef TpState* s = _state(tp)
    cdef int i
    if not _idle(s):
        return TP_BAD
    for i in range(AXES):
        if not isfinite(pos[i]):
            return TP_BAD
    memcpy(s.pos, pos, sizeof(s.pos))
    memcpy(s.goal, pos, sizeof(s.goal))
    memset(s.vel, 0, sizeof(s.vel))
    s.history = s.span_tail
    return TP_OK


# --- queue ------------------------------------------------------------------------------------------------------------

cdef inline int _free(const TpState* s) noexcept nogil:
    """Room for raws: those of the segments that are still needed count."""
    cdef int64_t oldest = s.segs[s.seg_head & s.seg_mask].raw_first if s.seg_head < s.seg_tail else s.raw_next
    return s.capacity - <int>(s.raw_tail - oldest)


cdef int tp_add(Tp* tp, const TpSegment* given, const TpIo* io) noexcept nogil:
    """Queue a move from the end of the last one. A move of no length only passes its outputs on to the next."""
    cdef TpState* s = _state(tp)
    cdef Segment* seg = _raw(s, s.raw_tail)
    if _free(s) <= 0 or s.aborting:
        return TP_FULL
    if not (isfinite(given.vel) and given.vel > 0.0 and given.vel_max > 0.0) or shape(seg, given, s.goal) != TP_OK:
        return TP_BAD
    if io != NULL:
        _merge_io(s, io)
    if seg.length < SHORTEST_MOVE:
        return TP_OK
    if _idle(s):
        choose_smoothing(s)
    seg.motion_type = given.motion_type
    seg.term = given.term
    seg.enables = given.enables
    seg.spindle = given.spindle
    seg.sync_velocity = given.sync_velocity
    seg.sync_revs = given.sync_revs
    seg.retract_scale = given.retract_scale
    seg.wait_spindles = given.wait_spindles
    seg.indexer = given.indexer
    seg.id = given.id
    seg.vel = given.vel
    seg.vel_max = given.vel_max
    seg.acc = given.acc
    seg.tolerance = given.tolerance
    seg.exit_stop = 1
    seg.exit_ratio = 1.0
    if seg.kind != TP_TAP:
        memcpy(s.goal, seg.end, sizeof(s.goal))
    seg.joins = s.raw_tail > 0 and can_join(_raw(s, s.raw_tail - 1), seg)
    s.raw_tail += 1
    _raw(s, s.raw_tail).has_io = 0
    return TP_OK


cdef void _merge_io(TpState* s, const TpIo* io) noexcept nogil:
    """Outputs for the segment that is added next, on top of what moves of no length have left for it."""
    cdef Segment* seg = _raw(s, s.raw_tail)
    cdef TpIo* kept = &s.ios[s.raw_tail & s.raw_mask]
    cdef int i
    if not io.dout_mask and not io.aout_mask:
        return
    if not seg.has_io:
        kept.dout_mask = kept.dout_value = kept.aout_mask = 0
        seg.has_io = 1
    kept.dout_value = (kept.dout_value & ~io.dout_mask) | (io.dout_value & io.dout_mask)
    kept.dout_mask |= io.dout_mask
    kept.aout_mask |= io.aout_mask
    for i in range(64):
        if (io.aout_mask >> i) & 1:
            kept.aout_value[i] = io.aout_value[i]


cdef int tp_take_io(Tp* tp, TpIo* io) noexcept nogil:
    """Outputs of the next segment that has started and has some; 0: none."""
    cdef TpState* s = _state(tp)
    cdef int64_t now = current_raw(s) + (s.active < s.span_tail)
    while s.io_taken < now:
        s.io_taken += 1
        if _raw(s, s.io_taken - 1).has_io:
            _raw(s, s.io_taken - 1).has_io = 0
            memcpy(io, &s.ios[(s.io_taken - 1) & s.raw_mask], sizeof(TpIo))
            return 1
    return 0


# --- commands ---------------------------------------------------------------------------------------------------------

cdef inline void _set_cap(TpState* s, double* cap, double value) noexcept nogil:
    if cap[0] != value:
        cap[0] = value
        s.caps_changed = 1


cdef void tp_set_feed_scale(Tp* tp, double scale) noexcept nogil:
    _set_cap(_state(tp), &_state(tp).feed_scale, scale if scale > 0.0 else 0.0)


cdef void tp_set_rapid_scale(Tp* tp, double scale) noexcept nogil:
    _set_cap(_state(tp), &_state(tp).rapid_scale, scale if scale > 0.0 else 0.0)


cdef void tp_set_adaptive_scale(Tp* tp, double scale) noexcept nogil:
    _set_cap(_state(tp), &_state(tp).adaptive_scale, scale)


cdef void tp_set_vel_limit(Tp* tp, double vel) noexcept nogil:
    _set_cap(_state(tp), &_state(tp).vel_limit, vel)


cdef void tp_set_feed_hold(Tp* tp, int hold) noexcept nogil:
    _state(tp).feed_hold = hold


cdef void tp_set_feed_inhibit(Tp* tp, int inhibit) noexcept nogil:
    _state(tp).feed_inhibit = inhibit


cdef void tp_set_at_speed(Tp* tp, int spindles) noexcept nogil:
    _state(tp).at_speed = spindles


cdef void tp_unlocked(Tp* tp, int yes) noexcept nogil:
    _state(tp).unlocked = yes


cdef void tp_pause(Tp* tp) noexcept nogil:
    _state(tp).paused = 1
    _state(tp).stepping = 0


cdef void tp_resume(Tp* tp) noexcept nogil:
    _state(tp).paused = _state(tp).stepping = 0


cdef void tp_step_once(Tp* tp) noexcept nogil:
    """Resume, and pause again when a segment with another id begins."""
    cdef TpState* s = _state(tp)
    s.paused = 0
    s.stepping = 1
    s.step_id = current_id(s)


cdef void tp_abort(Tp* tp) noexcept nogil:
    """Come to rest on the path, then drop the queue and any pause."""
    _state(tp).aborting = not _idle(_state(tp))
    if not _state(tp).aborting:
        _state(tp).paused = _state(tp).stepping = 0


cdef int tp_set_reverse(Tp* tp, int reverse) noexcept nogil:
    """Turn round at rest; TP_BAD where the machine moves, or nothing is known of the way back."""
    cdef TpState* s = _state(tp)
    if (reverse != 0) == s.reversing:
        return TP_OK
    if not at_rest(s) or s.aborting:
        return TP_BAD
    if not reverse:
        turn_forward(s)
        return TP_OK
    return TP_OK if turn_back(s) else TP_BAD


cdef void tp_spindle(Tp* tp, int spindle, double revs, double speed_rps) noexcept nogil:
    if 0 <= spindle < 8:
        _state(tp).spindle_revs[spindle] = revs
        _state(tp).spindle_rps[spindle] = speed_rps


cdef void tp_index_seen(Tp* tp) noexcept nogil:
    _state(tp).index_seen = 1


cdef void tp_run_cycle(Tp* tp) noexcept nogil:
    advance(_state(tp))


# --- status -----------------------------------------------------------------------------------------------------------

cdef void tp_get_status(const Tp* tp, TpStatus* status) noexcept nogil:
    cdef TpState* s = _state(tp)
    cdef const Segment* seg
    cdef int i
    memset(status, 0, sizeof(TpStatus))
    memcpy(status.pos, s.pos, sizeof(s.pos))
    memcpy(status.vel, s.vel, sizeof(s.vel))
    status.depth = <int>(s.raw_tail - current_raw(s))
    status.free = max(0, _free(s))
    status.reversing = s.reversing
    status.paused = s.paused
    status.done = _idle(s)
    status.spindle = -1
    status.wants_reverse = status.wants_index = status.wants_unlock = -1
    if s.active >= s.span_tail:
        return
    seg = _raw(s, current_raw(s))
    for i in range(AXES):
        status.dtg[i] = (seg.start[i] if s.reversing else seg.end[i]) - s.pos[i]
    status.distance_to_go = norm(status.dtg, seg.unit)
    status.current_vel = norm(s.vel, seg.unit)
    status.requested_vel = fmin(seg.vel, seg.vel_max)
    status.id = seg.id
    status.motion_type = seg.motion_type
    status.enables = seg.enables
    status.spindle = seg.spindle
    status.active_depth = 2 if s.spans[s.active & s.span_mask].kind == SPAN_BLEND else 1
    if current_segment(s) >= s.started and seg.indexer >= 0 and s.w == 0.0:
        status.wants_unlock = seg.indexer
    if s.chain == CHAIN_WAITING and not s.index_seen:
        status.wants_index = seg.spindle
    if s.tap_phase == TAP_OUT:
        status.wants_reverse = seg.spindle
        status.retract_scale = seg.retract_scale
