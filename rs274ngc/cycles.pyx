"""Canned cycles: G73, G74, G81 to G89, in all planes, absolute and incremental, repeated.

A cycle is written for the plane's axes: first and second span the plane, the drill moves along the third. What all cycles
share is in ``canned_cycle``; one function per code does what happens in the hole. ``Hole`` carries the numbers.
"""

from libc.string cimport memcpy

from rs274ngc.block cimport *
from rs274ngc.canon import (
    CANON_CLOCKWISE, CANON_CONTINUOUS, CANON_COUNTERCLOCKWISE, CANON_EXACT_PATH, CANON_PLANE_XZ, CANON_PLANE_YZ,
    CANON_SIDE_OFF, CANON_STOPPED, CANON_UNITS_INCHES,
)
from rs274ngc.modes cimport synchronised_spindle, send_control
from rs274ngc.path cimport axis_words, feed, plane_axes, polar_to_xy, traverse
from rs274ngc.state cimport State, fail, fail_word

cdef int SIDE_OFF = CANON_SIDE_OFF, INCHES = CANON_UNITS_INCHES, EXACT_PATH = CANON_EXACT_PATH, CONTINUOUS = CANON_CONTINUOUS
cdef int STOPPED = CANON_STOPPED, CLOCKWISE = CANON_CLOCKWISE, COUNTERCLOCKWISE = CANON_COUNTERCLOCKWISE
cdef double PECK_CLEARANCE_INCH = 0.010     # how far above the last depth a peck begins, and a chip break retracts
cdef int XZ = CANON_PLANE_XZ, YZ = CANON_PLANE_YZ
cdef str AXES = "XYZABCUVW"

cdef int REPEATS_MAX = 1000000

PLANE_NAMES = {1: "XY", 2: "YZ", 3: "XZ", 4: "UV", 5: "VW", 6: "UW"}


ctypedef struct Hole:
    int first, second, third    # axes
    double x, y                 # place in the plane
    double r                    # clearance plane
    double bottom
    double clear                # where the tool goes afterwards
    int code


cdef int at_height(State s, double height, int axis, bint rapid) except -1:
    """Along the drilling axis only."""
    cdef double[9] end
    memcpy(end, s.pos, sizeof(end))
    end[axis] = height
    return traverse(s, end) if rapid else feed(s, end)


cdef int at_place(State s, Hole* h, double height) except -1:
    """Over the place, at least as high as ``height``."""
    cdef double[9] end
    memcpy(end, s.pos, sizeof(end))
    end[h.first] = h.x
    end[h.second] = h.y
    end[h.third] = max(end[h.third], height)
    return traverse(s, end)


cdef int tap_to(State s, double height, Hole* h) except -1:
    """The feed of a tapping cycle. In the XZ and YZ planes its axes are exchanged, as LinuxCNC's are."""
    cdef double x, y, z
    if s.plane == XZ:
        x, y, z = height, s.pos[h.first], s.pos[h.second]
    elif s.plane == YZ:
        x, y, z = s.pos[h.second], height, s.pos[h.first]
    else:
        return at_height(s, height, h.third, False)
    s.canon.straight_feed(s.line, x, y, z, s.pos[3], s.pos[4], s.pos[5], s.pos[6], s.pos[7], s.pos[8])
    s.pos[h.third] = height
    return 0


# --- One hole

cdef int drill(State s, Block* b, Hole* h) except -1:
    """G81; G82 with a dwell at the bottom"""
    at_height(s, h.bottom, h.third, False)
    if h.code == 820:
        s.canon.dwell(s.cycle_p)
    return at_height(s, h.clear, h.third, True)


cdef int peck(State s, Block* b, Hole* h) except -1:
    """G83 clears the hole after every Q, G73 only breaks the chip"""
    cdef double clearance = PECK_CLEARANCE_INCH * (1.0 if s.units == INCHES else 25.4)
    cdef double depth = h.r - s.cycle_q
    if s.cycle_q <= 0.0:
        return fail(s, "Negative or zero q value used", b.at[W_Q] if has(b, W_Q) else b.g_at[1])
    if (h.r - h.bottom) / s.cycle_q > REPEATS_MAX:
        return fail_word(s, "Too many pecks in cycle", W_Q)
    while depth > h.bottom:
        at_height(s, depth, h.third, False)
        if h.code == 830:
            at_height(s, h.r, h.third, True)
        at_height(s, depth + clearance, h.third, True)
        depth -= s.cycle_q
    at_height(s, h.bottom, h.third, False)
    return at_height(s, h.clear, h.third, True)


