"""What `plasmac` counts of a job: times, lengths and feed rates."""

from hal.cell cimport hal_at as at

from hal.components.plasmac cimport CUT_MODE_01, CUT_MODE_2, PAUSED_MOTION, Plasmac

cdef enum:
    TRAVERSE = 1  # of the pin motion-type


cdef void tell_feeds(Plasmac* s) noexcept nogil:
    at(s.current_feed_rate).f = at(s.current_velocity).f * 60.0
    if s.state != PAUSED_MOTION and s.state != CUT_MODE_01 and s.state != CUT_MODE_2:
        at(s.adaptive_feed).f = 1.0
    at(s.z_height).f = at(s.axis_z_position).f - (s.zero if s.zero_known else at(s.axis_z_min_limit).f)

cdef void count_times(Plasmac* s) noexcept nogil:
    cdef bint running = at(s.program_is_running).b or at(s.program_is_paused).b
    if running and not s.was_running:
        at(s.run_time).f = at(s.cut_time).f = at(s.cut_length).f = at(s.torch_time).f = at(s.rapid_time).f = 0.0
        at(s.paused_time).f = at(s.probe_time).f = 0.0
        at(s.pierce_count).s = 0
    elif running:
        at(s.run_time).f += s.dt
    s.was_running = running
    if at(s.program_is_paused).b:
        at(s.paused_time).f += s.dt
    if at(s.torch_on).b:
        at(s.torch_time).f += s.dt
    if at(s.motion_type).s == TRAVERSE:
        at(s.rapid_time).f += s.dt
