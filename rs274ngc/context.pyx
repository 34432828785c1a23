"""Modal state that is put aside and taken back: M70, M71, M72, M73.

What is saved belongs to a call level and goes with it. Restoring runs the handler of each code whose mode has changed
since, in the order of execution, so the canon hears only of changes.
"""

from libc.string cimport memset

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_CLOCKWISE, CANON_CONTINUOUS, CANON_COUNTERCLOCKWISE, CANON_SIDE_LEFT, CANON_SIDE_OFF
from rs274ngc.compensation cimport set_compensation
from rs274ngc.machine cimport coolant, overrides, spindle
from rs274ngc.modes cimport (
    send_control, set_diameter_mode, set_distance, set_feed, set_feed_mode, set_ijk_distance, set_plane, set_retract,
    set_speed, set_spindle_mode, set_units,
)
from rs274ngc.offsets cimport select_origin, shift_tool_offset
from rs274ngc.predefined import PLANE_CODES
from rs274ngc.state cimport State, fail

COORD_SYSTEM_CODES = (0, 540, 550, 560, 570, 580, 590, 591, 592, 593)


class Saved:
    """The modes of one moment."""

    def __init__(self, State s):
        self.units, self.plane = s.units, s.plane
        self.incremental, self.ijk_absolute, self.diameter_mode = s.incremental, s.ijk_absolute, s.diameter_mode
        self.retract_old_z = s.retract_old_z
        self.feed_mode, self.feed = s.feed_mode, s.feed
        self.origin_index = s.origin_index
        self.control = (s.control_mode, s.tolerance, s.naivecam_tolerance)
        self.spindles = [(s.css[n], s.speed[n], s.turning[n], s.speed_override[n]) for n in range(s.spindles)]
        self.mist, self.flood = s.mist, s.flood
        self.feed_override, self.adaptive_feed, self.feed_hold = s.feed_override, s.adaptive_feed, s.feed_hold
        self.compensation = (s.comp_side, s.comp_radius, s.comp_orientation)
        self.tool = s.tool_offset
        self.tool_offset_code, self.g43_active = s.tool_offset_code, s.g43_active


cdef int context(State s, Block* b, int code) except -1:
    """M70 save; M71 forget; M72 restore; M73 save, and restore at return"""
    if code == 72:
        if s.frame.saved is None:
            return fail(s, "Cannot restore context from invalid stack frame - missing M70/M73?", b.m_at[7])
        return restore(s, s.frame.saved)
    if code == 71:
        s.frame.saved = None
        s.frame.restore = False
        return 0
    s.frame.saved = Saved(s)
    if code == 73:
        s.frame.restore = len(s.frames) > 1
    return 0


cdef int restore(State s, saved) except -1:
    """Back to the modes of ``saved``."""
    cdef Block b
    cdef int n
    memset(&b, 0, sizeof(b))
    memset(b.g, 0xFF, sizeof(b.g))
    if s.units != saved.units:
        set_units(s, &b, 200 if saved.units == 1 else 210)
    restore_spindles_and_feed(s, &b, saved)
    if s.mist != saved.mist or s.flood != saved.flood:
        coolant(s, &b, 9)
        if saved.mist:
            coolant(s, &b, 7)
        if saved.flood:
            coolant(s, &b, 8)
    restore_overrides(s, &b, saved)
    if s.plane != saved.plane:
        set_plane(s, &b, PLANE_CODES[saved.plane])
    if s.diameter_mode != saved.diameter_mode:
        set_diameter_mode(s, &b, 70 if saved.diameter_mode else 80)
    restore_compensation(s, &b, saved)
    if s.tool_offset != saved.tool:
        shift_tool_offset(s, saved.tool)
        s.tool_offset_code, s.g43_active = saved.tool_offset_code, saved.g43_active
    if s.origin_index != saved.origin_index:
        select_origin(s, &b, COORD_SYSTEM_CODES[saved.origin_index])
    if (s.control_mode, s.tolerance, s.naivecam_tolerance) != saved.control:
        if saved.control[0] == CANON_CONTINUOUS:
            s.tolerance, s.naivecam_tolerance = saved.control[1:]
        s.control_mode = saved.control[0]
        send_control(s)
    if s.retract_old_z != saved.retract_old_z:
        set_retract(s, &b, 980 if saved.retract_old_z else 990)
    set_distance(s, &b, 910 if saved.incremental else 900)
    set_ijk_distance(s, &b, 901 if saved.ijk_absolute else 911)
    return 0


cdef int restore_spindles_and_feed(State s, Block* b, saved) except -1:
    cdef int n
    for n in range(s.spindles):
        css, speed, turning, _ = saved.spindles[n]
        b.words = 1 << W_DOLLAR
        b.value[W_DOLLAR] = n
        if s.css[n] != css:
            b.words |= 1 << W_D
            b.value[W_D] = css
            set_spindle_mode(s, b, 960 if css != 0.0 else 970)
    b.words = 0
    if s.feed_mode != saved.feed_mode:
        set_feed_mode(s, b, saved.feed_mode)
    if s.feed != saved.feed:
        b.value[W_F] = saved.feed
        set_feed(s, b)
    for n in range(s.spindles):
        css, speed, turning, _ = saved.spindles[n]
        b.words = 1 << W_DOLLAR
        b.value[W_DOLLAR] = n
        b.value[W_S] = speed
        if s.speed[n] != speed:
            set_speed(s, b)
        if s.turning[n] != turning:
            spindle(s, b, {CANON_CLOCKWISE: 3, CANON_COUNTERCLOCKWISE: 4}.get(turning, 5))
    b.words = 0
    return 0


cdef int restore_overrides(State s, Block* b, saved) except -1:
    cdef int n
    b.words = 1 << W_P
    for code, now, before in (
        (50, s.feed_override, saved.feed_override),
        (52, s.adaptive_feed, saved.adaptive_feed),
        (53, s.feed_hold, saved.feed_hold),
    ):
        if now != before:
            b.value[W_P] = before
            overrides(s, b, code)
    b.words |= 1 << W_DOLLAR
    for n in range(s.spindles):
        if s.speed_override[n] != saved.spindles[n][3]:
            b.value[W_DOLLAR] = n
            b.value[W_P] = saved.spindles[n][3]
            overrides(s, b, 51)
    b.words = 0
    return 0


cdef int restore_compensation(State s, Block* b, saved) except -1:
    side, radius, orientation = saved.compensation
    if s.comp_side == side:
        return 0
    if s.comp_side != CANON_SIDE_OFF:
        set_compensation(s, b, 400)
    if side != CANON_SIDE_OFF:
        b.words = (1 << W_D) | (1 << W_L if s.plane == 3 else 0)
        b.value[W_D], b.value[W_L] = radius * 2.0, orientation
        set_compensation(s, b, 411 if side == CANON_SIDE_LEFT else 421)
        b.words = 0
    return 0
