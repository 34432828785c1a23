"""Cutter radius compensation: G40, G41, G42, G41.1, G42.1 and the moves under them.

The tool runs beside the programmed path. A corner is known only when the next move is, so the last move is held back
(``Pending``), and with it every canon call that follows: while compensation is on, the state's canon is a HeldCanon. At an
outside corner the tool turns about the programmed corner in an arc; at an inside corner both moves end where their
parallels meet, and it is an error if the tool cannot get there.

Plane coordinates (u, v) are the plane's first and second axis. ``side`` is +1 with the tool left of the path, -1 right.
"""

from libc.math cimport M_PI, atan2, cos, fabs, floor, hypot, sin, sqrt
from libc.string cimport memcpy

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_PLANE_XY, CANON_PLANE_XZ, CANON_SIDE_LEFT, CANON_SIDE_OFF, CANON_SIDE_RIGHT, CANON_UNITS_INCHES
from rs274ngc.canon cimport Canon
from rs274ngc.held import HeldCanon
from rs274ngc.path cimport Arc, arc_length, inverse_rate, plane_axes, read_arc, straight_length
from rs274ngc.state cimport State, fail, fail_word
from rs274ngc.tools cimport find_tool

cdef int SIDE_OFF = CANON_SIDE_OFF, LEFT = CANON_SIDE_LEFT, RIGHT = CANON_SIDE_RIGHT
cdef int XY = CANON_PLANE_XY, XZ = CANON_PLANE_XZ, INCHES = CANON_UNITS_INCHES
cdef double CORNER_TOLERANCE = 0.05     # radians: flatter corners are no corners
cdef double TINY = 1e-6
cdef double SWEEP_MM = 0.0254, SWEEP_INCHES = 0.001      # radians that a corner may add to an arc before it gouges
cdef str ARC_GOUGES = "Arc move in concave corner cannot be reached by the tool without gouging"

NOSE = {1: (1, -1), 2: (-1, -1), 3: (-1, 1), 4: (1, 1), 5: (1, 0), 6: (0, -1), 7: (-1, 0), 8: (0, 1)}
"""Lathe tools: per orientation, where the programmed point of the tool lies from the centre of its nose: Z, X, in radii."""


cdef enum:
    TRAVERSE = 0
    FEED = 1
    ARC = 2


cdef class Move:
    """A move that may still be shortened."""

    cdef int kind, line, turns
    cdef double[9] end
    cdef double su, sv      # start
    cdef double cu, cv      # centre of an arc
    cdef double full        # angle of an arc before a corner shortened it, radians
    cdef double du, dv      # direction of a line as programmed; 0, 0: not in the plane
    cdef bint entry         # a line that leads to the compensated path: it may end anywhere


cdef class Pending:
    """What is held back: the moves that end at the open corner."""

    cdef object held        # HeldCanon
    cdef list moves
    cdef double nose_u, nose_v
    cdef int u, v, w        # axes

    def __cinit__(self, held, int u, int v, int w, double nose_u, double nose_v):
        self.held = held
        self.moves = []
        self.u, self.v, self.w = u, v, w
        self.nose_u, self.nose_v = nose_u, nose_v

    cdef int add(self, Move move) except -1:
        self.moves.append(move)
        self.held.held.append(("move", (self, move)))
        return 0

    cdef int settle(self, State s, double u, double v, bint checked=True) except -1:
        """The open corner is at (u, v): make everything that was held, if the moves still go forward."""
        cdef Move move
        cdef double after
        for move in self.moves if checked else ():
            if move.kind == ARC:
                after = sweep(move.su - move.cu, move.sv - move.cv, u - move.cu, v - move.cv, move.turns)
                if after > move.full + (SWEEP_INCHES if s.units == INCHES else SWEEP_MM):
                    return fail(s, ARC_GOUGES)
            elif not move.entry and (u - move.su) * move.du + (v - move.sv) * move.dv < 0.0:
                return fail(s, f"Straight {'traverse' if move.kind == TRAVERSE else 'feed'} in concave corner "
                               "cannot be reached by the tool without gouging")
            move.end[self.u], move.end[self.v] = u, v
        self.release()
        return 0

    cdef int release(self) except -1:
        held, self.held.held = self.held.held, []
        self.moves = []
        canon = self.held.canon
        for name, arguments in held:
            if name == "move":
                self.make(canon, arguments[1])
            else:
                getattr(canon, name)(*arguments)
        return 0

    def scale(self, double factor):
        """The unit of length has changed."""
        cdef Move move
        for move in self.moves:
            for k in range(9):
                if k < 3 or k > 5:
                    move.end[k] *= factor
            move.su, move.sv, move.cu, move.cv = move.su * factor, move.sv * factor, move.cu * factor, move.cv * factor
        self.nose_u, self.nose_v = self.nose_u * factor, self.nose_v * factor

    cdef int make(self, Canon canon, Move move) except -1:
        cdef double[9] e
        memcpy(e, move.end, sizeof(e))
        e[self.u] += self.nose_u
        e[self.v] += self.nose_v
        if move.kind == ARC:
            canon.arc_feed(move.line, e[self.u], e[self.v], move.cu + self.nose_u, move.cv + self.nose_v, move.turns, e[self.w],
                           e[3], e[4], e[5], e[6], e[7], e[8])
        elif move.kind == FEED:
            canon.straight_feed(move.line, e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7], e[8])
        else:
            canon.straight_traverse(move.line, e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7], e[8])
        return 0


