"""What the interpreter knows between two lines: modes, position, offsets, parameters, call levels.

Only data and the few functions that keep it consistent; what a code does with it lives with the code. Lengths are in
program units, angles in degrees, speeds in turns a minute.
"""

from libc.math cimport M_PI, cos, sin
from libc.string cimport memcpy, memset

from nml.errors import InterpError
from rs274ngc.block cimport *
from rs274ngc.canon import CANON_CONTINUOUS, CANON_PLANE_XY, CANON_SIDE_OFF, CANON_STOPPED, CANON_UNITS_INCHES, CANON_UNITS_MM

cdef double DEGREE = M_PI / 180.0
cdef int INCHES = CANON_UNITS_INCHES


cdef class Frame:
    """One level of the program: the main program, or a subroutine that was called."""

    def __cinit__(self):
        self.sub = ""
        self.file = ""
        self.named = {}
        self.labels = {}


cdef class State:
    """The interpreter's memory; one per Interpreter."""

    def __init__(self, Canon canon, ini=None):
        cdef int i
        self.canon = canon
        self.ini = ini
        self.globals = {}
        self.subs = {}
        self.persistent = set()
        self.subroutine_path = []
        self.program_prefix = ""
        self.fanuc_subs = self.g92_persistent = True
        self.spindles = 1
        self.features = 0
        self.arc_tolerance_inch = 0.002 * 2.0**0.5
        self.arc_tolerance_mm = 0.02 * 2.0**0.5
        self.axis_mask = 0x1FF
        self.file = ""
        self.frame = Frame()
        self.frames = [self.frame]
        self.comp_queue = None
        self.remaps = {}
        self.remap_stack = []
        self.selected_index = -1
        for i in range(3):
            self.indexer[i] = -1
        self.set_defaults()

    def set_defaults(self):
        """The modes of a machine that was just switched on."""
        cdef int i
        self.motion = 800
        self.plane = CANON_PLANE_XY
        self.units = CANON_UNITS_MM
        self.feed_mode = 940
        self.control_mode = CANON_CONTINUOUS
        self.incremental = self.ijk_absolute = self.diameter_mode = False
        self.comp_side = CANON_SIDE_OFF
        self.origin_index = 1
        self.feed = 0.0
        self.active_spindle = 0
        self.feed_override = self.feed_hold = True
        self.last_setting = self.last_change = -1
        self.selected_tool = 0
        self.in_cycles = self.g43_active = False
        for i in range(SPINDLES):
            self.turning[i] = CANON_STOPPED
            self.speed[i] = self.css[i] = 0.0
            self.speed_override[i] = True

    @property
    def position(self):
        """Where the tool is: X to W, program units and coordinates."""
        return tuple([self.pos[i] for i in range(9)])

    @property
    def tool_offset(self):
        """Tool offset in force: X to W, program units."""
        return tuple([self.tool[i] for i in range(9)])

    @property
    def machine_position(self):
        """Where the tool is without any offset: X to W, program units."""
        cdef double[9] point
        memcpy(point, self.pos, sizeof(point))
        program_to_machine(self, point)
        return tuple([point[i] for i in range(9)])

    def set_indexer(self, int rotary, int joint):
        """Rotary axis 0 A, 1 B or 2 C is an indexer that ``joint`` locks."""
        self.indexer[rotary] = joint

    def pocket_of(self, int index):
        """Pocket number of a tool-table index; negative indices stand for themselves."""
        if index < 0 or index >= self.canon.get_external_pockets_max():
            return index
        return self.canon.get_external_tool_table(index).pocketno

    def spindle_speed(self, int spindle):
        """Programmed speed of a spindle."""
        return self.speed[spindle]

    def spindle_turning(self, int spindle):
        """CANON_STOPPED, CANON_CLOCKWISE or CANON_COUNTERCLOCKWISE."""
        return self.turning[spindle]

    def surface_speed_mode(self, int spindle):
        """Greatest speed of a spindle with G96, 0 with G97."""
        return self.css[spindle]

    def speed_override_enabled(self, int spindle):
        """M48 or M49, M51."""
        return self.speed_override[spindle]


cdef int fail(State s, str message, int at=-1) except -1:
    """Raise the error of the line in work; ``at`` is the place in the stripped line."""
    s.error_at = at
    raise InterpError(message)


cdef int fail_word(State s, str message, int word) except -1:
    """Raise an error about a word of the line."""
    return fail(s, message, s.block.at[word] if has(&s.block, word) else -1)


cdef void remember_position(State s) noexcept:
    """#5420-#5428 follow the position."""
    cdef int i
    for i in range(9):
        s.params[5420 + i] = s.pos[i]


cdef double unit_factor(State s) noexcept:
    """Millimetres in a program unit."""
    return 25.4 if s.units == INCHES else 1.0


cdef void rotate(double* xy, double degrees) noexcept:
    """Turn a point about Z."""
    cdef double c, n, x = xy[0]
    if degrees != 0.0:
        c = cos(degrees * DEGREE)
        n = sin(degrees * DEGREE)
        xy[0] = x * c - xy[1] * n
        xy[1] = x * n + xy[1] * c


cdef void program_to_machine(State s, double* point) noexcept:
    """A program point in machine coordinates, both in program units."""
    cdef int k
    for k in range(9):
        point[k] += s.g92[k]
    rotate(point, s.rotation)
    for k in range(9):
        point[k] += s.origin[k] + s.tool[k]
