"""Moves in step with the spindle: G33, G33.1 and the threading cycle G76."""

from libc.math cimport M_PI, fabs, hypot, pow, tan
from libc.string cimport memcpy

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_PLANE_XY, CANON_SIDE_OFF, CANON_STOPPED
from rs274ngc.modes cimport synchronised_spindle
from rs274ngc.path cimport feed, find_end, traverse
from rs274ngc.state cimport State, fail, fail_word

cdef int PLANE_XY = CANON_PLANE_XY, SIDE_OFF = CANON_SIDE_OFF, STOPPED = CANON_STOPPED
cdef int PASSES_MAX = 1000000

cdef enum:
    X = 0
    Z = 2
    ENTRY_TAPER = 1     # G76 L
    EXIT_TAPER = 2


# --- G33 and G33.1

cdef int check_threading(State s, Block* b, int code) except -1:
    """What G33 and G33.1 need: a pitch, and no feed."""
    if not has(b, W_K):
        return fail(s, "K word missing with g33/g33.1", b.g_at[1])
    if has(b, W_F):
        return fail_word(s, "F word used with a g33/g33.1", W_F)
    return 0


cdef int turning_spindle(State s, Block* b, str name) except -1:
    """The spindle of the $ word, which must turn."""
    cdef int spindle = synchronised_spindle(s, b, f"Invalid spindle ($) number in {name} move")
    if s.turning[spindle] == STOPPED:
        return fail(s, f"Spindle not turning in {name}", b.g_at[1])
    return spindle


cdef int refuse_compensated(State s, const double* end) except -1:
    """A threading move cannot be compensated; the words are LinuxCNC's."""
    cdef double length = hypot(end[0] - s.pos[0], end[1] - s.pos[1] if s.plane == PLANE_XY else end[2] - s.pos[2])
    if s.comp_side == SIDE_OFF or s.comp_radius == 0.0:
        return 0
    if s.comp_first and length <= s.comp_radius:
        return fail(s, "Length of cutter compensation entry move is not greater than the tool radius")
    return fail(s, "Bug code not g0 or g1")


cdef int spindle_feed(State s, Block* b, int code) except -1:
    """G33 K pitch: a straight move in step with the spindle"""
    cdef double[9] end
    cdef int spindle
    find_end(s, b, end)
    refuse_compensated(s, end)
    spindle = turning_spindle(s, b, "G33")
    s.canon.start_speed_feed_synch(spindle, b.value[W_K], False)
    feed(s, end)
    s.canon.stop_speed_feed_synch()
    s.motion = code
    return 0


cdef int rigid_tap(State s, Block* b, int code) except -1:
    """G33.1 K pitch: to the end and back to the start, the spindle reverses; I: speed of the way back"""
    cdef double[9] end
    cdef int spindle
    find_end(s, b, end)
    refuse_compensated(s, end)
    spindle = turning_spindle(s, b, "G33.1")
    s.canon.start_speed_feed_synch(spindle, b.value[W_K], False)
    s.canon.rigid_tap(s.line, end[0], end[1], end[2], value_or(b, W_I, 1.0))
    s.canon.stop_speed_feed_synch()
    s.motion = code
    return 0


# --- G76

ctypedef struct Thread:
    double x, z             # drive line and start
    double end              # Z
    double peak             # I: from the drive line to the crest
    double full             # K: depth below the crest
    double pitch, taper_pitch
    double taper            # E: length of a taper along Z
    int tapers              # L
    double slope            # tangent of the compound angle
    int outward             # +1 internal thread: deeper is greater X; -1 external
    int direction           # of the cut along Z
    int spindle


cdef int check_g76(State s, Block* b, int code) except -1:
    """Words that G76 cannot do without."""
    if value_or(b, W_P, MISSING) == MISSING:
        return fail(s, "P word missing with G76", b.g_at[1])
    if not (has(b, W_I) and has(b, W_J) and has(b, W_K)):
        return fail(s, "I J or K words missing with G76", b.g_at[1])
    return 0


cdef int to_x(State s, double x, bint rapid) except -1:
    cdef double[9] end
    memcpy(end, s.pos, sizeof(end))
    end[X] = x
    return traverse(s, end) if rapid else feed(s, end)