cdef double sweep(double u0, double v0, double u1, double v1, int turns) noexcept:
    """Angle from one radius to another in the direction of ``turns``, 0 to 2 pi."""
    cdef double angle = atan2(v1, u1) - atan2(v0, u0)
    if turns < 0:
        angle = -angle
    while angle < 0.0:
        angle += 2.0 * M_PI
    return angle


# --- On and off

cdef int set_compensation(State s, Block* b, int code) except -1:
    """G40; G41 and G42 with D, a tool; G41.1 and G42.1 with D, a diameter, and L, an orientation"""
    if code == 400:
        return compensation_off(s)
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot turn cutter radius comp on when on", b.g_at[7])
    if s.plane != XY and s.plane != XZ:
        return fail(s, "Cutter radius compensation allowed only in XY, XZ planes", b.g_at[7])
    if code in (411, 421):
        dynamic_radius(s, b, code)
    else:
        radius_of_tool(s, b, code)
    left = (code in (410, 411)) == (s.comp_radius >= 0.0)
    s.comp_radius = fabs(s.comp_radius)
    s.canon.comment("interpreter: cutter radius compensation on " + ("left" if left else "right"))
    s.comp_side = LEFT if left else RIGHT
    s.comp_first = True
    s.comp_x, s.comp_y, s.comp_z = s.pos[0], s.pos[1], s.pos[2]
    if s.comp_radius == 0.0:
        return 0
    cdef int* axes = plane_axes[s.plane]
    nose = NOSE.get(s.comp_orientation, (0, 0)) if s.plane == XZ else (0, 0)
    held = HeldCanon(s.canon)
    s.comp_queue = Pending(held, axes[0], axes[1], axes[2], nose[0] * s.comp_radius, nose[1] * s.comp_radius)
    s.canon = held
    return 0


cdef int compensation_off(State s) except -1:
    """G40"""
    flush(s)
    s.canon.comment("interpreter: cutter radius compensation off")
    if s.comp_side != SIDE_OFF and s.comp_radius > 0.0:
        s.arc_not_allowed = not s.comp_first
        s.pos[0], s.pos[1], s.pos[2] = s.comp_x, s.comp_y, s.comp_z
    s.comp_side = SIDE_OFF
    return 0


cdef int flush(State s) except -1:
    """Compensation is over, or must be: make all held calls, give the real canon back."""
    cdef Pending pending = s.comp_queue
    if pending is not None:
        pending.settle(s, s.pos[pending.u], s.pos[pending.v])
        s.comp_queue = None
        s.canon = pending.held.canon
    return 0


cdef int drop(State s) except -1:
    """Forget what is held: the program was aborted."""
    cdef Pending pending = s.comp_queue
    if pending is not None:
        s.comp_queue = None
        s.canon = pending.held.canon
    s.comp_side = SIDE_OFF
    return 0


cdef int dynamic_radius(State s, Block* b, int code) except -1:
    if not has(b, W_D):
        return fail(s, f"G{code // 10}.1 with no D word", b.g_at[7])
    if has(b, W_L) and s.plane != XZ:
        return fail_word(s, f"G{code // 10}.1 with L word, but plane is not G18", W_L)
    s.comp_radius = b.value[W_D] / 2.0
    s.comp_orientation = <int>value_or(b, W_L, 0.0)
    return 0