cdef int tap(State s, Block* b, Hole* h) except -1:
    """G84 right-hand, G74 left-hand: overrides off, feed in, reverse, dwell, feed out"""
    cdef int n = synchronised_spindle(s, b, "Invalid spindle ($) number in G74/G84 cycle")
    cdef int turning = s.turning[n]
    cdef bint feed_override = s.feed_override, speed_override = s.speed_override[n]
    if turning == STOPPED:
        return fail(s, f"Spindle not turning in {'G84' if h.code == 840 else 'G74'}", b.g_at[1])
    if h.code == 840 and turning == COUNTERCLOCKWISE:
        return fail(s, "Spindle turning counterclockwise in G84", b.g_at[1])
    if h.code == 740 and turning == CLOCKWISE:
        return fail(s, "Spindle turning clockwise in G74", b.g_at[1])
    s.canon.disable_feed_override()
    s.canon.disable_speed_override(n)
    tap_to(s, h.bottom, h)
    s.canon.stop_spindle_turning(n)
    if h.code == 840:
        s.canon.start_spindle_counterclockwise(n, True)
    else:
        s.canon.start_spindle_clockwise(n, True)
    s.canon.dwell(s.cycle_p)
    tap_to(s, h.clear, h)
    s.canon.stop_spindle_turning(n)
    if h.code == 840:
        s.canon.start_spindle_clockwise(n, True)
    else:
        s.canon.start_spindle_counterclockwise(n, True)
    if feed_override:
        s.canon.enable_feed_override()
    if speed_override:
        s.canon.enable_speed_override(n)
    return 0


cdef int bore(State s, Block* b, Hole* h) except -1:
    """G85: feed out to R, then rapid; G89: dwell, feed out all the way"""
    at_height(s, h.bottom, h.third, False)
    if h.code == 890:
        s.canon.dwell(s.cycle_p)
        return at_height(s, h.clear, h.third, False)
    at_height(s, h.r, h.third, False)
    return at_height(s, h.clear, h.third, True)


cdef int bore_stopped(State s, Block* b, Hole* h) except -1:
    """G86: the spindle stops before a rapid out; G88: the operator takes the tool out"""
    cdef int n = s.active_spindle, turning = s.turning[n]
    if turning == STOPPED:
        return fail(s, f"Spindle not turning in {'g86' if h.code == 860 else 'g88'}", b.g_at[1])
    at_height(s, h.bottom, h.third, False)
    s.canon.dwell(s.cycle_p)
    s.canon.stop_spindle_turning(n)
    if h.code == 860:
        at_height(s, h.clear, h.third, True)
    else:
        s.canon.program_stop()
        s.pos[h.third] = h.clear
    return restart(s, n, turning)


cdef int restart(State s, int n, int turning) except -1:
    if turning == CLOCKWISE:
        s.canon.start_spindle_clockwise(n, True)
    else:
        s.canon.start_spindle_counterclockwise(n, True)
    return 0


cdef int back_bore(State s, Block* b, Hole* h) except -1:
    """G87: through the hole beside its axis, back up against the work, and out again"""
    cdef double* beside = [s.cycle_i, s.cycle_j, s.cycle_k]
    cdef double x = h.x + beside[h.first % 3], y = h.y + beside[h.second % 3], middle = beside[h.third % 3]
    cdef double hole_x = h.x, hole_y = h.y
    cdef int n = s.active_spindle, turning = s.turning[n]
    if s.incremental:
        middle += h.bottom
    if turning == STOPPED:
        return fail(s, "Spindle not turning in g87", b.g_at[1])
    h.x, h.y = x, y
    at_place(s, h, h.bottom)
    s.canon.stop_spindle_turning(n)
    s.canon.orient_spindle(n, 0.0, turning)
    at_height(s, h.bottom, h.third, True)
    h.x, h.y = hole_x, hole_y
    at_place(s, h, h.bottom)
    restart(s, n, turning)
    at_height(s, middle, h.third, False)
    at_height(s, h.bottom, h.third, False)
    s.canon.stop_spindle_turning(n)
    s.canon.orient_spindle(n, 0.0, turning)
    h.x, h.y = x, y
    at_place(s, h, h.bottom)
    at_height(s, h.clear, h.third, True)
    h.x, h.y = hole_x, hole_y
    at_place(s, h, h.bottom)
    return restart(s, n, turning)


ctypedef int (*Bore)(State, Block*, Hole*) except -1
cdef Bore[1000] cycle
cycle[730] = cycle[830] = peck
cycle[740] = cycle[840] = tap
cycle[810] = cycle[820] = drill
cycle[850] = cycle[890] = bore
cycle[860] = cycle[880] = bore_stopped
cycle[870] = back_bore


# --- What all cycles share

cdef int check_words(State s, Block* b, Hole* h) except -1:
    """The axis words that a cycle may have in the active plane."""
    cdef int axis
    cdef str plane = PLANE_NAMES[s.plane]
    for axis in (0, 1, 2) if s.plane > 3 else (6, 7, 8):
        if has(b, axis_words[axis]):
            return fail_word(s, f"Cannot put {'an' if axis == 0 else 'a'} {AXES[axis]} in a canned cycle in the {plane} plane",
                             axis_words[axis])
    return 0