cdef int to_xz(State s, double x, double z, bint rapid) except -1:
    cdef double[9] end
    memcpy(end, s.pos, sizeof(end))
    end[X], end[Z] = x, z
    return traverse(s, end) if rapid else feed(s, end)


cdef int one_pass(State s, Thread* t, double depth) except -1:
    """Cut once at ``depth`` below the crest; the first and last passes share their crest line, so do all tapers."""
    cdef double safe = t.x - t.outward * (t.full - depth)
    cdef double cut = t.x + t.peak + t.outward * depth
    cdef double start = t.z + t.direction * depth * t.slope
    cdef double end = t.end - t.direction * (t.full - depth) * t.slope
    to_xz(s, safe, start, True)
    if not t.tapers & ENTRY_TAPER:
        to_xz(s, cut, start, True)
    s.canon.disable_feed_override()
    s.canon.start_speed_feed_synch(t.spindle, t.taper_pitch if t.tapers & ENTRY_TAPER else t.pitch, False)
    if t.tapers & ENTRY_TAPER:
        to_x(s, safe + t.peak, False)
        to_xz(s, cut, start + t.direction * t.taper, False)
        s.canon.start_speed_feed_synch(t.spindle, t.pitch, False)
    if t.tapers & EXIT_TAPER:
        to_xz(s, cut, end - t.direction * t.taper, False)
        s.canon.start_speed_feed_synch(t.spindle, t.taper_pitch, False)
        to_xz(s, safe + t.peak, end, False)
    else:
        to_xz(s, cut, end, False)
    s.canon.stop_speed_feed_synch()
    to_x(s, safe, True)
    s.canon.enable_feed_override()
    return 0


cdef int threading_cycle(State s, Block* b, int code) except -1:
    """G76 P pitch Z end I crest J first depth K full depth, R degression Q angle H spring passes E L tapers"""
    cdef Thread t
    cdef double[9] end
    cdef double scale = 0.5 if s.diameter_mode else 1.0
    cdef double first = b.value[W_J] * scale, depth, degression = value_or(b, W_R, 1.0)
    cdef int number = 1, extra
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot use G76 threading cycle with cutter radius compensation on", b.g_at[1])
    t.spindle = synchronised_spindle(s, b, "Invalid spindle ($) number in G76 cycle")
    if s.turning[t.spindle] == STOPPED:
        return fail(s, f"Chosen spindle ({t.spindle}) not turning in G76", b.g_at[1])
    if b.words & M_ABC:
        return fail(s, "Cannot move rotary axes with G76", b.g_at[1])
    if b.value[W_I] == 0.0:
        return fail_word(s, "In G76, I must not be 0", W_I)
    if first <= 0.0:
        return fail_word(s, "In G76, J must be greater than 0", W_J)
    if b.value[W_K] * scale <= first:
        return fail_word(s, "In G76, K must be greater than J", W_K)
    find_end(s, b, end)
    t.x, t.z, t.end = s.pos[X], s.pos[Z], end[Z]
    t.peak, t.full = b.value[W_I] * scale, b.value[W_K] * scale
    t.outward = 1 if t.peak > 0.0 else -1
    t.direction = 1 if t.end > t.z else -1
    t.pitch, t.taper, t.tapers = b.value[W_P], value_or(b, W_E, 0.0), <int>value_or(b, W_L, 0.0) & 3
    t.slope = tan(value_or(b, W_Q, MISSING) * M_PI / 180.0) if value_or(b, W_Q, MISSING) != MISSING else 0.0
    if t.taper <= 0.0:
        t.taper, t.tapers, t.taper_pitch = 0.0, 0, t.pitch
    else:
        t.taper_pitch = t.pitch * hypot(t.taper, t.full) / t.taper
    if degression < 1.0:
        degression = 1.0
    if pow(t.full / first, degression) + fabs(value_or(b, W_H, 0.0)) > PASSES_MAX:
        return fail(s, "Too many passes in G76", b.g_at[1])
    depth = first
    while depth < t.full:
        one_pass(s, &t, depth)
        number += 1
        depth = first * pow(number, 1.0 / degression)
    for extra in range(<int>value_or(b, W_H, 0.0) + 1):
        one_pass(s, &t, t.full)
    s.motion = code
    return traverse(s, end)