cdef int radius_of_tool(State s, Block* b, int code) except -1:
    cdef int index = 0
    cdef double number = value_or(b, W_D, 0.0)
    if number < 0.0:
        return fail_word(s, "Negative d word tool radius index used", W_D)
    if fabs(number - floor(number + 0.5)) > 0.0001 or number > 2.0e9:
        return fail_word(s, f"G{code // 10} requires D word to be a whole number", W_D)
    if number != 0.0 or (s.random_toolchanger and has(b, W_D)):
        index = find_tool(s, <int>(number + 0.5), b.at[W_D])
    tool = s.canon.get_external_tool_table(index)
    s.comp_radius = tool.diameter / (25.4 if s.units == INCHES else 1.0) / s.canon.get_external_length_units() / 2.0
    s.comp_orientation = tool.orientation
    if s.comp_orientation not in (0, 9) and s.plane != XZ:
        return fail(s, f"G{code // 10} with lathe tool, but plane is not G18", b.g_at[7])
    return 0


# --- Corners

cdef class Corner:
    """Where a move begins: the programmed corner, the tool there, and the new move's offset from the corner."""

    cdef double ou, ov      # programmed corner
    cdef double nu, nv      # offset of the new move there, of the length of the radius
    cdef double beta        # turn: positive outside, negative inside
    cdef double u_turn      # from here on the tool must not go around the corner: half a turn, more or less


cdef Corner corner(State s, Pending p, double ou, double ov, double nu, double nv, double u_turn):
    cdef Corner c = Corner.__new__(Corner)
    cdef double pu = s.pos[p.u] - ou, pv = s.pos[p.v] - ov
    cdef double turn = atan2(pu * nv - pv * nu, pu * nu + pv * nv)
    c.ou, c.ov, c.nu, c.nv, c.u_turn = ou, ov, nu, nv, u_turn
    c.beta = -turn if s.comp_side == LEFT else turn
    if c.beta < -M_PI / 2.0:
        c.beta += 2.0 * M_PI
    return c


cdef bint inside(Corner c) noexcept:
    return c.beta < -CORNER_TOLERANCE or c.beta > c.u_turn


cdef int outside(State s, Pending p, Corner c, int kind) except -1:
    """Turn about the corner in an arc, or at a rapid cut it off in a straight line."""
    cdef Move move = new_move(s, kind)
    move.turns = -1 if s.comp_side == LEFT else 1
    move.cu, move.cv = c.ou, c.ov
    move.su, move.sv = s.pos[p.u], s.pos[p.v]
    memcpy(move.end, s.pos, sizeof(move.end))
    move.end[p.u], move.end[p.v] = c.ou + c.nu, c.ov + c.nv
    s.pos[p.u], s.pos[p.v] = move.end[p.u], move.end[p.v]
    p.add(move)
    return p.release()


cdef Move new_move(State s, int kind):
    cdef Move move = Move.__new__(Move)
    move.kind = kind
    move.line = s.line
    return move


cdef Move planar(Pending p):
    """The pending move in the plane: the first of those that end at the corner."""
    cdef Move move
    for move in p.moves:
        if move.kind == ARC or move.du != 0.0 or move.dv != 0.0:
            return move
    return None


cdef bint line_and_circle(double lu, double lv, double du, double dv, double cu, double cv, double radius, bint leaving, double* u, double* v) noexcept:
    """Where a line through (lu, lv) enters a circle, or leaves it."""
    cdef double length = hypot(du, dv), along, root, height
    du /= length
    dv /= length
    along = (cu - lu) * du + (cv - lv) * dv
    height = hypot(lu + along * du - cu, lv + along * dv - cv)
    if height > radius:
        return False
    root = sqrt(radius * radius - height * height)
    along += root if leaving else -root
    u[0], v[0] = lu + along * du, lv + along * dv
    return True


cdef bint circles(double au, double av, double ar, double bu, double bv, double br, bint left, double* u, double* v) noexcept:
    """Where two circles meet: left or right of the line from the centre of the first to that of the second."""
    cdef double d = hypot(bu - au, bv - av), along, height
    if d > ar + br or d < fabs(ar - br):
        return False
    along = (ar * ar - br * br + d * d) / (2.0 * d)
    height = sqrt(max(ar * ar - along * along, 0.0))
    if not left:
        height = -height
    u[0], v[0] = au + (along * (bu - au) - height * (bv - av)) / d, av + (along * (bv - av) + height * (bu - au)) / d
    return True


