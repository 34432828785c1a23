"""Codes that move in a straight line or an arc: G0, G1, G2, G3, G38.n, G28, G30; beside them G4, G28.2, G53, G80.

Each function is the handler of the codes that ``codes`` names with it.
"""

from libc.math cimport fabs, floor

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_PLANE_XY, CANON_PLANE_XZ, CANON_PLANE_YZ, CANON_SIDE_OFF, CANON_UNITS_INCHES
from rs274ngc.compensation cimport compensated_arc, compensated_straight
from rs274ngc.path cimport *
from rs274ngc.state cimport WAIT_PROBE, State, fail, fail_word

cdef int INCHES = CANON_UNITS_INCHES, SIDE_OFF = CANON_SIDE_OFF
cdef int XY = CANON_PLANE_XY, XZ = CANON_PLANE_XZ, YZ = CANON_PLANE_YZ
cdef str AXES = "XYZABCUVW"
cdef double JOINTS_MAX = 1e6        # a number far above any joint; the machine says which ones it has

cdef enum:
    G_MOTION_GROUP = 1
    ALL_JOINTS = -1     # P word of G28.2


cdef int check_dwell(State s, Block* b, int code) except -1:
    if value_or(b, W_P, -1.0) == -1.0:
        return fail(s, "Dwell time missing with g4", b.g_at[0])
    if b.motion == 20 or b.motion == 30:
        return fail(s, "G4 not allowed with G2 or G3 because they both use P", b.g_at[0])
    return 0


cdef int dwell(State s, Block* b, int code) except -1:
    """G4 P: seconds"""
    s.canon.dwell(b.value[W_P])
    return 0


cdef int check_machine_coordinates(State s, Block* b, int code) except -1:
    """G53"""
    if b.motion != 0 and b.motion != 10:
        return fail(s, "Must use g0 or g1 with g53", b.g_at[0])
    if b.g[3] == 910 or (b.g[3] != 900 and s.incremental):
        return fail(s, "Cannot use g53 incremental", b.g_at[0])
    return 0


cdef int cancel_motion(State s, Block* b, int code) except -1:
    """G80"""
    s.motion = 800
    s.canon.comment("interpreter: motion mode set to none")
    return 0


cdef int straight(State s, Block* b, int code) except -1:
    """G0, G1"""
    cdef double[9] end
    if s.comp_side != SIDE_OFF and s.comp_radius > 0.0 and b.g[0] == 530:
        return fail(s, "Cannot use g53 with cutter radius comp", b.g_at[0])
    if code == 10:
        if s.feed_mode == 930:
            if not has(b, W_F):
                return fail(s, "F word missing with inverse time g1 move")
        elif s.feed == 0.0:
            return fail(s, "Cannot do g1 with zero feed rate")
        elif s.feed_mode == 950 and s.speed[s.active_spindle] == 0.0:
            return fail(s, "Cannot feed with zero spindle speed in feed per rev mode")
    s.motion = code
    find_end(s, b, end)
    if b.words & M_ABC and (s.indexer[0] >= 0 or s.indexer[1] >= 0 or s.indexer[2] >= 0):
        if indexer_move(s, b, code, end):
            return 0
    if s.comp_side != SIDE_OFF and s.comp_radius > 0.0:
        return compensated_straight(s, b, code, end)
    s.arc_not_allowed = False
    if code == 0:
        traverse(s, end)
    else:
        if s.feed_mode == 930:
            inverse_rate(s, b, straight_length(s.pos, end))
        feed(s, end)
    s.comp_x = end[0]
    s.comp_y = end[1]
    s.comp_z = end[2]
    return 0


cdef int indexer_move(State s, Block* b, int code, const double* end) except -1:
    """A locking indexer (A, B or C) moves alone, unlocked; 1: done."""
    cdef int k, axis, joint
    for k in range(3):
        joint = s.indexer[k]
        axis = 3 + k
        if joint < 0 or not has(b, axis_words[axis]):
            continue
        if code != 0:
            return fail(s, f"Indexing axis {AXES[axis]} can only be moved with G0")
        if b.words & M_AXES != 1 << axis_words[axis]:
            return fail(s, f"Indexing axis {AXES[axis]} can only be moved alone")
        s.canon.unlock_rotary(s.line, joint)
        traverse(s, end)
        s.canon.lock_rotary(s.line, joint)
        return 1
    return 0


cdef int check_turns(State s, Block* b, int code) except -1:
    """P of G2, G3"""
    cdef double turns = value_or(b, W_P, 1.0)
    if fabs(turns - floor(turns + 0.5)) > 0.001:
        return fail_word(s, "P value not an integer with M19 G2 or G3", W_P)
    if floor(turns + 0.5) < 1.0:
        return fail_word(s, "P value should be 1 or greater with G2 or G3", W_P)
    if turns > 1.0e6:
        return fail_word(s, "P value out of range with G2 or G3", W_P)
    return 0


