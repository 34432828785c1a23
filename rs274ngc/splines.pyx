"""Splines: G5 cubic and G5.1 quadratic in the XY plane; NURBS in the plane in force, G5.2 with G5.3, and G6.2 with knots.

All of them reach the canon as control points (first axis, second axis, weight) of a NURBS in the selected plane, with a
uniform clamped knot vector or, from G6.2, with their own.
"""

from libc.math cimport floor
from libc.string cimport memcpy

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_PLANE_XY, CANON_PLANE_XZ, CANON_PLANE_YZ, CANON_SIDE_OFF
from rs274ngc.path cimport axis_words, find_end, need_feed, plane_axes
from rs274ngc.state cimport State, fail, fail_word

cdef int XY = CANON_PLANE_XY, YZ = CANON_PLANE_YZ, XZ = CANON_PLANE_XZ, SIDE_OFF = CANON_SIDE_OFF
cdef int NURBS_ORDER = 3        # without L
cdef int ORDER_MAX = 20
cdef int POINTS_MAX = 10000     # of one curve

cdef enum:
    NOT_XY = (1 << W_Z) | M_ABC | M_UVW
cdef str NOT_BOTH = "You must specify both X and Y coordinates for Control Points"
PLANE_NAMES = {YZ: "Y and Z coordinates", XZ: "Z and X coordinates"}


cdef int check_spline(State s, Block* b, double* end) except -1:
    """What every spline needs; ``end``: its end point."""
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot convert spline with cutter radius compensation", b.g_at[1])
    if s.feed_mode != 950:
        need_feed(s, b, "Cannot make arc with zero feed rate", "F word missing with inverse time arc move")
    if s.plane != XY:
        return fail(s, "Splines must be in the XY plane", b.g_at[1])
    if b.words & NOT_XY:
        return fail(s, "Splines may not have motion in Z, A, B, or C", b.g_at[1])
    return find_end(s, b, end)


cdef int send(State s, list points, int order, const double* end) except -1:
    """One spline; it ends at ``end`` and leaves the motion mode as it was."""
    s.canon.nurbs_feed(s.line, points, order)
    memcpy(s.pos, end, sizeof(s.pos))
    s.comp_x, s.comp_y = end[0], end[1]
    return 0


cdef int cubic_spline(State s, Block* b, int code) except -1:
    """G5 X Y I J P Q: control points at I J from the start and at P Q from the end"""
    cdef double[9] end
    cdef double x = s.pos[0], y = s.pos[1], i, j
    check_spline(s, b, end)
    if has(b, W_I) != has(b, W_J):
        return fail(s, "Must specify both I and J, or neither", b.g_at[1])
    if not has(b, W_P) or not has(b, W_Q):
        return fail(s, "Must specify both P and Q with G5", b.g_at[1])
    i, j = value_or(b, W_I, s.last_i), value_or(b, W_J, s.last_j)
    s.last_i, s.last_j = -b.value[W_P], -b.value[W_Q]
    points = [(x, y, 1.0), (x + i, y + j, 1.0), (end[0] + b.value[W_P], end[1] + b.value[W_Q], 1.0), (end[0], end[1], 1.0)]
    return send(s, points, 4, end)


cdef int quadratic_spline(State s, Block* b, int code) except -1:
    """G5.1 X Y I J: one control point, at I J from the start"""
    cdef double[9] end
    cdef double x = s.pos[0], y = s.pos[1]
    check_spline(s, b, end)
    if not has(b, W_I) or not has(b, W_J):
        return fail(s, "Must specify both I and J with G5.1", b.g_at[1])
    points = [(x, y, 1.0), (x + b.value[W_I], y + b.value[W_J], 1.0), (end[0], end[1], 1.0)]
    return send(s, points, 3, end)


cdef int nurbs_placed(State s, Block* b) except -1:
    """1: the line of a control point has both axes of the plane, 0: none."""
    cdef int* axes = plane_axes[s.plane]
    cdef bint first = has(b, axis_words[axes[0]]), second = has(b, axis_words[axes[1]])
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot convert spline with cutter radius compensation", b.g_at[1])
    if s.plane not in (XY, YZ, XZ):
        return fail(s, "Splines must be in the XY, YZ or ZX plane", b.g_at[1])
    if first != second:
        return fail(s, NOT_BOTH if s.plane == XY else f"You must specify both {PLANE_NAMES[s.plane]} for Control Points", b.g_at[1])
    return first


cdef int nurbs_place(State s, Block* b, double* end) except -1:
    """What a control point needs besides; ``end``: where it is."""
    cdef int* axes = plane_axes[s.plane]
    if b.words & M_AXES & ~(1 << axis_words[axes[0]] | 1 << axis_words[axes[1]]):
        return fail(s, "Splines may not have motion in Z, A, B, or C" if s.plane == XY else
                       "Splines may not have motion outside their plane", b.g_at[1])
    if s.nurbs_points is not None and len(s.nurbs_points) >= POINTS_MAX:
        return fail(s, "Too many control points", b.g_at[1])
    if s.feed == 0.0 and s.feed_mode == 940:
        return fail(s, "Cannot make a NURBS with 0 feedrate", b.g_at[1])
    return find_end(s, b, end)


