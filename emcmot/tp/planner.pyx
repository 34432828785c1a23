"""Python face of the trajectory planner: what tests, benchmarks and the forecast feed and step."""

import numpy as np
from emcmot.layout import same_size

from libc.string cimport memset
from posix.time cimport CLOCK_THREAD_CPUTIME_ID, clock_gettime, timespec

from emcmot.tp.tp cimport *

same_size(__name__, "TpSegment", sizeof(TpSegment))
same_size(__name__, "TpStatus", sizeof(TpStatus))

cdef int AXIS_COUNT = TP_AXES

TERM_STOP = TP_TERM_STOP
TERM_BLEND = TP_TERM_BLEND
TERM_TANGENT = TP_TERM_TANGENT
TRAVERSE = 1
FEED = 2
ARC = 3


class PlannerError(ValueError):
    """A move that the planner cannot take."""


cdef class Planner:
    """One trajectory planner: add moves, step servo periods, read positions in nine axes (x y z a b c u v w)."""

    cdef Tp* tp
    cdef readonly double period

    def __cinit__(self, double period=0.001, int queue=4000):
        self.tp = tp_create(queue)
        if self.tp == NULL:
            raise MemoryError
        self.period = period
        tp_set_cycle_time(self.tp, period)

    def __dealloc__(self):
        tp_free(self.tp)

    def set_limits(self, axis: int, vel: float, acc: float, jerk: float = 0.0) -> None:
        """Limits of axis 0..8: lu/s or deg/s, their squares and cubes of a second."""
        if tp_set_axis_limits(self.tp, axis, vel, acc, jerk) != TP_OK:
            raise PlannerError(f"axis {axis}: velocity {vel} and acceleration {acc} must be positive")

    def limit_jerk(self, bint on) -> None:
        """Keep the jerk limits, from the next start at rest on."""
        tp_set_planner_type(self.tp, 1 if on else 0)

    def set_pos(self, pos) -> None:
        cdef double[9] p
        _nine(pos, p)
        if tp_set_pos(self.tp, p) != TP_OK:
            raise PlannerError("the position can be set only at rest with an empty queue")

    def add_line(self, end, double vel, *, vel_max=None, double acc=0.0, int term=TP_TERM_BLEND, double tolerance=0.0,
                 int id=1, int motion_type=FEED, int enables=TP_FS_ENABLED | TP_FH_ENABLED,
                 int spindle=-1, double sync_revs=0.0, bint sync_velocity=False, int wait_spindles=0) -> bool:
        """Queue a straight move; False when the queue is full. `sync_revs`: lu per revolution of `spindle`."""
        cdef TpSegment seg
        memset(&seg, 0, sizeof(seg))
        seg.kind = TP_LINE
        _nine(end, seg.end)
        seg.spindle = spindle
        seg.sync_revs = sync_revs
        seg.sync_velocity = sync_velocity
        seg.wait_spindles = wait_spindles
        return self._add(&seg, vel, vel_max, acc, term, tolerance, id, motion_type, enables)

    def add_tap(self, end, double vel, double sync_revs, *, int spindle=0, double retract_scale=1.0, int id=1) -> bool:
        """Queue a rigid tap to `end` and back, `sync_revs` lu per revolution; False when the queue is full."""
        cdef TpSegment seg
        memset(&seg, 0, sizeof(seg))
        seg.kind = TP_TAP
        _nine(end, seg.end)
        seg.spindle = spindle
        seg.sync_revs = sync_revs
        seg.retract_scale = retract_scale
        return self._add(&seg, vel, None, 0.0, TP_TERM_STOP, 0.0, id, FEED, 0)

    def add_arc(self, end, center, normal, int turn, double vel, *, vel_max=None, double acc=0.0,
                int term=TP_TERM_BLEND, double tolerance=0.0, int id=1, int motion_type=ARC,
                int enables=TP_FS_ENABLED | TP_FH_ENABLED) -> bool:
        """Queue an arc about `normal` (turn >= 0: counter-clockwise with that many more turns; -1 - n: clockwise)."""
        cdef TpSegment seg
        memset(&seg, 0, sizeof(seg))
        seg.kind = TP_ARC
        seg.turn = turn
        seg.spindle = -1
        _nine(end, seg.end)
        seg.center[0], seg.center[1], seg.center[2] = center
        seg.normal[0], seg.normal[1], seg.normal[2] = normal
        return self._add(&seg, vel, vel_max, acc, term, tolerance, id, motion_type, enables)

    cdef bint _add(self, TpSegment* seg, double vel, vel_max, double acc, int term, double tolerance, int id,
                   int motion_type, int enables) except -1:
        cdef int result
        seg.vel = vel
        seg.vel_max = vel if vel_max is None else vel_max
        seg.acc = acc
        seg.term = term
        seg.tolerance = tolerance
        seg.id = id
        seg.motion_type = motion_type
        seg.enables = enables
        seg.indexer = -1
        result = tp_add(self.tp, seg, NULL)
        if result == TP_BAD:
            raise PlannerError(f"move {id} has no usable geometry or speed")
        return result == TP_OK

    def feed_scale(self, double scale) -> None:
        tp_set_feed_scale(self.tp, scale)

    def rapid_scale(self, double scale) -> None:
        tp_set_rapid_scale(self.tp, scale)

    def adaptive_scale(self, double scale) -> None:
        tp_set_adaptive_scale(self.tp, scale)

    def vel_limit(self, double vel) -> None:
        tp_set_vel_limit(self.tp, vel)

    def feed_hold(self, bint hold) -> None:
        tp_set_feed_hold(self.tp, hold)

    def feed_inhibit(self, bint inhibit) -> None:
        tp_set_feed_inhibit(self.tp, inhibit)

    def spindle(self, int spindle, double revs, double rps) -> None:
        """Feedback of a spindle: revolutions since its index, and revolutions per second."""
        tp_spindle(self.tp, spindle, revs, rps)

    def at_speed(self, int spindles) -> None:
        tp_set_at_speed(self.tp, spindles)

    def index_seen(self) -> None:
        tp_index_seen(self.tp)

    def pause(self) -> None:
        tp_pause(self.tp)

    def resume(self) -> None:
        tp_resume(self.tp)

    def step_once(self) -> None:
        tp_step_once(self.tp)

    def reverse(self, bint back) -> bool:
        """Run back along the executed path, or forwards again; False where the machine moves or there is no way back."""
        return tp_set_reverse(self.tp, back) == TP_OK

    def abort(self) -> None:
        tp_abort(self.tp)

    def status(self) -> dict:
        """Every field of TpStatus by name."""
        cdef TpStatus status
        tp_get_status(self.tp, &status)
        return status

    def step(self, int periods=1):
        """Run servo periods; the position at the end of each, shape (periods, 9)."""
        positions = np.empty((periods, AXIS_COUNT))
        cdef double[:, ::1] out = positions
        cdef TpStatus status
        cdef int k, i
        with nogil:
            for k in range(periods):
                tp_run_cycle(self.tp)
                tp_get_status(self.tp, &status)
                for i in range(TP_AXES):
                    out[k, i] = status.pos[i]
        return positions

    def time_periods(self, int periods):
        """Run servo periods, and tell what processor time each has cost: nanoseconds, shape (periods,)."""
        costs = np.empty(periods)
        cdef double[::1] out = costs
        cdef timespec before, after
        cdef int k
        with nogil:
            for k in range(periods):
                clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before)
                tp_run_cycle(self.tp)
                clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after)
                out[k] = 1e9 * (after.tv_sec - before.tv_sec) + (after.tv_nsec - before.tv_nsec)
        return costs

    def run_to_end(self, double limit=3600.0):
        """Run until the queue is empty and the machine at rest, or for `limit` seconds; the positions."""
        parts = []
        cdef int periods = 0
        while periods * self.period < limit:
            part = self.step_until_done(1024)
            parts.append(part)
            periods += 1024
            if len(part) < 1024:
                break
        return np.concatenate(parts)

    def step_until_done(self, int periods):
        """Like step, but ends with the period in which the planner is done."""
        positions = np.empty((periods, AXIS_COUNT))
        cdef double[:, ::1] out = positions
        cdef TpStatus status
        cdef int k, i, ran = 0
        with nogil:
            for k in range(periods):
                tp_get_status(self.tp, &status)
                if status.done:
                    break
                tp_run_cycle(self.tp)
                tp_get_status(self.tp, &status)
                for i in range(TP_AXES):
                    out[k, i] = status.pos[i]
                ran += 1
        return positions[:ran]


cdef int _nine(given, double* out) except -1:
    """Copy up to nine coordinates; the rest are zero."""
    cdef int i
    for i in range(AXIS_COUNT):
        out[i] = given[i] if i < len(given) else 0.0
    return 0