cdef int arc(State s, Block* b, int code) except -1:
    """G2, G3: centre or radius format, helix, P turns"""
    cdef double[9] end
    cdef double[3] start
    cdef Arc a
    cdef int* axes
    if s.plane != XY and s.plane != XZ and s.plane != YZ:
        return fail(s, "Cannot do an arc in planes G17.1, G18.1, or G19.1", b.g_at[G_MOTION_GROUP])
    if s.arc_not_allowed:
        return fail(s, "The move just after exiting cutter compensation mode must be straight, not an arc", b.g_at[G_MOTION_GROUP])
    check_arc_form(s, b)
    need_feed(s, b, "Cannot make arc with zero feed rate", "F word missing with inverse time arc move")
    check_arc_words(s, b)
    if s.feed_mode == 950 and s.speed[s.active_spindle] == 0.0:
        return fail(s, "Cannot feed with zero spindle speed in feed per rev mode")
    s.motion = code
    find_end(s, b, end)
    if s.comp_side != SIDE_OFF and s.comp_radius > 0.0:
        return compensated_arc(s, b, code, end)
    read_arc(s, b, code, end, &a)
    axes = plane_axes[s.plane]
    if s.feed_mode == 930:
        start[0] = s.pos[axes[0]]
        start[1] = s.pos[axes[1]]
        start[2] = s.pos[axes[2]]
        inverse_rate(s, b, arc_length(start, &a))
    send_arc(s, &a, end)
    s.comp_x = end[0]
    s.comp_y = end[1]
    s.comp_z = end[2]
    return 0


cdef int check_arc_form(State s, Block* b) except -1:
    """An arc has a radius or a centre."""
    cdef bint centre = (b.words & M_IJK) != 0
    cdef bint radius = has(b, W_R)
    if radius and centre:
        return fail_word(s, "Mixed radius ijk format for arc", W_R)
    if not radius and not centre:
        return fail(s, "R i j k words all missing for arc", b.g_at[G_MOTION_GROUP])
    return 0


cdef int check_arc_words(State s, Block* b) except -1:
    """Which words an arc needs and may not have in its plane."""
    cdef bint radius = has(b, W_R)
    cdef bint ends
    if s.plane == XY:
        if has(b, W_K):
            return fail_word(s, "K word given for arc in xy plane", W_K)
        ends = has(b, W_X) or has(b, W_Y) or (b.words & M_POLAR)
        first, second = W_I, W_J
        missing = "X and y words missing for arc in xy plane"
    elif s.plane == XZ:
        if has(b, W_J):
            return fail_word(s, "J word given for arc in xz plane", W_J)
        ends = (has(b, W_X) and not b.words & M_POLAR) or has(b, W_Z)
        first, second = W_I, W_K
        missing = "X and z words missing for arc in xz plane"
    else:
        if has(b, W_I):
            return fail_word(s, "I word given for arc in yz plane", W_I)
        ends = (has(b, W_Y) and not b.words & M_POLAR) or has(b, W_Z)
        first, second = W_J, W_K
        missing = "Y and z words missing for arc in yz plane"
    if radius:
        if not ends:
            return fail_word(s, missing, W_R)
    elif s.ijk_absolute:
        if not has(b, first):
            return fail(s, f"{chr(65 + first)} word missing in absolute center arc")
        if not has(b, second):
            return fail(s, f"{chr(65 + second)} word missing in absolute center arc")
    return 0


cdef int probe(State s, Block* b, int code) except -1:
    """G38.2 to G38.5: the canon stops at the contact; the next line finds the result in #5061 to #5070"""
    cdef double[9] end
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot probe with cutter radius comp on", b.g_at[G_MOTION_GROUP])
    if s.feed == 0.0:
        return fail(s, "Cannot probe with zero feed rate", b.g_at[G_MOTION_GROUP])
    if s.feed_mode == 950:
        return fail(s, "Cannot probe with feed per rev mode", b.g_at[G_MOTION_GROUP])
    find_end(s, b, end)
    if (code == 382 or code == 384) and straight_length(s.pos, end) == 0.0:
        return fail(s, "Start point too close to probe point", b.g_at[G_MOTION_GROUP])
    s.canon.turn_probe_on()
    s.canon.straight_probe(s.line, end[0], end[1], end[2], end[3], end[4], end[5], end[6], end[7], end[8], code - 382)
    s.canon.turn_probe_off()
    s.motion = code
    s.waiting |= WAIT_PROBE
    return 0


cdef int reference_move(State s, Block* b, int code) except -1:
    """G28, G30: by way of the point that the words name to the stored point"""
    cdef double[9] end
    cdef double[9] home
    cdef double factor
    cdef int k, first = 5161 if code == 280 else 5181
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot use g28 or g30 with cutter radius comp", b.g_at[0])
    find_end(s, b, end)
    traverse(s, end)
    factor = s.canon.get_external_length_units() * (25.4 if s.units == INCHES else 1.0)
    for k in range(9):
        home[k] = s.params[first + k] / (factor if k < 3 or k > 5 else 1.0)
    machine_place(s, home)
    if s.wrapped_rotary:
        for k in range(3, 6):
            unwrap(s, k, home[k], &home[k])
    if b.words & M_AXES:
        for k in range(9):
            if not has(b, axis_words[k]):
                home[k] = s.pos[k]
    return traverse(s, home)


cdef int check_home(State s, Block* b, int code) except -1:
    cdef double p = b.value[W_P]
    if b.words & (M_AXES | M_POLAR):
        return fail(s, "G28.2 takes no axis words: P is the number of a joint", b.g_at[0])
    if not has(b, W_P):
        return fail(s, "G28.2 needs a P word: P0, P1 and so on home one joint, P-1 homes them all", b.g_at[0])
    if p != floor(p) or not ALL_JOINTS <= p <= JOINTS_MAX:
        return fail_word(s, "The P word of G28.2 must be the number of a joint, or P-1 for all joints", W_P)
    return 0


cdef int home(State s, Block* b, int code) except -1:
    """G28.2 P: joints are homed; what follows is read when they are, from where the machine stands then"""
    cdef int joint = <int>b.value[W_P]
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot home with cutter radius compensation on", b.g_at[0])
    if joint == ALL_JOINTS:
        s.canon.home_cycle()
    else:
        s.canon.home_cycle_joint(joint)
    s.must_finish = True
    return 0
