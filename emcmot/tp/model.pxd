"""The planner's own data: segments as programmed, spans as planned, and the state of one planner.

A *raw* segment is one programmed move. A *segment* is one move as planned: a raw one, or the chord that stands for a run
of short ones within their tolerance. Its parameter u runs from 0 to `length`, one unit of u being one unit of feed
distance (xyz length, else uvw length, else degrees), so du/dt is the feed.  The *planned path* is a chain of spans: a
span is a stretch of a straight move, of an arc, or of the blend that replaces the corner between two segments.  Speed
is planned in w = (du/dt)^2; inside a span w is piecewise linear in u, that is, d2u/dt2 is piecewise constant.

Raws, segments and spans live in rings; an index counts up for ever and `index & mask` is its place.
Shared by geometry, limits, build, advance and tp; nothing outside this folder sees it.
"""

from libc.stdint cimport int64_t

from emcmot.tp.joint_map cimport TP_JOINTS, TpInverse
from emcmot.tp.outputs cimport TpIo

cdef enum:
    AXES = 9
    LIMITED = AXES + TP_JOINTS   # what has limits: the axes, and the joints where they are not the axes
    STRETCHES = 64               # of the path ahead, in jerk-limited motion
    WINDOW = 64                  # periods that smoothing averages over at most
    BACK_RING = 512              # spans that a reverse run can go back

cdef enum FeedUnit:          # which axes the length of a segment is measured along
    UNIT_XYZ = 0
    UNIT_ABC = 1
    UNIT_UVW = 2

cdef enum SpanKind:
    SPAN_LINE = 1            # part of a straight move: constant limits, w free within them
    SPAN_CURVE = 2           # part of a move whose derivatives change: short enough for their linear interpolation
    SPAN_BLEND = 3           # part of the corner between segment `seg - 1` and segment `seg`

cdef enum Chain:             # position-synchronised moves one after the other
    CHAIN_NONE = 0
    CHAIN_WAITING = 1        # at rest, for the index pulse
    CHAIN_ACCELERATING = 2   # to the speed that the spindle asks for
    CHAIN_FOLLOWING = 3

cdef enum TapPhase:
    TAP_NONE = 0
    TAP_IN = 1
    TAP_OUT = 2              # from the bottom on: the spindle slows down, turns back, and leads out
    TAP_LEAVE = 3            # from the start on: the spindle slows down again
    TAP_PLACE = 4            # to the start

ctypedef struct Segment:
    int kind                 # TpKind
    int motion_type
    int term
    int enables
    int unit                 # FeedUnit
    int spindle
    int sync_velocity
    int wait_spindles        # bit mask; the segment starts when these spindles are at speed
    int indexer              # joint whose lock must be open for this move, or -1
    int has_io
    int64_t id
    double length            # of the parameter u
    double start[AXES]
    double end[AXES]
    double rate[AXES]        # dq/du of the part that is linear in u (arcs: helix and the axes off the plane)
    double center[3]
    double e1[3]             # unit vectors of the arc's plane; e1 points from the center to the start
    double e2[3]
    double radius            # at the start
    double growth            # d(radius)/du, spirals
    double omega             # d(angle)/du
    int joins                # raws: may share a chord with the raw before
    int64_t raw_first        # raws that it stands for
    int raw_count
    double deviation         # how far the raws may be from it; their tolerance less this is left for blends
    double trim_start        # u taken by the blend before, and by the blend after
    double trim_end
    int exit_stop            # its end can only be passed at rest
    double exit_ratio        # du of the next segment per du of this one, where they meet
    double vel
    double vel_max
    double acc
    double tolerance
    double sync_revs
    double retract_scale

ctypedef struct Span:
    int kind                 # SpanKind
    int stop                 # non-zero: the end must be reached at rest
    int n                    # axes and joints that move here
    int axis[LIMITED]        # which: joint k counts as axis 9 + k
    int64_t seg              # segment that it is part of; a blend belongs to the later one
    double u0                # parameter at the start, of the segment or of the blend
    double h                 # length in u
    double trim              # blends: u of the earlier segment that the blend takes; the blend's u runs to 2 trim
    double ratio             # du of the next span per du of this one, where they join
    double cap               # hard limit of w here: velocities of axes and joints, vel_max
    double speed             # largest |dq/du| in feed units: the feed cap is w <= (feed / speed)^2
    double speed_before      # blends: the same for the feed of the earlier segment
    double acc               # lines: limit of |d2u/dt2|; else the limit that the segment asks for, or infinity
    double tight             # share of the axis accelerations that interpolation leaves
    double beta              # largest w at the start from which every later limit can be kept
    double steady            # jerk-limited motion: largest du/dt,
    double push              # largest |d2u/dt2|
    double jerk              # and largest |d3u/dt3|
    double along             # share of an axis's jerk that changes of the speed may use
    double dq0[LIMITED]      # derivatives by u at both ends, for the n axes of `axis`; of lines only where they are asked for
    double dq1[LIMITED]
    double ddq0[LIMITED]
    double ddq1[LIMITED]