cdef int sticky_numbers(State s, Block* b, int code) except -1:
    """P, Q, I, J, K stay from line to line of the same cycle; those that are missing are an error."""
    cdef bint again = s.motion == code
    if value_or(b, W_P, MISSING) != MISSING:
        s.cycle_p = b.value[W_P]
    elif code in (820, 860, 880, 890):
        if not again:
            return fail(s, f"Dwell time p word missing with g{code // 10}", b.g_at[1])
    if code == 730 or code == 830:
        if value_or(b, W_Q, MISSING) != MISSING:
            s.cycle_q = b.value[W_Q]
        elif not again:
            return fail(s, f"Q word missing with g{code // 10}", b.g_at[1])
    if code == 870:
        for word, letter in ((W_I, "I"), (W_J, "J"), (W_K, "K")):
            if not has(b, word) and not again:
                return fail(s, f"{letter} word missing with g87", b.g_at[1])
        s.cycle_i = value_or(b, W_I, s.cycle_i)
        s.cycle_j = value_or(b, W_J, s.cycle_j)
        s.cycle_k = value_or(b, W_K, s.cycle_k)
    return 0


cdef int canned_cycle(State s, Block* b, int code) except -1:
    """G73, G74, G81 to G89: check, go to the clearance plane, then hole after hole"""
    cdef Hole h
    cdef double z, r, step_x = 0.0, step_y = 0.0, height
    cdef int repeats = <int>value_or(b, W_L, 1.0), k, control
    cdef bint again = s.motion == code
    cdef int* axes = plane_axes[s.plane]
    if s.feed_mode == 930:
        return fail(s, "Cannot use inverse time feed with canned cycles", b.g_at[1])
    if s.feed == 0.0:
        return fail(s, "Cannot feed with zero feed rate", b.g_at[1])
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot use canned cycles with cutter compensation on", b.g_at[1])
    h.first, h.second, h.third, h.code = axes[0], axes[1], axes[2], code
    check_words(s, b, &h)
    low = AXES[h.third] if s.plane > 3 else AXES[h.third].lower()
    plane = PLANE_NAMES[s.plane] if s.plane > 3 else PLANE_NAMES[s.plane].lower()
    if not has(b, W_R) and not again:
        return fail(s, "R clearance plane unspecified in cycle", b.g_at[1])
    if not has(b, axis_words[h.third]) and not again:
        return fail(s, f"{AXES[h.third]} value unspecified in {plane} plane canned cycle", b.g_at[1])
    if repeats == 0:
        return fail_word(s, "Cannot do zero repeats of cycle", W_L)
    if repeats > REPEATS_MAX:
        return fail_word(s, "Too many repeats of cycle", W_L)
    z = in_radius(s, b, h.third, s.cycle_z)
    r = value_or(b, W_R, s.cycle_r)
    s.cycle_z, s.cycle_r = z, r
    if not s.in_cycles:
        s.cycle_level = s.pos[h.third]
        s.in_cycles = True
    height = s.cycle_level
    if s.incremental:
        step_x = in_radius(s, b, h.first, 0.0)
        step_y = in_radius(s, b, h.second, 0.0)
        h.x, h.y = s.pos[h.first], s.pos[h.second]
        h.r = r + height
        h.bottom = z + h.r
    else:
        h.x = in_radius(s, b, h.first, s.pos[h.first])
        h.y = in_radius(s, b, h.second, s.pos[h.second])
        h.r = r
        h.bottom = z
    if h.r < h.bottom:
        return fail_word(s, f"R less than {low} in cycle in {plane} plane", W_R)
    if height < h.r:
        at_height(s, h.r, h.third, True)
        height = h.r
    h.clear = height if s.retract_old_z else h.r
    control = s.control_mode
    if control != EXACT_PATH:
        s.canon.set_motion_control_mode(EXACT_PATH, 0.0)
    sticky_numbers(s, b, code)
    for k in range(repeats):
        if k > 0 and s.incremental and b.words & M_POLAR:
            b.words &= ~<unsigned int>((1 << W_X) | (1 << W_Y))
            polar_to_xy(s, b)
            step_x, step_y = in_radius(s, b, h.first, 0.0), in_radius(s, b, h.second, 0.0)
        h.x += step_x
        h.y += step_y
        at_place(s, &h, h.r)
        if s.pos[h.third] != h.r:
            at_height(s, h.r, h.third, True)
        cycle[code](s, b, &h)
    s.motion = code
    if control != EXACT_PATH:
        send_control(s)
        if control != CONTINUOUS:
            s.canon.set_naivecam_tolerance(s.naivecam_tolerance)
    return 0


cdef double in_radius(State s, Block* b, int axis, double default) noexcept:
    """An axis word, X as a radius."""
    cdef double value = value_or(b, axis_words[axis], default)
    return value * 0.5 if axis == 0 and s.diameter_mode and has(b, W_X) else value
