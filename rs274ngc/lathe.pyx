"""The lathe cycles: G70 finishing, G71 and G72 roughing of a profile that a subroutine describes.

The subroutine is read as any other, but its motion lines are collected instead of being executed; ``profile`` has the geometry.
What the tool is to do goes through the handlers of G0 to G3, so feeds, compensation and their errors are those of any line.
"""

from libc.math cimport fabs, floor
from libc.string cimport memset

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_PLANE_XZ, CANON_SIDE_OFF
from rs274ngc.motion cimport arc, straight
from rs274ngc.path cimport Arc, axis_words, find_end, read_arc
from rs274ngc.profile import Arc as RoundPiece
from rs274ngc.profile import Line, ProfileError, Roughing, at_distance, check_monotonic, finishing, frame_of, passes, rounded
from rs274ngc.state cimport State, fail, fail_word

cdef int XZ = CANON_PLANE_XZ, SIDE_OFF = CANON_SIDE_OFF
cdef int PASSES_MAX = 100000

cdef enum:
    X = 0
    Z = 2

POCKETS = {0: "all", 1: "first", 2: "later"}
"""What the digit after the point of G71 and G72 says."""


class Corner:
    """A motion line of the profile: its piece in Z and X, and the fillet or chamfer at its end."""

    def __init__(self, z, x, centre, counterclockwise, radius, chamfer):
        self.z, self.x = z, x
        self.centre = centre                        # Z and X of an arc
        self.counterclockwise = counterclockwise    # seen in the plane of Z and X
        self.radius, self.chamfer = radius, chamfer


cdef class Reader:
    """Follows the subroutine's lines: position and motion mode are its own."""

    cdef State s
    cdef public list corners

    def __init__(self, State s):
        self.s = s
        self.corners = []

    def __call__(self):
        """Take the line that was just understood."""
        cdef State s = self.s
        cdef Block* b = &s.block
        cdef double[9] end
        cdef Arc a
        cdef unsigned int words = b.words
        centre = None
        if not 0 <= b.motion <= 30 or not words & M_AXES:
            return
        b.words &= ~<unsigned int>(M_UVW | M_ABC)
        find_end(s, b, end)
        b.words = words
        end[X] += value_or(b, W_U, 0.0)
        end[Z] += value_or(b, W_W, 0.0)
        if b.motion >= 20:
            if not b.words & (M_IJK | 1 << W_R):
                fail(s, "G7X error: either I or K must be present for arc")
            read_arc(s, b, b.motion, end, &a)
            centre = (a.centre[0], a.centre[1])
        self.corners.append(Corner(
            end[Z], end[X], centre, b.motion == 30, value_or(b, W_A, value_or(b, W_C, 0.0)), has(b, W_C)))
        s.motion = b.motion
        s.pos[X], s.pos[Z] = end[X], end[Z]
        s.comp_x, s.comp_z = end[X], end[Z]


cdef int lathe_cycle(State s, Block* given, int code) except -1:
    """Move to the start, read the profile, cut it"""
    cdef Block b = given[0]
    cdef double q = b.value[W_Q]
    cdef bint incremental = s.incremental, absolute_centres = s.ijk_absolute, diameters = s.diameter_mode
    cdef double[9] start
    if not has(given, W_Q):
        return fail(s, "G7x.x  requires a Q word", b.g_at[1])
    if s.plane != XZ:
        return fail(s, f"G{code // 10}.{code % 10} can only be used in XZ plane (G18)", b.g_at[1])
    if code != 700 and s.comp_side != SIDE_OFF:
        return fail(s, f"G{code // 10}.{code % 10} cannot be used with cutter compensation enabled", b.g_at[1])
    find_end(s, &b, start)
    s.incremental = False
    try:
        b.g[0] = -1
        b.words &= M_AXES
        straight(s, &b, 0)
        b.words = given.words
        if fabs(q - floor(q + 0.5)) > 0.0001:
            return fail_word(s, "Non integer value for integer", W_Q)
        s.incremental = incremental
        corners = read_profile(s, str(int(floor(q + 0.5))))
        s.incremental = s.ijk_absolute = s.diameter_mode = False
        if len(corners) > 1:
            try:
                cut(s, &b, code, complex(start[Z], start[X]), corners)
            except ProfileError as error:
                return fail(s, f"G7X error: {error}", b.g_at[1])
    finally:
        s.incremental, s.ijk_absolute, s.diameter_mode = incremental, absolute_centres, diameters
    return 0


