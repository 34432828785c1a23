"""The geometry of moves: where a line ends, the arc it means, lengths for the feed, and the canon calls that move.

Points are nine coordinates X to W in program units and coordinates. An arc is seen in its plane: first and second axis
and the helix axis, in the cyclic order XY, ZX, YZ.
"""

from libc.math cimport M_PI, atan2, cos, fabs, floor, fmax, hypot, sin, sqrt
from libc.string cimport memcpy

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_PLANE_XY, CANON_PLANE_XZ, CANON_PLANE_YZ, CANON_SIDE_OFF, CANON_UNITS_INCHES
from rs274ngc.state cimport State, fail, fail_word, program_to_machine, rotate

cdef double DEGREE = M_PI / 180.0
cdef double RADIUS_TOLERANCE_INCH = 0.00005, RADIUS_TOLERANCE_MM = 0.00127
cdef double SPIRAL_RELATIVE_TOLERANCE = 0.001
cdef double SPIRAL_LIMIT = 100.0            # times the centre tolerance: never further off than this
cdef double SLOWEST_INVERSE_RATE = 0.1      # units a minute
cdef int INCHES = CANON_UNITS_INCHES, SIDE_OFF = CANON_SIDE_OFF
cdef int XY = CANON_PLANE_XY, XZ = CANON_PLANE_XZ, YZ = CANON_PLANE_YZ
cdef str AXES = "XYZABCUVW"
axis_words[:] = [W_X, W_Y, W_Z, W_A, W_B, W_C, W_U, W_V, W_W]

ORDER = {2: (1, 2, 0), 3: (2, 0, 1), 4: (6, 7, 8), 5: (7, 8, 6), 6: (8, 6, 7)}
"""Per CANON_PLANE_*: first, second and helix axis; XY where none is named."""
cdef int i, j
for i in range(7):
    for j, axis in enumerate(ORDER.get(i, (0, 1, 2))):
        plane_axes[i][j] = axis


# --- Where a line ends

cdef void machine_to_program(State s, double* point) noexcept:
    """A machine point in program coordinates, both in program units."""
    cdef int k
    for k in range(9):
        point[k] -= s.origin[k] + s.tool[k]
    rotate(point, -s.rotation)
    for k in range(9):
        point[k] -= s.g92[k]


cdef int find_end(State s, Block* b, double* end) except -1:
    """The point that the axis words of a line name; what is not named stays."""
    cdef int k
    cdef double value
    memcpy(end, s.pos, sizeof(s.pos))
    if s.comp_side != SIDE_OFF:
        end[0] = s.comp_x
        end[1] = s.comp_y
        end[2] = s.comp_z
    if b.g[0] == 530:
        return find_machine_end(s, b, end)
    if b.words & M_AXES:
        for k in range(9):
            if has(b, axis_words[k]):
                value = b.value[axis_words[k]]
                if k == 0 and s.diameter_mode:
                    value *= 0.5
                end[k] = end[k] + value if s.incremental else value
                if s.wrapped_rotary and not s.incremental:
                    unwrap(s, k, value, &end[k])
    return 0


cdef int check_polar(State s, const Block* b) except -1:
    """``@`` and ``^`` stand for X and Y."""
    if s.plane != XY:
        return fail(s, "Cannot use polar coordinate except in G17 plane")
    if has(b, W_X):
        return fail_word(s, "Cannot specify both polar coordinate and X word", W_X)
    if has(b, W_Y):
        return fail_word(s, "Cannot specify both polar coordinate and Y word", W_Y)
    return 0


cdef int polar_to_xy(State s, Block* b) except -1:
    """``@`` distance from the origin and ``^`` angle become X and Y words, never diameters; either may stay as it is."""
    cdef double x = s.comp_x if s.comp_side != SIDE_OFF else s.pos[0]
    cdef double y = s.comp_y if s.comp_side != SIDE_OFF else s.pos[1]
    cdef double distance = hypot(x, y), angle = atan2(y, x) / DEGREE
    cdef bint at_origin = x == 0.0 and y == 0.0
    if b.g[0] == 530:
        return fail(s, "Cannot use polar coordinates with G53", b.g_at[0])
    if s.incremental and at_origin:
        kind = "Incremental" if has(b, W_AT) else "G91"
        return fail(s, f"{kind} motion with polar coordinates is indeterminate when at the origin")
    if not s.incremental and not has(b, W_CARET) and at_origin:
        return fail(s, "Must specify angle in polar coordinate if at the origin")
    if has(b, W_AT):
        distance = b.value[W_AT] + (distance if s.incremental else 0.0)
    if has(b, W_CARET):
        angle = b.value[W_CARET] + (angle if s.incremental else 0.0)
    b.value[W_X] = distance * cos(angle * DEGREE) - (x if s.incremental else 0.0)
    b.value[W_Y] = distance * sin(angle * DEGREE) - (y if s.incremental else 0.0)
    if s.diameter_mode:
        b.value[W_X] *= 2.0
    b.words |= (1 << W_X) | (1 << W_Y)
    return 0


