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
    KINKS = 512                  # of the part of the path that is being laid smoothly
    KNOTS = 5                    # of an arc that are known at a time
    BACK_RING = 512              # spans that a reverse run can go back

cdef enum FeedUnit:          # which axes the length of a segment is measured along
    UNIT_XYZ = 0
    UNIT_ABC = 1
    UNIT_UVW = 2

cdef enum SpanKind:
    SPAN_LINE = 1            # part of a straight move: constant limits, w free within them
    SPAN_CURVE = 2           # part of a move whose derivatives change: short enough for their linear interpolation
    SPAN_BLEND = 3           # part of the corner between segment `seg - 1` and segment `seg`
    SPAN_CUBIC = 4           # jerk-limited motion: part of a path that is cubic in u; it may run on into later segments

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

cdef enum ChainEnd:          # how the last segment of a chain ends
    END_OPEN = 0             # not known yet
    END_CORNER = 1           # another one follows
    END_STOP = 2

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
    int cut                  # it ends because no more raws were known, and could not wait
    double deviation         # how far the raws may be from it; their tolerance less this is left for blends
    double begin             # jerk-limited motion: way along the chain at its start,
    double pace              # and du per unit of that way
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
    double cap               # hard limit of w here: velocities of axes and joints; without a jerk limit vel_max too
    double speed             # largest |dq/du| in feed units: the feed cap is w <= (feed / speed)^2
    double speed_before      # blends: the same for the feed of the earlier segment
    double acc               # lines: limit of |d2u/dt2|; else the limit that the segment asks for, or infinity
    double tight             # share of the axis accelerations that interpolation leaves
    double beta              # largest w at the start from which every later limit can be kept
    double reserve           # jerk-limited motion: share of accelerations and jerks that is planned with,
    double steady            # largest du/dt,
    double push              # largest |d2u/dt2|
    double jerk              # and largest |d3u/dt3|
    double dq0[LIMITED]      # derivatives by u at both ends, for the n axes of `axis`; of lines only where they are asked for
    double dq1[LIMITED]
    double ddq0[LIMITED]
    double ddq1[LIMITED]
    double q0[AXES]          # cubic ones: position at both ends
    double q1[AXES]

ctypedef struct Kink:        # where the direction of the path changes, and the hat over which it does so smoothly
    double place             # way along the chain; (from + middle + to) / 3
    double start             # of the hat,
    double middle            # where it is highest,
    double to                # and its end
    double sharpness         # norm of `turn`; 0: no corner of the program, or one of a run
    double tolerance         # of the corner,
    double off[AXES]         # and what hats, its own and others, have taken of it
    double turn[AXES]        # change of the direction
    double vertex[AXES]      # the line behind it: a point, at `place`,
    double out[AXES]         # and the direction

ctypedef struct Cell:        # of the speed plan, one for each span
    double w                 # coefficient of the plan in force,
    double fresh             # and of the one that is being made
    double cap               # largest w there, feed included
    double weight            # s; time that it takes, nearly
    double gradient          # its equations
    double diagonal
    double beside[2]         # the upper half of the matrix: next column and next but one
    double change            # and their solution

ctypedef struct Improvement: # of the plan: where its computation is
    int phase                # InteriorPhase
    int64_t origin           # span with which it begins
    int64_t first            # coefficients from this one on may change
    int64_t end              # spans before this one are planned
    int64_t cursor
    int attempt              # shares of one step that were tried
    int steps                # done with the barrier as it is
    int total                # and in all
    int checks               # of the result
    int failed               # the last one led to nothing
    double barrier           # weight of what keeps away from limits
    double weight            # of all spans
    double even              # of a span, on average
    double near              # what is left of a limit from where on its barrier is a parabola
    int within               # no limit is broken so far
    double worst             # largest share of a limit in the plan
    double merit             # of the plan,
    double trial             # and of the one that is tried,
    double trial_worst       # with its largest share of a limit
    double share             # of the change that is tried
    double gain              # first-order gain of a whole change

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
    double body_end          # u of segment `seg_built - 1` up to which its spans reach (limited jerk: way along the chain)
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
    Cell* cells              # as many as spans; jerk is limited
    int cell_mask
    int64_t plan_from        # spans from this one,
    int64_t planned          # to before this one, have a speed plan
    double plan_time         # that it takes from here on, nearly
    int replan               # it can be improved
    Improvement improvement
    double rate              # of the plan's time to real time,
    double rate_change       # 1/s
    double rate_limit        # and what overrides leave of it
    int hungry               # the path known ahead is too short for the speed that the limits allow
    Kink kinks[KINKS]        # of the chain that is being laid: moves from one stop to the next
    int64_t kink_head
    int64_t kink_tail
    Kink corner              # the one at the end of the last segment of the chain, where that is decided
    int end                  # ChainEnd
    double hold              # way before the end of the last segment that is not laid while its end is open
    int64_t laying           # segment that the next span is of
    double slow_place        # newest place that is passed slowly, or at rest,
    double slow_speed        # and how fast
    double node[3][AXES]     # position and derivatives at the end of the last span
    double arc_ended         # way along the chain where its last arc ended
    int arc_open             # kinks are missing of the last segment, an arc
    double knots[KNOTS]      # of that arc; the next kink has the middle three
    double arc_start         # spacing of its knots about its ends; 0: the chain begins or ends there
    double arc_end
    double arc_step          # and at most between
    int fitting              # kinks are missing of a run of short moves, the knots are its (see fit),
    int fit_closed           # the last segment of the chain is its last,
    int64_t fit_first        # this its first segment,
    int64_t fit_near         # this the one at the first of the knots,
    double fit_from          # and this where it is compared with its moves from

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