cdef int nurbs_point(State s, Block* b, int code) except -1:
    """G5.2 X Y P weight, L order: a control point; the first line may give only the weight of the start"""
    cdef double[9] end
    cdef int* axes = plane_axes[s.plane]
    cdef bint first = s.motion != code, placed = nurbs_placed(s, b)
    if (not first or s.nurbs_active) and value_or(b, W_P, 0.0) <= 0.0:      # also after a curve that was not ended
        return fail(s, "Must specify positive weight P for every Control Point", b.g_at[1])
    if not first and not placed:
        return fail_word(s, "Can specify P without X and Y only for the first control point", W_P)
    nurbs_place(s, b, end)
    if first:
        s.nurbs_order = value_or(b, W_L, NURBS_ORDER)
        s.nurbs_points = [(s.pos[axes[0]], s.pos[axes[1]], value_or(b, W_P, 1.0))]
    if placed:
        s.nurbs_points.append((end[axes[0]], end[axes[1]], value_or(b, W_P, 1.0)))
    s.motion = code
    s.nurbs_active = True
    return 0


cdef int nurbs_end(State s, Block* b, int code) except -1:
    """G5.3"""
    cdef int order = <int>s.nurbs_order
    if s.motion != 52:
        return fail(s, "Cannot use G5.3 without G5.2 first", b.g_at[1])
    if has(b, W_X) != has(b, W_Y) and s.plane == XY:
        return fail(s, NOT_BOTH, b.g_at[1])
    if len(s.nurbs_points) < order:
        return fail(s, f"You must specify a number of control points at least equal to the order L = {order}", b.g_at[1])
    s.canon.nurbs_feed(s.line, s.nurbs_points, order)
    return nurbs_over(s)


cdef int nurbs_over(State s) except -1:
    """The curve was sent: the tool is at its last control point, and no motion is modal."""
    cdef int* axes = plane_axes[s.plane]
    s.pos[axes[0]], s.pos[axes[1]] = s.nurbs_points[len(s.nurbs_points) - 1][:2]
    s.comp_x, s.comp_y, s.comp_z = s.pos[0], s.pos[1], s.pos[2]
    s.motion = -1
    s.nurbs_active = False
    return 0


cdef int nurbs_knot(State s, Block* b, int code) except -1:
    """G6.2 X Y R weight K knot, in the first line P order: a control point and a knot; lines of a knot alone end the curve"""
    cdef double[9] end
    cdef int* axes = plane_axes[s.plane]
    cdef bint placed = nurbs_placed(s, b)
    cdef int order
    nurbs_place(s, b, end)
    if not has(b, W_K):
        return fail(s, "K word (knot) missing with G6.2", b.g_at[1])
    if s.motion != code:
        if not 2.0 <= value_or(b, W_P, 0.0) <= ORDER_MAX or b.value[W_P] != floor(b.value[W_P]):
            return fail(s, f"The first G6.2 needs a P word, the order: a whole number from 2 to {ORDER_MAX}", b.g_at[1])
        if not placed:
            return fail(s, "The first G6.2 needs a control point", b.g_at[1])
        s.nurbs_order, s.nurbs_points, s.nurbs_knots = b.value[W_P], [], []
    order = <int>s.nurbs_order
    if s.nurbs_knots and b.value[W_K] < s.nurbs_knots[len(s.nurbs_knots) - 1]:
        return fail_word(s, "Knots of G6.2 must not decrease", W_K)
    if placed:
        if value_or(b, W_R, 1.0) <= 0.0:
            return fail_word(s, "Must specify positive weight R for every Control Point", W_R)
        if len(s.nurbs_knots) > len(s.nurbs_points):
            return fail(s, "No control point may follow a line of G6.2 with K alone", b.g_at[1])
        s.nurbs_points.append((end[axes[0]], end[axes[1]], value_or(b, W_R, 1.0)))
    s.nurbs_knots.append(b.value[W_K])
    s.motion = code
    s.nurbs_active = True
    if len(s.nurbs_knots) < len(s.nurbs_points) + order:
        return 0
    if len(s.nurbs_points) < order:
        return fail(s, f"G6.2 needs at least as many control points as its order P = {order}", b.g_at[1])
    if s.nurbs_knots[order - 1] == s.nurbs_knots[len(s.nurbs_points)]:
        return fail_word(s, "The knots of G6.2 are all the same", W_K)
    s.canon.nurbs_knots_feed(s.line, s.nurbs_points, s.nurbs_knots, order)
    return nurbs_over(s)