cdef list read_profile(State s, str label):
    """The corners that the subroutine describes; the position is as before."""
    cdef double x = s.pos[X], z = s.pos[Z], comp_x = s.comp_x, comp_z = s.comp_z
    cdef int motion = s.motion
    reader = Reader(s)
    s.motion = 0
    try:
        s.interp.read_subroutine(label, reader)
    finally:
        s.pos[X], s.pos[Z] = x, z
        s.comp_x, s.comp_z = comp_x, comp_z
        s.motion = motion
    return reader.corners


cdef int cut(State s, Block* b, int code, start, corners) except -1:
    """Work out the moves and make them."""
    facing = 720 <= code < 730
    frame = frame_of([(corner.z, corner.x) for corner in corners], facing)
    profile = pieces(frame, corners)
    check_monotonic(profile)
    begin = frame.inward(start.real, start.imag)
    first = profile[0].start
    begin = complex(min(begin.real, first.real), begin.imag)
    side = 1.0 if (profile[0].heading(first).conjugate() * (begin - first)).imag > 0.0 else -1.0
    cdef double remaining = value_or(b, W_D, 0.0), last = value_or(b, W_E, 0.0)
    if code == 700:
        count = value_or(b, W_P, 1.0)
        if count > PASSES_MAX:
            return fail_word(s, "Too many passes in G70", W_P)
        moves = finishing(begin, profile, [side * distance for distance in passes(remaining, last, int(count))])
    else:
        step = value_or(b, W_I, 1.0)
        if step <= 0.0:
            return fail_word(s, "G7X error: I must be greater than zero.", W_I)
        if abs(begin.imag - min(piece.end.imag for piece in profile)) / step > PASSES_MAX:
            return fail_word(s, "Too many passes in G71 or G72", W_I)
        move(s, frame, begin, True, None, False)
        roughing = Roughing(step, value_or(b, W_R, 0.5), POCKETS[code % 10])
        moves = roughing.moves(begin, at_distance(profile, side * remaining))
    for step in moves:
        move(s, frame, step.end, step.rapid, step.centre, step.left)
    return 0


def pieces(frame, corners):
    """The profile in the frame, with its fillets and chamfers."""
    found = []
    here = frame.inward(corners[0].z, corners[0].x)
    radius, chamfer = 0.0, False
    for corner in corners[1:]:
        end = frame.inward(corner.z, corner.x)
        if corner.centre is None:
            piece = Line(here, end)
        else:
            piece = RoundPiece(here, end, frame.inward(*corner.centre), corner.counterclockwise != frame.mirrored)
        if found and radius:
            found[len(found) - 1:] = rounded(found[len(found) - 1], piece, radius, chamfer)
        else:
            found.append(piece)
        radius, chamfer = corner.radius, corner.chamfer
        here = end
    return found


cdef int move(State s, frame, end, bint rapid, centre, bint left) except -1:
    """One line of the cycle, as G0, G1, G2 or G3."""
    cdef Block b
    cdef int code
    memset(&b, 0, sizeof(b))
    memset(b.g, 0xFF, sizeof(b.g))
    b.value[W_Z], b.value[W_X] = frame.outward(end)
    b.words = 1 << W_X | 1 << W_Z
    if centre is None:
        return straight(s, &b, 0 if rapid else 10)
    z, x = frame.outward(centre)
    b.value[W_K], b.value[W_I] = z - (s.comp_z if s.comp_side != SIDE_OFF else s.pos[Z]), x - (s.comp_x if s.comp_side != SIDE_OFF else s.pos[X])
    b.words |= 1 << W_I | 1 << W_K
    code = 30 if left != frame.mirrored else 20
    return arc(s, &b, code)
