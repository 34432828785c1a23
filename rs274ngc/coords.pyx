"""From program units and program coordinates to machine units and machine coordinates, and back.

Every canon keeps one ``Coordinates`` and passes on to it the calls that set units, origins, rotation and tool offset.
A point goes: program units -> times the unit factor -> plus G92 -> rotated about Z -> plus G5x -> plus tool offset. Units:
lengths in machine units (``lu``: ``length_units`` of them in a millimetre), angles in machine angle units (``angle_units``
of them in a degree). A program's rotary axes are always in degrees.
"""

from libc.math cimport cos, sin

from rs274ngc.canon import CANON_PLANE_XY, CANON_PLANE_XZ, CANON_PLANE_YZ, CANON_UNITS_CM, CANON_UNITS_INCHES, CANON_UNITS_MM

cdef double DEGREE = 0.017453292519943295
MM_PER_UNIT = {CANON_UNITS_INCHES: 25.4, CANON_UNITS_MM: 1.0, CANON_UNITS_CM: 10.0}

ARC_AXES = {CANON_PLANE_XY: (0, 1, 2), CANON_PLANE_YZ: (1, 2, 0), CANON_PLANE_XZ: (2, 0, 1)}
"""Per plane: the axes that ``arc_feed`` calls first and second, and the axis of the helix."""


cdef inline void fill(double* to, double x, double y, double z, double a, double b, double c, double u, double v, double w) noexcept:
    to[0] = x
    to[1] = y
    to[2] = z
    to[3] = a
    to[4] = b
    to[5] = c
    to[6] = u
    to[7] = v
    to[8] = w


cdef inline void scale(double* offset, const double* factor) noexcept:
    cdef int axis
    for axis in range(9):
        offset[axis] *= factor[axis]


cdef class Coordinates:
    """Units, offsets and rotation that are in force, and the arithmetic on them."""

    def __cinit__(self, double length_units=1.0, double angle_units=1.0):
        """``length_units``: machine length units in a millimetre; ``angle_units``: machine angle units in a degree."""
        self.length_units = length_units
        self.angle_units = angle_units
        self.g5x_index = 1
        self.plane = CANON_PLANE_XY
        self.set_rotation(0.0)
        self.use_length_units(CANON_UNITS_MM)

    cpdef void use_length_units(self, int units) except *:
        """Program lengths are in inches, mm or cm from here on (CANON_UNITS_*)."""
        cdef int axis
        self.units = units
        self.length_factor = MM_PER_UNIT[units] * self.length_units
        for axis in range(9):
            self._factor[axis] = self.angle_units if 3 <= axis < 6 else self.length_factor

    def select_plane(self, int plane):
        """Arcs that follow lie in this CANON_PLANE_*."""
        self.plane = plane

    cpdef void set_g5x(self, int index, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        """Origin of coordinate system ``index``, program units."""
        self.g5x_index = index
        fill(self._g5x, x, y, z, a, b, c, u, v, w)
        scale(self._g5x, self._factor)

    cpdef void set_g92(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        """The G92 offset, program units."""
        fill(self._g92, x, y, z, a, b, c, u, v, w)
        scale(self._g92, self._factor)

    cpdef void set_tool(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        """The tool offset, program units."""
        fill(self._tool, x, y, z, a, b, c, u, v, w)
        scale(self._tool, self._factor)

    cpdef void set_rotation(self, double degrees) except *:
        """Rotation about Z, degrees."""
        self.rotation = degrees
        self.cos_r = cos(degrees * DEGREE)
        self.sin_r = sin(degrees * DEGREE)

    @property
    def g5x(self):
        """Origin of the active coordinate system: X to W, machine units."""
        return tuple([self._g5x[i] for i in range(9)])

    @property
    def g92(self):
        """G92 offset: X to W, machine units."""
        return tuple([self._g92[i] for i in range(9)])

    @property
    def tool(self):
        """Tool offset: X to W, machine units."""
        return tuple([self._tool[i] for i in range(9)])

    cdef void machine_point(self, const double* program, double* machine) noexcept nogil:
        cdef double x, y
        cdef int axis
        for axis in range(9):
            machine[axis] = program[axis] * self._factor[axis] + self._g92[axis]
        x = machine[0]
        y = machine[1]
        if self.rotation != 0.0:
            machine[0] = x * self.cos_r - y * self.sin_r
            machine[1] = x * self.sin_r + y * self.cos_r
        for axis in range(9):
            machine[axis] += self._g5x[axis] + self._tool[axis]

    cdef void program_point(self, const double* machine, double* program) noexcept nogil:
        cdef double x, y
        cdef int axis
        for axis in range(9):
            program[axis] = machine[axis] - self._tool[axis] - self._g5x[axis]
        x = program[0]
        y = program[1]
        if self.rotation != 0.0:
            program[0] = x * self.cos_r + y * self.sin_r
            program[1] = y * self.cos_r - x * self.sin_r
        for axis in range(9):
            program[axis] = (program[axis] - self._g92[axis]) / self._factor[axis]

    cpdef tuple to_machine(self, double x, double y, double z, double a, double b, double c, double u, double v, double w):
        """A program point in machine coordinates and units."""
        cdef double program[9]
        cdef double machine[9]
        fill(program, x, y, z, a, b, c, u, v, w)
        self.machine_point(program, machine)
        return (machine[0], machine[1], machine[2], machine[3], machine[4], machine[5], machine[6], machine[7], machine[8])

    cpdef tuple to_program(self, double x, double y, double z, double a, double b, double c, double u, double v, double w):
        """A machine point in the active program coordinates and units."""
        cdef double program[9]
        cdef double machine[9]
        fill(machine, x, y, z, a, b, c, u, v, w)
        self.program_point(machine, program)
        return (program[0], program[1], program[2], program[3], program[4], program[5], program[6], program[7], program[8])

    cpdef double length(self, double program) noexcept:
        """A program length in machine units."""
        return program * self.length_factor

    cpdef double feed(self, double program, bint angular=False) noexcept:
        """A feed in program units (degrees) a minute as machine units (angle units) a second."""
        return program * (self.angle_units if angular else self.length_factor) / 60.0

    cpdef tuple direction(self, double x, double y, double z):
        """A direction of the program (no length, no origin) in machine coordinates."""
        return (x * self.cos_r - y * self.sin_r, x * self.sin_r + y * self.cos_r, z)

    cpdef tuple arc(self, tuple start, double first_end, double second_end, double first_axis, double second_axis,
                    double axis_end, double a, double b, double c, double u, double v, double w):
        """``arc_feed``'s words as (end, centre, normal): end X to W and centre XYZ in machine coordinates, normal a unit vector.

        ``start`` is the program point (X to W) from which the arc begins: the centre lies at its height on the helix axis.
        """
        cdef double end[9]
        cdef double centre[9]
        first, second, third = ARC_AXES[self.plane]
        fill(end, 0, 0, 0, a, b, c, u, v, w)
        fill(centre, 0, 0, 0, a, b, c, u, v, w)
        end[<int>first] = first_end
        end[<int>second] = second_end
        end[<int>third] = axis_end
        centre[<int>first] = first_axis
        centre[<int>second] = second_axis
        centre[<int>third] = start[third]
        normal = [0.0, 0.0, 0.0]
        normal[third] = 1.0
        cdef double machine[9]
        self.machine_point(end, machine)
        ends = tuple([machine[i] for i in range(9)])
        self.machine_point(centre, machine)
        return ends, (machine[0], machine[1], machine[2]), self.direction(normal[0], normal[1], normal[2])