cdef bint within(State s, int turns) noexcept:
    """Whether the tool runs inside of an arc, on the side of its centre."""
    return (s.comp_side == LEFT) == (turns > 0)


cdef int meet_line(State s, Pending p, Corner c, double du, double dv) except -1:
    """Inside corner with a line that follows: the pending move ends where the parallels meet."""
    cdef Move last = planar(p)
    cdef double u = s.pos[p.u], v = s.pos[p.v], cross, t, radius
    if last is not None and last.kind == ARC:
        radius = hypot(u - last.cu, v - last.cv)
        if not line_and_circle(c.ou + c.nu, c.ov + c.nv, du, dv, last.cu, last.cv, radius, not within(s, last.turns), &u, &v):
            return fail(s, "Arc to straight motion makes a corner the compensated tool can't fit in without gouging")
    elif last is not None:
        cross = last.du * dv - last.dv * du
        if fabs(cross) < 1e-12:
            return fail(s, "Zero degree inside corner is invalid for cutter compensation")
        t = ((c.ou + c.nu - u) * dv - (c.ov + c.nv - v) * du) / cross
        u, v = u + t * last.du, v + t * last.dv
    p.settle(s, u, v)
    s.pos[p.u], s.pos[p.v] = u, v
    return 0


cdef int meet_arc(State s, Pending p, Corner c, double cu, double cv, double radius, int turns) except -1:
    """Inside corner with an arc that follows: the tool comes to its circle from outside, or from within."""
    cdef Move last = planar(p)
    cdef double u = s.pos[p.u], v = s.pos[p.v], stretch, ru, rv
    cdef bint inner = within(s, turns), left
    if last is not None and last.kind == ARC:
        if hypot(last.cu - cu, last.cv - cv) < TINY:
            return fail(s, "Arc to arc motion is invalid because the arcs have the same center")
        left = inner == (last.turns > 0)
        if not circles(last.cu, last.cv, hypot(u - last.cu, v - last.cv), cu, cv, radius, left, &u, &v):
            return fail(s, "Arc to arc motion makes a corner the compensated tool can't fit in without gouging")
    elif last is not None:
        # Computed with a centre as far from the corner as from the arc's end, then moved to the programmed centre.
        stretch = (radius + (s.comp_radius if inner else -s.comp_radius)) / hypot(cu - c.ou, cv - c.ov)
        ru, rv = c.ou + (cu - c.ou) * stretch, c.ov + (cv - c.ov) * stretch
        if not line_and_circle(u, v, last.du, last.dv, ru, rv, radius, inner, &u, &v):
            return fail(s, ARC_GOUGES)
        u, v = u + cu - ru, v + cv - rv
    p.settle(s, u, v)
    s.pos[p.u], s.pos[p.v] = u, v
    return 0


# --- Moves

cdef double programmed(State s, int axis) noexcept:
    return s.comp_x if axis == 0 else s.comp_y if axis == 1 else s.comp_z


cdef int done(State s, Pending p, Move move, const double* end) except -1:
    """The move is pending; remember the programmed point and where the tool is."""
    p.add(move)
    s.comp_x, s.comp_y, s.comp_z = end[0], end[1], end[2]
    memcpy(s.pos, move.end, sizeof(s.pos))
    s.comp_first = False
    return 0


cdef int compensated_straight(State s, Block* b, int code, const double* end) except -1:
    """G0, G1 with compensation"""
    cdef Pending p = s.comp_queue
    cdef Move move = new_move(s, TRAVERSE if code == 0 else FEED)
    cdef double side = 1.0 if s.comp_side == LEFT else -1.0, r = s.comp_radius
    cdef double ou = programmed(s, p.u), ov = programmed(s, p.v), du, dv, length, alpha, nu, nv
    cdef double[9] start
    cdef Corner c
    cdef Move last
    cdef bint around        # the last move was an arc with the tool outside
    memcpy(start, s.pos, sizeof(start))
    start[0], start[1], start[2] = s.comp_x, s.comp_y, s.comp_z
    memcpy(move.end, end, sizeof(move.end))
    du, dv = end[p.u] - ou, end[p.v] - ov
    length = hypot(du, dv)
    if s.comp_first and length <= r:
        return fail(s, "Length of cutter compensation entry move is not greater than the tool radius")
    if length > 0.0:
        alpha = atan2(dv, du) + side * M_PI / 2.0
        nu, nv = r * cos(alpha), r * sin(alpha)
    if not s.comp_first and length > 0.0:
        last = planar(p)
        around = last is not None and last.kind == ARC and not within(s, last.turns)
        c = corner(s, p, ou, ov, nu, nv, M_PI + (-CORNER_TOLERANCE if around else CORNER_TOLERANCE))
        if inside(c):
            meet_line(s, p, c, du, dv)
        else:
            p.settle(s, s.pos[p.u], s.pos[p.v], c.beta > CORNER_TOLERANCE)
    if code == 10 and s.feed_mode == 930:
        inverse_rate(s, b, straight_length(start, end))
    if length == 0.0:
        move.end[p.u], move.end[p.v] = s.pos[p.u], s.pos[p.v]
        return done(s, p, move, end)
    if not s.comp_first and not inside(c) and c.beta > CORNER_TOLERANCE:
        outside(s, p, c, ARC if code == 10 else TRAVERSE)
    move.du, move.dv = du, dv
    move.entry = s.comp_first
    move.su, move.sv = s.pos[p.u], s.pos[p.v]
    move.end[p.u], move.end[p.v] = end[p.u] + nu, end[p.v] + nv
    return done(s, p, move, end)


