"""The geometry canon: the moves of a program as numpy arrays, for previews, plots and statistics.

A row per straight move and per chord of an arc. ``end``: X to W of the tool's tip in millimetres and degrees, machine
coordinates (coordinate system, its rotation and G92 applied, tool offset left out). The other columns say what was in force: see
``ROW``. Rows grow in C arrays that double, or are handed on in pieces to ``on_rows``; nothing is kept per line of the program.
"""

import numpy as np

from libc.math cimport M_PI, acos, atan2, ceil, cos, fmax, hypot, sin
from libc.stdlib cimport free, malloc, realloc
from libc.string cimport memcpy

from rs274ngc.canon import CANON_CLOCKWISE, CANON_COUNTERCLOCKWISE, CANON_UNITS_INCHES
from rs274ngc.offline cimport OfflineCanon
from rs274ngc.path cimport plane_axes

RAPID, FEED, ARC, PROBE = range(4)

ROW = np.dtype([
    ("end", "f8", 9),       # mm, degrees
    ("feed", "f8"),         # mm a minute; with G95 mm a turn
    ("speed", "f8"),        # turns a minute of spindle 0; below 0: counter-clockwise, 0: stopped
    ("line", "i4"),         # line of the file
    ("kind", "i4"),         # RAPID, FEED, ARC, PROBE
    ("tool", "i4"),         # number of the tool in the spindle
    ("coolant", "i4"),      # bit 0 mist, bit 1 flood
])
"""The columns of a row."""

cdef int INCHES = CANON_UNITS_INCHES
cdef int CLOCKWISE = CANON_CLOCKWISE, COUNTERCLOCKWISE = CANON_COUNTERCLOCKWISE
cdef double MM_PER_INCH = 25.4
cdef int CHORDS_MAX = 4096      # of one turn


ctypedef struct Row:
    double[9] end
    double feed
    double speed
    int line
    int kind
    int tool
    int coolant


