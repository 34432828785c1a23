"""The face of a planner module to motion: the functions of ``emcmot.tp.tp``, which says what each must do, as a table.

A replacement fills a ``TpInterface`` with functions of its own; ``Tp`` is whatever its ``create`` makes. It may begin
with a copy of ours and replace single functions. All of them but ``create`` and ``free`` run in the servo thread.
"""

from emcmot.tp.tp cimport Tp, TpInverse, TpIo, TpSegment, TpStatus

ctypedef struct TpInterface:
    Tp* (*create)(int queue_size) noexcept nogil
    void (*free)(Tp* tp) noexcept nogil
    void (*set_cycle_time)(Tp* tp, double seconds) noexcept nogil
    int (*set_axis_limits)(Tp* tp, int axis, double vel, double acc, double jerk) noexcept nogil
    void (*set_planner_type)(Tp* tp, int type) noexcept nogil
    void (*set_joints)(
        Tp* tp, TpInverse inverse, const void* kins, int joints, const double* vel, const double* acc, const double* jerk
    ) noexcept nogil
    int (*set_pos)(Tp* tp, const double* pos) noexcept nogil
    int (*add)(Tp* tp, const TpSegment* segment, const TpIo* io) noexcept nogil
    void (*set_feed_scale)(Tp* tp, double scale) noexcept nogil
    void (*set_rapid_scale)(Tp* tp, double scale) noexcept nogil
    void (*set_adaptive_scale)(Tp* tp, double scale) noexcept nogil
    void (*set_feed_hold)(Tp* tp, int hold) noexcept nogil
    void (*set_feed_inhibit)(Tp* tp, int inhibit) noexcept nogil
    void (*set_at_speed)(Tp* tp, int spindles) noexcept nogil
    void (*unlocked)(Tp* tp, int yes) noexcept nogil
    void (*set_vel_limit)(Tp* tp, double vel) noexcept nogil
    void (*pause)(Tp* tp) noexcept nogil
    void (*resume)(Tp* tp) noexcept nogil
    void (*step_once)(Tp* tp) noexcept nogil
    void (*abort)(Tp* tp) noexcept nogil
    int (*set_reverse)(Tp* tp, int reverse) noexcept nogil
    void (*spindle)(Tp* tp, int spindle, double revs, double speed_rps) noexcept nogil
    void (*index_seen)(Tp* tp) noexcept nogil
    int (*take_io)(Tp* tp, TpIo* io) noexcept nogil
    void (*run_cycle)(Tp* tp) noexcept nogil
    void (*get_status)(const Tp* tp, TpStatus* status) noexcept nogil

cdef const TpInterface* tp_interface() noexcept nogil        # the planner of this package
