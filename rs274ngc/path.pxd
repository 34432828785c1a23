"""C face of the geometry of moves: see path.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

ctypedef struct Arc:
    double[2] centre        # in the order of the plane
    double[2] end
    double axis_end         # along the helix axis
    int turns               # positive: counter-clockwise
    double radius

cdef int[7][3] plane_axes   # per plane: first, second and helix axis, as indices into a position
cdef int[9] axis_words      # the words of the nine axes

cdef int find_end(State s, Block* b, double* end) except -1
cdef int check_polar(State s, const Block* b) except -1
cdef int polar_to_xy(State s, Block* b) except -1
cdef int read_arc(State s, Block* b, int code, const double* end, Arc* a) except -1
cdef int traverse(State s, const double* end) except -1
cdef int feed(State s, const double* end) except -1
cdef int send_arc(State s, const Arc* a, const double* end) except -1
cdef int need_feed(State s, Block* b, str message, str inverse) except -1
cdef double straight_length(const double* start, const double* end) noexcept
cdef double arc_length(const double* start, const Arc* a) noexcept
cdef int inverse_rate(State s, Block* b, double length) except -1
cdef void machine_to_program(State s, double* point) noexcept
cdef void machine_place(State s, double* point) noexcept
cdef int unwrap(State s, int axis, double value, double* end) except -1