ctypedef struct Stretch:     # spans that jerk-limited motion takes as one, with the tightest limits of any of them
    int64_t last             # span that it ends with
    int64_t seg              # segment that its feed is that of
    double length
    double speed
    double steady
    double push
    double jerk
    double now               # speed under the overrides of this period

ctypedef struct TpState:
    double dt                # servo period, s
    double vmax[LIMITED]
    double amax[LIMITED]
    double jmax[LIMITED]     # infinite: none
    TpInverse inverse        # NULL: joints are axes
    const void* kins
    int joints
    double pos[AXES]         # commanded now
    double vel[AXES]
    double goal[AXES]        # end of the last segment added

    Segment* raws
    TpIo* ios                # of the raws
    int raw_mask
    int capacity             # raws that tp_add accepts
    int64_t raw_next         # next raw to become part of a segment
    int64_t raw_tail         # one past the newest
    int64_t io_taken         # outputs of the raws before this one have been handed out

    Segment* segs
    int seg_mask
    int64_t seg_head         # oldest segment still needed
    int64_t seg_tail         # one past the newest
    int64_t seg_built        # one past the last segment that spans exist of

    Span* spans
    int span_mask
    int64_t active           # span being executed
    int64_t span_tail
    double body_end          # u of segment `seg_built - 1` up to which its spans reach
    double body_goal         # u up to which they shall reach
    int corner_known         # the corner at the end of that segment is decided
    int64_t settled          # spans before this one have their final beta
    int64_t new_spans        # first span added or changed since the last backward pass
    int64_t looking          # cursor of a look-ahead that goes on from period to period; -1: none
    int64_t looking_new      # spans from this one on are new in it
    int64_t looking_settled  # newest span that is settled, as far as it has come; -1: none
    int look_left            # spans that may still be looked at in this period
    int64_t sweep            # cursor of the recomputation after a change of feed caps
    int caps_changed

    int64_t history          # spans before this one are no executed path
    int reversing            # `spans` is `back_spans`: the executed path, mirrored, newest first
    Span* back_spans
    Span* ahead_spans        # the planned path, put aside while reversing
    int ahead_mask
    int64_t ahead_active
    int64_t ahead_tail
    int64_t ahead_settled
    int64_t ahead_new
    int64_t turned_at        # span of the planned path that the first mirrored one is the image of

    double u                 # parameter within the active span, 0..h
    double w                 # (du/dt)^2

    int limit_jerk           # asked for; takes effect at rest
    int smooth               # in force
    double a                 # d2u/dt2, where jerk is limited
    int hungry               # the path known ahead is too short for the speed that the limits allow
    int draining             # at rest at the end of a move, until the smoothed position is there as well
    int window               # periods that the commanded position is the average of
    int slot                 # of the newest position in `recent`
    int lag                  # periods until the commanded position has caught up with the planned one
    double planned[AXES]     # position on the path
    double recent[WINDOW][AXES]
    Stretch stretches[STRETCHES]
    int stretch_head
    int stretch_count
    int64_t stretched        # spans before this one are part of a stretch

    double held              # d2u/dt2 chosen last, on span `held_span`, to be held to its end
    int64_t held_span

    double feed_scale
    double rapid_scale
    double adaptive_scale
    double vel_limit
    int feed_hold
    int feed_inhibit
    int at_speed             # bit mask of spindles
    int unlocked             # the indexer that is waited for
    int64_t started          # segments before this one have passed their start conditions
    int paused
    int stepping
    int aborting
    int64_t step_id

    double spindle_revs[8]
    double spindle_rps[8]
    int tap_phase            # TapPhase
    double tap_direction     # sign of the spindle's revolutions on the way in
    double tap_s             # way from the start of the tap, also beyond its ends
    double tap_v
    int chain                # Chain: where a chain of position-synchronised moves is
    int index_seen
    double chain_revs        # spindle revolutions that the way travelled in the chain stands for
    int lead_known           # lead_rps is of this period
    double lead_rps          # revolutions per second that a chain should make
    double chain_origin      # spindle revolutions at which it would have begun without acceleration
