"""Commands that queue something in the planner: lines, arcs, probing moves, and outputs that wait for them.

The command table has checked that motion is enabled and coordinated and that the numbers are finite. End points are
checked here against the limits of axes and joints before anything is queued.
"""

from libc.stdint cimport int8_t
from libc.stdio cimport snprintf
from libc.string cimport memset

from emcmot._messages cimport (
    EMCMOT_COMMAND,
    MAX_AXES,
    MotCommandStatus_BAD_EXEC,
    MotCommandStatus_INVALID_COMMAND,
    MotCommandStatus_INVALID_PARAMS,
    MotCommandStatus_OK,
    TermCond_STOP,
)
from emcmot.arc cimport arc_box
from emcmot.probe cimport PROBE_OFF, PROBE_QUEUED
from emcmot.report cimport TEXT_SIZE, report
from emcmot.state cimport LINES, Motion
from emcmot.tp.tp cimport TP_ARC, TP_FULL, TP_LINE, TP_OK, TP_TAP, TpSegment
from emcmot.world cimport check_box, check_end_point

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))
same_size(__name__, "TpSegment", sizeof(TpSegment))

cdef int SETTLING = 3  # periods in which an analog output, and a HAL file behind it, may switch the kinematics

cdef int TYPE_TRAVERSE = 1
cdef int TYPE_FEED = 2
cdef int TYPE_ARC = 3
cdef int TYPE_PROBING = 5
cdef int TYPE_INDEX_ROTARY = 6


cdef void begin_segment(Motion* m, const EMCMOT_COMMAND* c, TpSegment* s) noexcept nogil:
    """What every move has: end point, speeds, how it ends, overrides, spindles."""
    cdef const double* end = <const double*>&c.pos
    cdef int feeds = c.motion_type == TYPE_FEED or c.motion_type == TYPE_ARC
    cdef int n
    memset(s, 0, sizeof(TpSegment))
    s.kind = TP_LINE
    s.motion_type = c.motion_type
    s.id = c.id
    s.enables = m.enables
    for n in range(MAX_AXES):
        s.end[n] = end[n]
    s.vel = c.vel if c.vel > 0.0 else m.next_vel
    s.vel_max = c.ini_maxvel if c.ini_maxvel > 0.0 else m.next_vel_max
    s.acc = c.acc if c.acc > 0.0 else m.acc_limit
    s.term = c.termCond if c.termCond else m.term_cond
    s.tolerance = c.tolerance if c.termCond else m.term_tolerance
    s.spindle = m.sync_spindle
    s.sync_revs = m.sync_revs
    s.sync_velocity = m.sync_velocity
    s.indexer = c.turn if c.motion_type == TYPE_INDEX_ROTARY else -1
    if feeds:
        s.wait_spindles = m.wait_spindles
        for n in range(m.num_spindles):
            if m.last_move_type == TYPE_TRAVERSE and m.spindle[n].state and m.spindle[n].css_factor != 0.0:
                s.wait_spindles |= 1 << n
    if m.sync_spindle >= 0 and not m.last_move_synchronised:
        s.wait_spindles |= 1 << m.sync_spindle


cdef const double* queue_end(Motion* m) noexcept nogil:
    """Where the next move starts."""
    return &m.tp_status.pos[0] if m.tp_status.done else &m.queue_end[0]


cdef int queue(Motion* m, const TpSegment* s, const char* what, const EMCMOT_COMMAND* c) noexcept nogil:
    """Hand the segment, and the outputs that wait for a move, to the planner."""
    cdef int n
    cdef int result = m.planner.add(m.tp, s, &m.pending_io if m.pending_io_set else NULL)
    if result == TP_FULL:
        snprintf(
            report(m, -1, s.id), TEXT_SIZE, b"Can't add %s move on line %ld: the motion queue is full", what, <long>s.id
        )
        return MotCommandStatus_BAD_EXEC
    if result != TP_OK:
        snprintf(
            report(m, -1, s.id), TEXT_SIZE, b"Can't add %s move on line %ld: bad geometry or speed", what, <long>s.id
        )
        return MotCommandStatus_INVALID_PARAMS
    m.tp_status.done = 0
    m.line_of_id[s.id & (LINES - 1)] = c.line
    m.units_of_id[s.id & (LINES - 1)] = <int8_t>min(max(c.mode, 0), 3)
    if s.kind != TP_TAP:
        for n in range(MAX_AXES):
            m.queue_end[n] = s.end[n]
    m.pending_io_set = 0
    m.pending_io.dout_mask = 0
    m.pending_io.aout_mask = 0
    m.wait_spindles &= ~s.wait_spindles
    m.last_move_type = s.motion_type
    m.last_move_synchronised = s.spindle >= 0
    return MotCommandStatus_OK


