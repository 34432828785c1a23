"""Splines in the XY plane: G5 cubic, G5.1 quadratic, G5.2 and G5.3 NURBS.

All of them reach the canon as control points (x, y, weight) of a NURBS with a uniform clamped knot vector.
"""

from libc.string cimport memcpy

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_PLANE_XY, CANON_SIDE_OFF
from rs274ngc.path cimport find_end
from rs274ngc.state cimport State, fail, fail_word

cdef int XY = CANON_PLANE_XY, SIDE_OFF = CANON_SIDE_OFF
cdef int NURBS_ORDER = 3        # without L

cdef enum:
    NOT_XY = (1 << W_Z) | M_ABC | M_UVW


cdef int check_spline(State s, Block* b, double* end, str no_feed="Cannot make arc with zero feed rate") except -1:
    """What every spline needs; ``end``: its end point."""
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot convert spline with cutter radius compensation", b.g_at[1])
    if s.feed == 0.0:
        return fail(s, no_feed, b.g_at[1])
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
    if not has(b, W_P) or not has(b, W_Q):
        return fail(s, "Must specify both P and Q with G5", b.g_at[1])
    if has(b, W_I) != has(b, W_J):
        return fail(s, "Must specify both I and J, or neither", b.g_at[1])
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


cdef int nurbs_point(State s, Block* b, int code) except -1:
    """G5.2 X Y P weight, L order: a control point; the first line may give only the weight of the start"""
    cdef double[9] end
    cdef bint first = s.motion != code
    check_spline(s, b, end, "Cannot make a NURBS with 0 feedrate")
    if first:
        s.nurbs_order = value_or(b, W_L, NURBS_ORDER)
        s.nurbs_points = [(s.pos[0], s.pos[1], value_or(b, W_P, 1.0))]
    elif not has(b, W_P) or b.value[W_P] <= 0.0:
        return fail(s, "Must specify positive weight P for every Control Point", b.g_at[1])
    if has(b, W_X) != has(b, W_Y):
        return fail(s, "You must specify both X and Y coordinates for Control Points", b.g_at[1])
    if has(b, W_X):
        s.nurbs_points.append((end[0], end[1], value_or(b, W_P, 1.0)))
    elif not first:
        return fail_word(s, "Can specify P without X and Y only for the first control point", W_P)
    s.motion = code
    return 0


cdef int nurbs_end(State s, Block* b, int code) except -1:
    """G5.3"""
    cdef double[9] end
    cdef int order = <int>s.nurbs_order
    if s.motion != 52:
        return fail(s, "Cannot use G5.3 without G5.2 first", b.g_at[1])
    if len(s.nurbs_points) < order:
        return fail(s, f"You must specify a number of control points at least equal to the order L = {order}", b.g_at[1])
    memcpy(end, s.pos, sizeof(end))
    last = s.nurbs_points[len(s.nurbs_points) - 1]
    end[0], end[1] = last[0], last[1]
    s.motion = -1
    return send(s, s.nurbs_points, order, end)
