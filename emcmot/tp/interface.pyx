"""The table of this package's own planner."""

from emcmot.tp.tp cimport *

cdef TpInterface BUILTIN

BUILTIN.create = tp_create
BUILTIN.free = tp_free
BUILTIN.set_cycle_time = tp_set_cycle_time
BUILTIN.set_axis_limits = tp_set_axis_limits
BUILTIN.set_planner_type = tp_set_planner_type
BUILTIN.set_joints = tp_set_joints
BUILTIN.set_pos = tp_set_pos
BUILTIN.add = tp_add
BUILTIN.set_feed_scale = tp_set_feed_scale
BUILTIN.set_rapid_scale = tp_set_rapid_scale
BUILTIN.set_adaptive_scale = tp_set_adaptive_scale
BUILTIN.set_feed_hold = tp_set_feed_hold
BUILTIN.set_feed_inhibit = tp_set_feed_inhibit
BUILTIN.set_at_speed = tp_set_at_speed
BUILTIN.unlocked = tp_unlocked
BUILTIN.set_vel_limit = tp_set_vel_limit
BUILTIN.pause = tp_pause
BUILTIN.resume = tp_resume
BUILTIN.step_once = tp_step_once
BUILTIN.abort = tp_abort
BUILTIN.set_reverse = tp_set_reverse
BUILTIN.spindle = tp_spindle
BUILTIN.index_seen = tp_index_seen
BUILTIN.take_io = tp_take_io
BUILTIN.run_cycle = tp_run_cycle
BUILTIN.get_status = tp_get_status


cdef const TpInterface* tp_interface() noexcept nogil:
    return &BUILTIN