cdef int set_line(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    cdef TpSegment s
    begin_segment(m, c, &s)
    if check_end_point(m, b"Linear", c.id, s.end) != 0:
        return MotCommandStatus_INVALID_PARAMS
    return queue(m, &s, b"linear", c)


cdef int set_circle(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    cdef TpSegment s
    cdef double box_low[3]
    cdef double box_high[3]
    begin_segment(m, c, &s)
    s.kind = TP_ARC
    s.turn = c.turn
    s.indexer = -1
    s.center[0], s.center[1], s.center[2] = c.center.x, c.center.y, c.center.z
    s.normal[0], s.normal[1], s.normal[2] = c.normal.x, c.normal.y, c.normal.z
    arc_box(queue_end(m), &s, box_low, box_high)
    if check_end_point(m, b"Circular", c.id, s.end) != 0 or check_box(m, b"Circular", c.id, box_low, box_high) != 0:
        return MotCommandStatus_INVALID_PARAMS
    return queue(m, &s, b"circular", c)


cdef int probe(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """Queue a probing move; ``probe_cycle`` watches it."""
    cdef TpSegment s
    cdef int result
    begin_segment(m, c, &s)
    s.motion_type = TYPE_PROBING
    s.term = TermCond_STOP
    s.wait_spindles = 0
    if check_end_point(m, b"Probe", c.id, s.end) != 0:
        return MotCommandStatus_INVALID_PARAMS
    result = queue(m, &s, b"probe", c)
    if result == MotCommandStatus_OK:
        m.probing = PROBE_QUEUED
        m.probe_type = c.probe_type
        m.probe_tripped = 0
    return result


cdef int rigid_tap(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """Queue a tap: in to the end point and out again, with the spindle."""
    cdef TpSegment s
    if m.sync_spindle < 0:
        snprintf(
            report(m, -1, c.id), TEXT_SIZE, b"Rigid tap on line %ld: the feed is not synchronised with a spindle", c.id
        )
        return MotCommandStatus_INVALID_COMMAND
    begin_segment(m, c, &s)
    s.kind = TP_TAP
    s.motion_type = TYPE_FEED
    s.retract_scale = c.scale if c.scale > 0.0 else 1.0
    if check_end_point(m, b"Rigid tap", c.id, s.end) != 0:
        return MotCommandStatus_INVALID_PARAMS
    return queue(m, &s, b"rigid tap", c)


cdef int clear_probe_flags(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    m.probing = PROBE_OFF
    m.probe_tripped = 0
    return MotCommandStatus_OK


cdef int set_spindle_sync(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """Moves to come follow this spindle; spindlesync 0 ends that."""
    m.sync_spindle = c.spindle if c.spindlesync != 0.0 else -1
    m.sync_revs = c.spindlesync
    m.sync_velocity = c.flags
    return MotCommandStatus_OK


cdef int set_dout(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """M64, M65 at once; M62, M63 with the next move."""
    if c.now:
        m.digital_out[c.out] = c.start != 0
    else:
        m.pending_io_set = 1
        m.pending_io.dout_mask |= 1LL << c.out
        if c.start:
            m.pending_io.dout_value |= 1LL << c.out
        else:
            m.pending_io.dout_value &= ~(1LL << c.out)
    return MotCommandStatus_OK


cdef int set_aout(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil:
    """M68 at once; M67 with the next move."""
    if c.now:
        m.analog_out[c.out] = c.minLimit
        if m.kins.ways > 1:
            m.settling = max(m.settling, SETTLING)
    else:
        m.pending_io_set = 1
        m.pending_io.aout_mask |= 1LL << c.out
        m.pending_io.aout_value[c.out] = c.minLimit
    return MotCommandStatus_OK