cdef class GeometryCanon(OfflineCanon):
    """Collects the moves of one program."""

    cdef Row* rows
    cdef readonly size_t count
    cdef size_t room
    cdef double chord_error, cosine, sine
    cdef object on_rows
    cdef readonly list tools_used
    cdef readonly double dwell_time     # seconds
    cdef int tool_number

    def __cinit__(self, *args, **machine):
        self.room = 1024
        self.rows = <Row*>malloc(self.room * sizeof(Row))
        if self.rows == NULL:
            raise MemoryError

    def __init__(self, double chord_error=0.01, on_rows=None, size_t piece=1 << 16, **machine):
        """``chord_error``: how far a chord may be from its arc, mm.

        ``on_rows(array of ROW)`` is given every ``piece`` rows, which are forgotten then; the last ones by ``hand_on``.
        """
        OfflineCanon.__init__(self, **machine)
        self.chord_error = chord_error
        self.cosine, self.sine = 1.0, 0.0
        self.on_rows = on_rows
        if on_rows is not None:
            self.reserve(piece)
        self.tools_used = []

    def __dealloc__(self):
        free(self.rows)

    cdef int reserve(self, size_t room) except -1:
        cdef Row* rows = <Row*>realloc(self.rows, room * sizeof(Row))
        if rows == NULL:
            raise MemoryError
        self.rows, self.room = rows, room
        return 0

    cdef int add(self, int line, int kind) except -1:
        """The place where the canon stands now, as the end of a move."""
        cdef Row* row
        cdef int k
        cdef double factor = MM_PER_INCH if self.units == INCHES else 1.0
        cdef double x = self.pos[0] + self.g92[0], y = self.pos[1] + self.g92[1]
        if self.count == self.room:
            if self.on_rows is None:
                self.reserve(2 * self.room)
            else:
                self.hand_on()
        row = &self.rows[self.count]
        row.end[0] = (x * self.cosine - y * self.sine + self.g5x[0]) * factor
        row.end[1] = (x * self.sine + y * self.cosine + self.g5x[1]) * factor
        for k in range(2, 9):
            row.end[k] = (self.pos[k] + self.g92[k] + self.g5x[k]) * (1.0 if 3 <= k <= 5 else factor)
        row.line, row.kind, row.feed = line, kind, self.feed * factor
        row.speed = self.speed[0] if self.turning[0] == CLOCKWISE else -self.speed[0] if self.turning[0] == COUNTERCLOCKWISE else 0.0
        row.tool, row.coolant = self.tool_number, self.mist | self.flood << 1
        self.count += 1
        return 0

    def hand_on(self):
        """Give ``on_rows`` what has gathered."""
        if self.count:
            rows = self.table()
            self.count = 0
            self.on_rows(rows)

    cpdef void set_xy_rotation(self, double theta) except *:
        OfflineCanon.set_xy_rotation(self, theta)
        self.cosine, self.sine = cos(theta * M_PI / 180.0), sin(theta * M_PI / 180.0)

    cpdef void straight_traverse(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.move_to(x, y, z, a, b, c, u, v, w)
        self.add(line, RAPID)

    cpdef void straight_feed(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.move_to(x, y, z, a, b, c, u, v, w)
        self.add(line, FEED)

    cpdef void straight_probe(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, int probe_type) except *:
        OfflineCanon.straight_probe(self, line, x, y, z, a, b, c, u, v, w, probe_type)
        self.add(line, PROBE)

    cpdef void arc_feed(self, int line, double first_end, double second_end, double first_axis, double second_axis, int rotation, double axis_end, double a, double b, double c, double u, double v, double w) except *:
        cdef int* axes = plane_axes[self.plane]
        cdef double[9] start
        cdef double r0, r1, begin, angle, share, radius, height = self.pos[axes[2]]
        cdef double error = self.chord_error / (MM_PER_INCH if self.units == INCHES else 1.0)
        cdef int chords, k, n
        memcpy(start, self.pos, sizeof(start))
        r0 = hypot(start[axes[0]] - first_axis, start[axes[1]] - second_axis)
        r1 = hypot(first_end - first_axis, second_end - second_axis)
        begin = atan2(start[axes[1]] - second_axis, start[axes[0]] - first_axis)
        angle = atan2(second_end - second_axis, first_end - first_axis) - begin
        if rotation > 0:
            while angle <= 1e-9:
                angle += 2.0 * M_PI
            angle += (rotation - 1) * 2.0 * M_PI
        else:
            while angle >= -1e-9:
                angle -= 2.0 * M_PI
            angle += (rotation + 1) * 2.0 * M_PI
        radius = fmax(r0, r1)
        n = 1
        if radius > error:
            n = <int>ceil(min(M_PI / acos(1.0 - error / radius), <double>CHORDS_MAX))
        chords = <int>ceil(max(1.0, n * (angle if angle > 0.0 else -angle) / (2.0 * M_PI)))
        OfflineCanon.arc_feed(self, line, first_end, second_end, first_axis, second_axis, rotation, axis_end, a, b, c, u, v, w)
        cdef double[9] end
        memcpy(end, self.pos, sizeof(end))
        for k in range(1, chords):
            share = <double>k / chords
            for n in range(9):
                self.pos[n] = start[n] + share * (end[n] - start[n])
            radius = r0 + share * (r1 - r0)
            self.pos[axes[0]] = first_axis + radius * cos(begin + share * angle)
            self.pos[axes[1]] = second_axis + radius * sin(begin + share * angle)
            self.add(line, ARC)
        memcpy(self.pos, end, sizeof(end))
        self.add(line, ARC)

    cpdef void dwell(self, double seconds) except *:
        self.dwell_time += seconds

    cpdef void change_tool(self) except *:
        OfflineCanon.change_tool(self)
        self.tools_used.append(self.tool_number)

    cpdef void change_tool_number(self, int pocket) except *:
        OfflineCanon.change_tool_number(self, pocket)
        self.tool_number = self.tools[0].toolno

    def table(self):
        """All rows that are held: an array of ROW; a copy."""
        if self.count == 0:
            return np.empty(0, ROW)
        return np.frombuffer(bytearray((<char*>self.rows)[:self.count * sizeof(Row)]), ROW)

    @property
    def moves(self):
        """Ends of the moves, (n, 9)."""
        return self.table()["end"]

    @property
    def lines(self):
        """Line of the program of each move."""
        return self.table()["line"]

    @property
    def kinds(self):
        """RAPID, FEED, ARC or PROBE of each move."""
        return self.table()["kind"]

    @property
    def feeds(self):
        """Feed in force."""
        return self.table()["feed"]
