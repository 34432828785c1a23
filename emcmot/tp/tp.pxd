"""C face of the trajectory planner library: what motion (and the forecast) call. Knows no bus, no clock, no HAL.

Units: machine length units (lu) for x y z u v w, degrees for a b c, seconds. Arrays of 9 are ordered x y z a b c u v w.
Every function is noexcept nogil and safe on the servo thread: nothing allocates after tp_create.
"""

from libc.stdint cimport int64_t

cdef enum:
    TP_AXES = 9

cdef enum TpKind:
    TP_LINE = 1
    TP_ARC = 2
    TP_TAP = 3               # rigid tap: to `end` and back with spindle `spindle`, `sync_revs` lu a revolution

cdef enum TpTerm:            # how a segment ends (EMCMOT_TERM_COND_*)
    TP_TERM_STOP = 1         # G61.1 exact stop
    TP_TERM_BLEND = 2        # G64, `tolerance` is P (0: G64 without P, as LinuxCNC: blend as far as the segments allow)
    TP_TERM_TANGENT = 3      # G61 exact path: no deviation, stop only where the tangent breaks

cdef enum TpResult:
    TP_OK = 0
    TP_FULL = -1             # queue has no room; nothing was added
    TP_BAD = -2              # NaN, infinity, zero radius, non-positive velocity ...; nothing was added

cdef enum:                   # bits of TpSegment.enables
    TP_FS_ENABLED = 2        # feed override acts on this move
    TP_AF_ENABLED = 4        # adaptive feed acts
    TP_FH_ENABLED = 8        # feed hold acts

from emcmot.tp.joint_map cimport TP_JOINTS, TpInverse
from emcmot.tp.outputs cimport TpIo      # synchronised outputs that change when a segment starts

ctypedef struct TpSegment:
    int kind                 # TpKind
    int motion_type          # EMC_MOTION_TYPE_*: 1 traverse, 2 feed, 3 arc, 4 tool change, 5 probing, 6 index rotary
    int term                 # TpTerm
    int enables
    int turn                 # TP_ARC: full turns as in EMC_TRAJ_CIRCULAR_MOVE (>=0 counter-clockwise, <0 clockwise)
    int spindle              # spindle of a synchronised move, -1: not synchronised
    int64_t id               # motion id, reported while it executes
    double end[TP_AXES]
    double center[3]
    double normal[3]
    double vel               # requested path velocity before override, lu/s (deg/s for a pure rotary move)
    double vel_max           # what no override may exceed on this segment
    double acc               # largest path acceleration; <= 0: only the axis limits hold
    double tolerance         # largest deviation from the programmed path
    double sync_revs         # lu per spindle revolution, 0: none
    int sync_velocity        # non-zero: only the velocity follows the spindle (G95), not its position
    double retract_scale     # TP_TAP: spindle speed on the way out over that on the way in; handed back in TpStatus
    int wait_spindles        # bit mask: come to rest before this move and wait for these spindles to be at speed
    int indexer              # come to rest before this move until the lock of this joint is open; -1: none

ctypedef struct TpStatus:
    double pos[TP_AXES]      # commanded position now
    double vel[TP_AXES]      # its derivative
    double dtg[TP_AXES]      # distance to go of the executing segment, per axis
    double distance_to_go
    double current_vel       # along the path
    double requested_vel
    int64_t id               # executing segment, 0 when idle
    int motion_type          # 0 when idle
    int enables              # of the executing segment
    int spindle
    int depth                # segments in the queue
    int active_depth         # segments that the tool is influenced by now: 0 idle, 1, 2 (in a blend)
    int free                 # segments that still fit
    int done                 # queue empty and at rest
    int paused
    int reversing
    int wants_index          # spindle whose index pulse a chain of synchronised moves waits for, -1: none
    int wants_reverse        # spindle that a tap wants to turn backwards now, -1: none
    double retract_scale     # by which it shall then turn faster
    int wants_unlock         # joint whose lock the next move waits for, -1: none

cdef extern from *:
    """
    typedef struct Tp Tp;
    """
    ctypedef struct Tp:      # opaque
        pass

cdef Tp* tp_create(int queue_size) noexcept nogil
cdef void tp_free(Tp* tp) noexcept nogil
cdef void tp_set_cycle_time(Tp* tp, double seconds) noexcept nogil
cdef int tp_set_axis_limits(Tp* tp, int axis, double vel, double acc, double jerk) noexcept nogil   # jerk <= 0: none
cdef void tp_set_planner_type(Tp* tp, int type) noexcept nogil               # 0: jerk as it comes; 1: jerk is limited. At rest
# Limits of joints that are not axes; the functions and `kins` must outlive the planner. `inverse` NULL: no joints.
cdef void tp_set_joints(
    Tp* tp, TpInverse inverse, const void* kins, int joints, const double* vel, const double* acc, const double* jerk) noexcept nogil
cdef int tp_set_pos(Tp* tp, const double* pos) noexcept nogil                # only when done
cdef int tp_add(Tp* tp, const TpSegment* segment, const TpIo* io) noexcept nogil                    # io may be NULL
cdef void tp_set_feed_scale(Tp* tp, double scale) noexcept nogil             # 0..max; acts on feed moves
cdef void tp_set_rapid_scale(Tp* tp, double scale) noexcept nogil
cdef void tp_set_adaptive_scale(Tp* tp, double scale) noexcept nogil
cdef void tp_set_feed_hold(Tp* tp, int hold) noexcept nogil
cdef void tp_set_feed_inhibit(Tp* tp, int inhibit) noexcept nogil            # feed hold whatever the segment's enables say
cdef void tp_set_at_speed(Tp* tp, int spindles) noexcept nogil               # bit mask of spindles at speed now
cdef void tp_unlocked(Tp* tp, int yes) noexcept nogil                        # the lock that wants_unlock names is open
cdef void tp_set_vel_limit(Tp* tp, double vel) noexcept nogil                # MAX_LINEAR_VELOCITY cap of the tool tip
cdef void tp_pause(Tp* tp) noexcept nogil                                    # ramp to rest on the path and hold
cdef void tp_resume(Tp* tp) noexcept nogil
cdef void tp_step_once(Tp* tp) noexcept nogil                                # resume until the id changes, then hold
cdef void tp_abort(Tp* tp) noexcept nogil                                    # ramp to rest on the path, then drop the queue
cdef int tp_set_reverse(Tp* tp, int reverse) noexcept nogil                  # only at rest (paused); TP_BAD otherwise
cdef void tp_spindle(Tp* tp, int spindle, double revs, double speed_rps) noexcept nogil  # feedback for synchronised moves
cdef void tp_index_seen(Tp* tp) noexcept nogil                               # the index has passed; revs count from 0 there
cdef int tp_take_io(Tp* tp, TpIo* io) noexcept nogil                         # 1: a segment with outputs has started, io filled
cdef void tp_run_cycle(Tp* tp) noexcept nogil                                # one servo period
cdef void tp_get_status(const Tp* tp, TpStatus* status) noexcept nogil