cdef int unwrap(State s, int axis, double value, double* end) except -1:
    """A wrapped rotary axis turns to 0 <= A < 360, the sign says in which direction."""
    cdef double turn, target
    if not (s.wrapped_rotary >> axis) & 1:
        return 0
    if value >= 360.0 or value <= -360.0:
        return fail(s, f"Invalid absolute position {value:5.2f} for wrapped rotary axis {AXES[axis]}")
    turn = floor(s.pos[axis] / 360.0)
    target = fabs(value) + turn * 360.0
    if value < 0.0 or (value == 0.0 and 1.0 / value < 0.0):
        if target > s.pos[axis]:
            target -= 360.0
    elif target < s.pos[axis]:
        target += 360.0
    end[0] = target
    return 0


cdef int find_machine_end(State s, Block* b, double* end) except -1:
    """G53: the words are machine coordinates; as in LinuxCNC, without the tool offsets of A, B and C."""
    cdef int k
    cdef double value
    program_to_machine(s, end)
    for k in range(9):
        if has(b, axis_words[k]):
            value = b.value[axis_words[k]]
            end[k] = value * 0.5 if k == 0 and s.diameter_mode else value
    machine_to_program(s, end)
    for k in range(3, 6):
        if has(b, axis_words[k]):
            end[k] += s.tool[k]
    return 0


cdef void machine_place(State s, double* point) noexcept:
    """A machine point to go to, in program coordinates; as in LinuxCNC, tool offsets of A, B and C do not count."""
    cdef int k
    machine_to_program(s, point)
    for k in range(3, 6):
        point[k] += s.tool[k]


# --- Lengths and feeds

cdef double straight_length(const double* start, const double* end) noexcept:
    """Length that the feed refers to: of XYZ, else of UVW, else of ABC."""
    cdef double x = end[0] - start[0], y = end[1] - start[1], z = end[2] - start[2]
    if x != 0.0 or y != 0.0 or z != 0.0:
        return sqrt(x * x + y * y + z * z)
    x, y, z = end[6] - start[6], end[7] - start[7], end[8] - start[8]
    if x != 0.0 or y != 0.0 or z != 0.0:
        return sqrt(x * x + y * y + z * z)
    x, y, z = end[3] - start[3], end[4] - start[4], end[5] - start[5]
    return sqrt(x * x + y * y + z * z)


cdef double arc_length(const double* start, const Arc* a) noexcept:
    """Length of a helix; ``start``: its first point in the order of the plane, third the helix axis."""
    cdef double angle, rise = a.axis_end - start[2]
    cdef double first = atan2(start[1] - a.centre[1], start[0] - a.centre[0])
    cdef double last = atan2(a.end[1] - a.centre[1], a.end[0] - a.centre[0])
    cdef double radius = hypot(start[0] - a.centre[0], start[1] - a.centre[1])
    if a.turns < 0:
        angle = first - last
    else:
        angle = last - first
    if angle <= 1e-6:
        angle += 2.0 * M_PI
    angle += (abs(a.turns) - 1) * 2.0 * M_PI
    return hypot(angle * radius, rise)


cdef int inverse_rate(State s, Block* b, double length) except -1:
    """G93: the F word is moves a minute."""
    s.canon.set_feed_rate(fmax(length * b.value[W_F], SLOWEST_INVERSE_RATE))
    return 0


cdef int need_feed(State s, Block* b, str message, str inverse) except -1:
    """A feeding move needs a feed rate; with G93 on its own line."""
    if s.feed_mode == 930:
        if not has(b, W_F):
            return fail(s, inverse)
    elif s.feed == 0.0:
        return fail(s, message)
    return 0


# --- Emission

cdef int traverse(State s, const double* end) except -1:
    """A rapid to ``end``, which becomes the position."""
    s.canon.straight_traverse(s.line, end[0], end[1], end[2], end[3], end[4], end[5], end[6], end[7], end[8])
    memcpy(s.pos, end, sizeof(s.pos))
    return 0


cdef int feed(State s, const double* end) except -1:
    """A feed to ``end``, which becomes the position."""
    s.canon.straight_feed(s.line, end[0], end[1], end[2], end[3], end[4], end[5], end[6], end[7], end[8])
    memcpy(s.pos, end, sizeof(s.pos))
    return 0