cdef int compensated_arc(State s, Block* b, int code, const double* end) except -1:
    """G2, G3 with compensation"""
    cdef Pending p = s.comp_queue
    cdef Move move = new_move(s, ARC)
    cdef Arc a
    cdef double[3] start
    cdef double r = s.comp_radius, toward, length, radius, gamma, t, eu, ev, nu, nv
    cdef double ou = programmed(s, p.u), ov = programmed(s, p.v)
    cdef Corner c
    read_arc(s, b, code, end, &a)
    toward = 1.0 if within(s, a.turns) else -1.0
    radius = hypot(a.centre[0] - a.end[0], a.centre[1] - a.end[1])
    if toward > 0.0 and radius <= r and not s.comp_first:
        return fail(s, "Tool radius not less than arc radius with comp")
    if s.comp_first and (toward > 0.0 and radius <= r or hypot(a.end[0] - ou, a.end[1] - ov) <= r):
        return fail(s, "Radius of cutter compensation entry arc is not greater than the tool radius")
    gamma = atan2(a.centre[1] - a.end[1], a.centre[0] - a.end[0])
    if toward < 0.0:
        gamma = atan2(a.end[1] - a.centre[1], a.end[0] - a.centre[0])
    eu, ev = a.end[0] + r * cos(gamma), a.end[1] + r * sin(gamma)
    memcpy(move.end, end, sizeof(move.end))
    move.turns = a.turns
    move.cu, move.cv = a.centre[0], a.centre[1]
    start[0], start[1], start[2] = ou, ov, programmed(s, p.w)
    if s.comp_first:
        # An arc that starts at the tool and ends beside the programmed end, with the programmed tangent there.
        # Chord, its perpendicular bisector and the line from that end to the programmed centre fix the new centre.
        gamma = atan2(a.centre[1] - ev, a.centre[0] - eu)
        t = cos(atan2(s.pos[p.v] - ev, s.pos[p.u] - eu) - gamma)
        if fabs(t) < 1e-12:
            return fail(s, "Radius of cutter compensation entry arc is not greater than the tool radius")
        t = hypot(s.pos[p.u] - eu, s.pos[p.v] - ev) / 2.0 / t
        move.cu, move.cv = eu + t * cos(gamma), ev + t * sin(gamma)
    else:
        length = hypot(a.centre[0] - ou, a.centre[1] - ov)
        nu, nv = toward * r * (a.centre[0] - ou) / length, toward * r * (a.centre[1] - ov) / length
        c = corner(s, p, ou, ov, nu, nv, M_PI + toward * CORNER_TOLERANCE)
        if inside(c):
            meet_arc(s, p, c, a.centre[0], a.centre[1], radius - toward * r, a.turns)
        else:
            p.settle(s, s.pos[p.u], s.pos[p.v], False)
    if s.feed_mode == 930:
        inverse_rate(s, b, arc_length(start, &a))
    if not s.comp_first and not inside(c) and c.beta > CORNER_TOLERANCE:
        outside(s, p, c, ARC)
    move.su, move.sv = s.pos[p.u], s.pos[p.v]
    move.end[p.u], move.end[p.v] = eu, ev
    if s.comp_first:
        ou, ov = move.su, move.sv
    move.full = sweep(ou - move.cu, ov - move.cv, eu - move.cu, ev - move.cv, move.turns)
    return done(s, p, move, end)
