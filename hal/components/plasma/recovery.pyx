"""What `plasmac` does in a paused program: motion on its path, new consumables, a new place to go on with the cut."""

from libc.stdint cimport int32_t

from hal.cell cimport hal_at as at

from hal.components.plasma.moves cimport aim_xy, nearer, xy_reached, xy_step
from hal.components.plasma.thc cimport begin_cut
from hal.components.plasmac cimport (
    CONSUMABLE_CHANGE_OFF, CUT_HELD, CUT_MODE_01, CUT_MODE_2, CUT_RECOVERY_OFF, CUT_RECOVERY_ON, IDLE, MAX_HEIGHT,
    NO_STOP, PAUSED_MOTION, Plasmac,
)

cdef enum:  # of the pin laser-recovery-state
    LASER_OFF
    LASER_WANTED
    LASER_MOVING
    LASER_THERE
    LASER_LEAVES
    LASER_LEAVING


cdef bint busy_while_paused(Plasmac* s) noexcept nogil:
    """Whether one of these begins, or ends as the program goes on."""
    cdef bint paused = at(s.program_is_paused).b
    if at(s.consumable_changing).b:
        if not paused or not at(s.consumable_change).b:
            s.state = CONSUMABLE_CHANGE_OFF
            return True
        return False
    if not paused or s.stop == NO_STOP:
        return False
    if at(s.paused_motion_speed).f != 0.0:
        s.state = PAUSED_MOTION
    elif at(s.consumable_change).b:
        s.state = MAX_HEIGHT
    elif at(s.cut_recovery).b and s.stop == CUT_HELD:
        s.state = CUT_RECOVERY_ON
    else:
        return False
    return True

# ---- motion on the program's path, by the adaptive feed ----

cdef void paused_motion(Plasmac* s) noexcept nogil:
    """The program runs as fast as is wanted, also backwards, and is paused again when that is not at all."""
    cdef double speed = at(s.paused_motion_speed).f
    if speed != 0.0:
        at(s.adaptive_feed).f = speed
        at(s.feed_hold).b = 0
        at(s.paused_motion).b = 1
        at(s.program_resume).b = 1
    elif at(s.program_is_running).b:
        at(s.adaptive_feed).f = 1.0
        at(s.feed_hold).b = 1
        at(s.program_resume).b = 0
        at(s.program_pause).b = 1
    elif at(s.program_pause).b or not at(s.program_resume).b:
        at(s.program_pause).b = 0
        at(s.paused_motion).b = 0
        s.state = CUT_RECOVERY_ON

# ---- changing consumables ----

cdef void go_to_change(Plasmac* s) noexcept nogil:
    if not at(s.consumable_changing).b:
        at(s.consumable_changing).b = 1
        at(s.xy_offset_enable).b = 1
        at(s.feed_hold).b = 1
        aim_xy(s, at(s.x_offset).s, at(s.y_offset).s, xy_step(s, at(s.xy_feed_rate).f))
    elif xy_reached(s):
        s.state = IDLE

cdef void return_from_change(Plasmac* s) noexcept nogil:
    if s.entered:
        aim_xy(s, 0, 0, xy_step(s, at(s.xy_feed_rate).f))
    if xy_reached(s):
        at(s.consumable_changing).b = 0
        at(s.feed_hold).b = 0
        s.state = IDLE

# ---- going on with the cut at another place ----

cdef void point_laser(Plasmac* s) noexcept nogil:
    """Put the laser where the torch is."""
    if at(s.laser_recovery_state).s == LASER_WANTED:
        aim_xy(s, at(s.x_offset).s + at(s.laser_x_offset).s, at(s.y_offset).s + at(s.laser_y_offset).s,
               xy_step(s, at(s.cut_feed_rate).f))
        at(s.laser_recovery_state).s = LASER_MOVING
    elif xy_reached(s):
        at(s.laser_recovery_state).s = LASER_THERE

cdef bint laser_in_the_way(Plasmac* s) noexcept nogil:
    """Whether the torch has yet to come to where the laser points, as the program goes on."""
    cdef int32_t laser = at(s.laser_recovery_state).s
    if not at(s.cut_recovering).b or at(s.program_is_paused).b or laser < LASER_THERE:
        return False
    if laser == LASER_THERE:
        at(s.laser_recovery_state).s = LASER_LEAVES
    elif laser == LASER_LEAVES:
        aim_xy(s, at(s.x_offset).s, at(s.y_offset).s, xy_step(s, at(s.cut_feed_rate).f))
        at(s.laser_recovery_state).s = LASER_LEAVING
    elif xy_reached(s):
        at(s.laser_recovery_state).s = LASER_OFF
    return True

cdef void follow(Plasmac* s) noexcept nogil:
    """To where the operator wants the torch, or the laser."""
    cdef int32_t x = at(s.x_offset).s, y = at(s.y_offset).s
    cdef int32_t step = <int32_t>xy_step(s, 0.5 * at(s.cut_feed_rate).f)
    if at(s.laser_recovery_state).s == LASER_THERE:
        x += at(s.laser_x_offset).s
        y += at(s.laser_y_offset).s
    at(s.x_offset_counts).s = nearer(at(s.x_offset_counts).s, x, step)
    at(s.y_offset_counts).s = nearer(at(s.y_offset_counts).s, y, step)

cdef void recover(Plasmac* s) noexcept nogil:
    at(s.cut_recovering).b = 1
    at(s.xy_offset_enable).b = 1
    if at(s.laser_recovery_state).s in (LASER_WANTED, LASER_MOVING):
        point_laser(s)
    elif not at(s.cut_recovery).b:
        s.state = CUT_RECOVERY_OFF
    elif at(s.paused_motion_speed).f != 0.0:
        s.state = PAUSED_MOTION
    elif at(s.laser_recovery_state).s == LASER_OFF and at(s.laser_recovery_start).s > 0:
        at(s.laser_recovery_state).s = LASER_WANTED
    else:
        follow(s)
    if not at(s.program_is_paused).b:
        s.state = IDLE

cdef void end_recovery(Plasmac* s) noexcept nogil:
    """Back to the path: cutting, or slower after it was given up."""
    cdef double share = 1.0 if at(s.program_is_running).b else 0.5
    aim_xy(s, 0, 0, xy_step(s, share * at(s.cut_feed_rate).f))
    if not xy_reached(s):
        return
    at(s.cut_recovering).b = 0
    at(s.laser_recovery_state).s = LASER_OFF
    if at(s.program_is_paused).b:
        s.state = IDLE
    else:
        at(s.feed_hold).b = 0
        begin_cut(s)
        s.state = CUT_MODE_2 if at(s.mode).s == 2 else CUT_MODE_01
