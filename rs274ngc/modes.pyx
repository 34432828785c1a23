"""Codes that change a mode and move nothing: planes, units, distance, feed, control and spindle modes; F, S.

Each function is the handler of the codes that ``codes`` names with it.
"""

from libc.math cimport fabs

from rs274ngc.block cimport *
from rs274ngc.canon import (
    CANON_CONTINUOUS, CANON_EXACT_PATH, CANON_EXACT_STOP, CANON_PLANE_UV, CANON_PLANE_UW, CANON_PLANE_VW, CANON_PLANE_XY,
    CANON_PLANE_XZ, CANON_PLANE_YZ, CANON_SIDE_OFF, CANON_UNITS_INCHES, CANON_UNITS_MM,
)
from rs274ngc.canon cimport Canon
from rs274ngc.state cimport State, fail, fail_word, remember_position

cdef int SIDE_OFF = CANON_SIDE_OFF
cdef int INCHES = CANON_UNITS_INCHES, MM = CANON_UNITS_MM
cdef int CONTINUOUS = CANON_CONTINUOUS

PLANES = {
    170: CANON_PLANE_XY, 180: CANON_PLANE_XZ, 190: CANON_PLANE_YZ, 171: CANON_PLANE_UV, 181: CANON_PLANE_UW,
    191: CANON_PLANE_VW,
}


cdef int set_plane(State s, Block* b, int code) except -1:
    """G17 to G19.1"""
    cdef int plane = PLANES[code]
    if s.comp_side != SIDE_OFF and plane != s.plane:
        return fail(s, "Cannot change planes with cutter radius compensation on", b.g_at[2])
    s.plane = plane
    s.canon.select_plane(plane)
    return 0


cdef int set_units(State s, Block* b, int code) except -1:
    """G20, G21: what the interpreter remembers as a length is converted; a tool offset keeps its number, as in LinuxCNC."""
    cdef int units = INCHES if code == 200 else MM
    cdef double factor = 1.0 / 25.4 if units == INCHES else 25.4
    cdef int i
    s.canon.use_length_units(units)
    if units == s.units:
        return 0
    s.units = units
    for i in range(9):
        if i < 3 or i > 5:
            s.pos[i] *= factor
            s.origin[i] *= factor
            s.g92[i] *= factor
    s.comp_x *= factor
    s.comp_y *= factor
    s.comp_z *= factor
    if s.comp_side != SIDE_OFF:
        s.comp_radius *= factor
        s.comp_queue.scale(factor)
    remember_position(s)
    return 0


cdef int set_distance(State s, Block* b, int code) except -1:
    """G90, G91"""
    cdef bint incremental = code == 910
    if incremental != s.incremental:
        s.incremental = incremental
        s.canon.comment(f"interpreter: distance mode changed to {'incremental' if incremental else 'absolute'}")
    return 0


cdef int set_ijk_distance(State s, Block* b, int code) except -1:
    """G90.1, G91.1"""
    cdef bint absolute = code == 901
    if absolute != s.ijk_absolute:
        s.ijk_absolute = absolute
        s.canon.comment(f"interpreter: IJK distance mode changed to {'absolute' if absolute else 'incremental'}")
    return 0


cdef int set_diameter_mode(State s, Block* b, int code) except -1:
    """G7, G8"""
    cdef bint diameter = code == 70
    if diameter != s.diameter_mode:
        s.diameter_mode = diameter
        s.canon.comment(f"interpreter: Lathe diameter mode changed to {'diameter' if diameter else 'radius'}")
    return 0


cdef int set_retract(State s, Block* b, int code) except -1:
    """G98, G99"""
    cdef bint old_z = code == 980
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot change retract mode with cutter radius compensation on", b.g_at[10])
    s.retract_old_z = old_z
    s.canon.comment(f"interpreter: retract mode set to {'old_z' if old_z else 'r_plane'}")
    return 0