cdef int send_arc(State s, const Arc* a, const double* end) except -1:
    """An arc in the active plane to ``end``, which becomes the position."""
    s.canon.arc_feed(s.line, a.end[0], a.end[1], a.centre[0], a.centre[1], a.turns, a.axis_end, end[3], end[4], end[5],
                     end[6], end[7], end[8])
    memcpy(s.pos, end, sizeof(s.pos))
    return 0


# --- Arcs

cdef int read_arc(State s, Block* b, int code, const double* end, Arc* a) except -1:
    """The arc of a G2 or G3 line from the programmed position to ``end``."""
    cdef int* axes = plane_axes[s.plane]
    cdef double[2] start
    cdef double turns = value_or(b, W_P, 1.0)
    start[0] = s.pos[axes[0]]
    start[1] = s.pos[axes[1]]
    if s.comp_side != SIDE_OFF:
        start[0] = programmed(s, axes[0])
        start[1] = programmed(s, axes[1])
    a.end[0] = end[axes[0]]
    a.end[1] = end[axes[1]]
    a.axis_end = end[axes[2]]
    a.turns = <int>floor(turns + 0.5)
    if code == 20:
        a.turns = -a.turns
    if has(b, W_R):
        return arc_by_radius(s, start, b.value[W_R], code, a)
    return arc_by_centre(s, b, start, a, axes)


cdef inline double programmed(State s, int axis) noexcept:
    return s.comp_x if axis == 0 else s.comp_y if axis == 1 else s.comp_z


cdef int arc_by_radius(State s, const double* start, double radius, int code, Arc* a) except -1:
    """R: the smaller of the two arcs, with a negative R the greater."""
    cdef double x = a.end[0] - start[0], y = a.end[1] - start[1]
    cdef double half = hypot(x, y) / 2.0, r = fabs(radius), offset, side
    cdef double tolerance = RADIUS_TOLERANCE_INCH if s.units == INCHES else RADIUS_TOLERANCE_MM
    if a.end[0] == start[0] and a.end[1] == start[1]:
        return fail_word(s, "Current point same as end point of arc", W_R)
    if half - r > tolerance:
        return fail_word(s, "Arc radius too small to reach end point", W_R)
    offset = sqrt(r * r - half * half) if r > half else 0.0
    side = 1.0 if (code == 20) == (radius > 0.0) else -1.0
    a.centre[0] = (start[0] + a.end[0]) / 2.0 + side * offset * y / (2.0 * half)
    a.centre[1] = (start[1] + a.end[1]) / 2.0 - side * offset * x / (2.0 * half)
    a.radius = r
    return 0


cdef int arc_by_centre(State s, Block* b, const double* start, Arc* a, const int* axes) except -1:
    """I, J, K: the centre, from the start or absolute; both radii must be the same within the tolerance."""
    cdef double first = value_or(b, W_I + axes[0], 0.0), second = value_or(b, W_I + axes[1], 0.0)
    cdef double r1, r2, error, relative
    cdef double tolerance = s.arc_tolerance_inch if s.units == INCHES else s.arc_tolerance_mm
    cdef double smallest = RADIUS_TOLERANCE_INCH if s.units == INCHES else RADIUS_TOLERANCE_MM
    if s.ijk_absolute:
        a.centre[0] = first
        a.centre[1] = second
    else:
        a.centre[0] = start[0] + first
        a.centre[1] = start[1] + second
    r1 = hypot(a.centre[0] - start[0], a.centre[1] - start[1])
    r2 = hypot(a.centre[0] - a.end[0], a.centre[1] - a.end[1])
    a.radius = r1
    if r1 < smallest or r2 < smallest:
        return fail(s, "Zero-radius arc: " + arc_text(start, a, axes) + f" r1={r1:.4f} r2={r2:.4f}")
    error = fabs(r1 - r2)
    relative = error / fmax(r1, r2)
    if error > tolerance * SPIRAL_LIMIT or (relative > SPIRAL_RELATIVE_TOLERANCE and error > tolerance):
        return fail(s, "Radius to end of arc differs from radius to start: " + arc_text(start, a, axes)
                    + f" r1={r1:.4f} r2={r2:.4f} abs_err={error:.4g} rel_err={relative * 100:.4f}%")
    return 0


cdef str arc_text(const double* start, const Arc* a, const int* axes):
    cdef str first = AXES[axes[0]], second = AXES[axes[1]]
    return (f"start=({first}{start[0]:.4f},{second}{start[1]:.4f}) "
            f"center=({first}{a.centre[0]:.4f},{second}{a.centre[1]:.4f}) "
            f"end=({first}{a.end[0]:.4f},{second}{a.end[1]:.4f})")