cdef int set_feed_mode(State s, Block* b, int code) except -1:
    """G93, G94, G95"""
    cdef int spindle = read_spindle(s, b, "Invalid spindle ($) number in Spindle Feed command")
    s.feed_mode = code
    s.active_spindle = spindle
    if code == 930:
        s.canon.comment("interpreter: feed mode set to inverse time")
        s.canon.set_feed_mode(0, 0)
    elif code == 940:
        s.canon.comment("interpreter: feed mode set to units per minute")
        s.canon.set_feed_mode(0, 0)
        s.canon.set_feed_rate(0.0)
        s.feed = 0.0
    else:
        s.canon.comment("interpreter: feed mode set to units per revolution")
        s.canon.set_feed_mode(spindle, 1)
        s.canon.set_feed_rate(0.0)
        s.feed = 0.0
    return 0


cdef int set_feed(State s, Block* b) except -1:
    """F; with G93 the motion itself computes the rate."""
    if s.feed_mode != 930:
        s.canon.set_feed_rate(b.value[W_F])
        s.feed = b.value[W_F]
    return 0


cdef int read_spindle(State s, Block* b, str message) except -1:
    """The spindle of the $ word, 0 without one."""
    if not has(b, W_DOLLAR):
        return 0
    cdef double spindle = b.value[W_DOLLAR]
    if spindle < 0.0 or spindle >= s.spindles:
        return fail_word(s, message, W_DOLLAR)
    return <int>spindle


cdef int check_spindle_mode(State s, Block* b, int code) except -1:
    if not has(b, W_S):
        return fail(s, "S word missing with G96", b.g_at[14])
    return 0


cdef int set_spindle_mode(State s, Block* b, int code) except -1:
    """G96 with D and S, G97"""
    cdef int spindle = read_spindle(s, b, "Invalid spindle ($) number in Spindle Mode command")
    if code == 960:
        s.css[spindle] = fabs(value_or(b, W_D, 1.0e30))
    else:
        s.css[spindle] = 0.0
    s.active_spindle = spindle
    s.canon.set_spindle_mode(spindle, s.css[spindle])
    return 0


cdef int synchronised_spindle(State s, Block* b, str message) except -1:
    """The spindle that a move keeps step with: of the $ word, else the one that G96 or G97 named last."""
    return read_spindle(s, b, message) if has(b, W_DOLLAR) else s.active_spindle


cdef int read_spindles(State s, Block* b, str message, int* first, int* last) except -1:
    """The spindle of the $ word, spindle 0 without one, all of them with $-1."""
    if has(b, W_DOLLAR) and b.value[W_DOLLAR] == -1.0:
        first[0], last[0] = 0, s.spindles - 1
    else:
        first[0] = last[0] = read_spindle(s, b, message)
    return 0


cdef int set_speed(State s, Block* b) except -1:
    """S"""
    cdef int spindle, first, last
    read_spindles(s, b, "Invalid spindle ($) number in Spindle speed command", &first, &last)
    for spindle in range(first, last + 1):
        s.speed[spindle] = b.value[W_S]
        s.canon.set_spindle_speed(spindle, b.value[W_S])
    return 0


cdef int set_control(State s, Block* b, int code) except -1:
    """G61, G61.1, G64 with P and Q"""
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot change control mode with cutter radius compensation on", b.g_at[13])
    if code == 640:
        s.control_mode = CONTINUOUS
        s.tolerance = max(value_or(b, W_P, 0.0), 0.0)
        s.naivecam_tolerance = value_or(b, W_Q, s.tolerance)
        if s.naivecam_tolerance < 0.0:
            s.naivecam_tolerance = s.tolerance
    else:
        s.control_mode = CANON_EXACT_PATH if code == 610 else CANON_EXACT_STOP
    send_control(s)
    return 0


cdef int send_control(State s) except -1:
    """Tell the canon the control mode in force."""
    if s.control_mode == CONTINUOUS:
        s.canon.set_motion_control_mode(s.control_mode, s.tolerance)
        s.canon.set_naivecam_tolerance(s.naivecam_tolerance)
    else:
        s.canon.set_motion_control_mode(s.control_mode, 0.0)
    return 0
