"""A machine in memory: the canon of programs that are checked, printed or previewed without a machine.

It stands where it was last sent, its probe always finds the target, its tools are those of a tool table file. As in
LinuxCNC's stand-alone interpreter, machine units are inches while programs begin in millimetres.
"""

from libc.math cimport sqrt
from libc.string cimport memcpy

from rs274ngc import nurbs
from rs274ngc.canon import (
    CANON_CLOCKWISE, CANON_CONTINUOUS, CANON_COUNTERCLOCKWISE, CANON_PLANE_XY, CANON_STOPPED, CANON_UNITS_INCHES,
    CANON_UNITS_MM, Tool,
)
from rs274ngc.path cimport plane_axes

cdef double BACK_OFF_INCH = 0.01        # how far short of its target a probing move ends
cdef double MM_PER_INCH = 25.4
cdef double INCHES_PER_MM = 0.03937007874016    # LinuxCNC's figure for its stand-alone machine, so that results agree


cdef class OfflineCanon(Canon):
    """Keeps position, offsets, tools, spindles and modes; prints nothing and waits for nobody."""

    def __init__(self, double length_units=INCHES_PER_MM, double angle_units=1.0, tools=()):
        """``tools``: the entries of the tool table, in its order; units per millimetre and per degree."""
        cdef int k
        self.length_units = length_units
        self.angle_units = angle_units
        self.tools = [Tool()] + list(tools)
        self.axis_mask = 0x3F
        self.units = CANON_UNITS_MM
        self.plane = CANON_PLANE_XY
        self.control_mode = CANON_CONTINUOUS
        self.selected = -1
        self.slot = 1 if tools else -1
        for k in range(8):
            self.turning[k] = CANON_STOPPED

    cdef void move_to(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) noexcept:
        self.pos[0], self.pos[1], self.pos[2] = x, y, z
        self.pos[3], self.pos[4], self.pos[5] = a, b, c
        self.pos[6], self.pos[7], self.pos[8] = u, v, w

    cdef void shift(self, double* offset, double x, double y, double z, double a, double b, double c, double u, double v, double w) noexcept:
        """An offset becomes another: the program coordinates of the place shift with it."""
        cdef double[9] fresh
        cdef int k
        fresh[0], fresh[1], fresh[2] = x, y, z
        fresh[3], fresh[4], fresh[5] = a, b, c
        fresh[6], fresh[7], fresh[8] = u, v, w
        for k in range(9):
            self.pos[k] += offset[k] - fresh[k]
            offset[k] = fresh[k]

    cpdef void set_g5x_offset(self, int index, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.shift(self.g5x, x, y, z, a, b, c, u, v, w)

    cpdef void set_g92_offset(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.shift(self.g92, x, y, z, a, b, c, u, v, w)

    cpdef void use_tool_length_offset(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.shift(self.tool, x, y, z, a, b, c, u, v, w)

    cpdef void set_xy_rotation(self, double theta) except *:
        self.rotation = theta

    cpdef void use_length_units(self, int units) except *:
        cdef int k
        cdef double factor
        if units == self.units:
            return
        factor = 1.0 / MM_PER_INCH if units == CANON_UNITS_INCHES else MM_PER_INCH
        self.units = units
        for k in range(9):
            if k < 3 or k > 5:
                self.pos[k] *= factor
                self.g5x[k] *= factor
                self.g92[k] *= factor
                self.tool[k] *= factor

    cpdef void select_plane(self, int plane) except *:
        self.plane = plane

    cpdef void set_feed_rate(self, double rate) except *:
        self.feed = rate

    cpdef void set_motion_control_mode(self, int mode, double tolerance) except *:
        self.control_mode = mode
        self.tolerance = tolerance

    cpdef void set_naivecam_tolerance(self, double tolerance) except *:
        self.naivecam_tolerance = tolerance

    cpdef void straight_traverse(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.move_to(x, y, z, a, b, c, u, v, w)

    cpdef void straight_feed(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.move_to(x, y, z, a, b, c, u, v, w)

    cpdef void straight_probe(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, int probe_type) except *:
        cdef double dx = x - self.pos[0], dy = y - self.pos[1], dz = z - self.pos[2]
        cdef double length = sqrt(dx * dx + dy * dy + dz * dz), back = BACK_OFF_INCH
        if self.units != CANON_UNITS_INCHES:
            back *= MM_PER_INCH
        self.move_to(x, y, z, a, b, c, u, v, w)
        memcpy(self.probe_pos, self.pos, sizeof(self.pos))
        if length > 0.0:
            self.move_to(x - back * dx / length, y - back * dy / length, z - back * dz / length, a, b, c, u, v, w)

    cpdef void arc_feed(self, int line, double first_end, double second_end, double first_axis, double second_axis, int rotation, double axis_end, double a, double b, double c, double u, double v, double w) except *:
        if self.plane == 1:
            self.move_to(first_end, second_end, axis_end, a, b, c, u, v, w)
        elif self.plane == 2:
            self.move_to(axis_end, first_end, second_end, a, b, c, u, v, w)
        else:
            self.move_to(second_end, axis_end, first_end, a, b, c, u, v, w)

    cpdef void nurbs_feed(self, int line, list control_points, int order) except *:
        self.nurbs_knots_feed(line, control_points, nurbs.knot_vector(len(control_points), order), order)

    cpdef void nurbs_knots_feed(self, int line, list control_points, list knots, int order) except *:
        cdef int* axes = plane_axes[self.plane]
        for first, second in nurbs.points(control_points, order, knots):
            end = [self.pos[0], self.pos[1], self.pos[2]]
            end[axes[0]], end[axes[1]] = first, second
            self.straight_feed(line, end[0], end[1], end[2], self.pos[3], self.pos[4], self.pos[5], self.pos[6], self.pos[7], self.pos[8])

    cpdef void start_spindle_clockwise(self, int spindle, bint wait_for_atspeed) except *:
        self.turning[spindle] = CANON_CLOCKWISE

    cpdef void start_spindle_counterclockwise(self, int spindle, bint wait_for_atspeed) except *:
        self.turning[spindle] = CANON_COUNTERCLOCKWISE

    cpdef void stop_spindle_turning(self, int spindle) except *:
        self.turning[spindle] = CANON_STOPPED

    cpdef void set_spindle_speed(self, int spindle, double speed) except *:
        self.speed[spindle] = speed

    cpdef void select_tool(self, int tool) except *:
        self.selected = self.get_external_tool_index(tool)

    cpdef void change_tool(self) except *:
        self.change_tool_number(self.selected if self.selected > 0 else 0)

    cpdef void change_tool_number(self, int pocket) except *:
        self.slot = pocket
        self.tools[0] = self.tools[pocket] if pocket else Tool(0, -1)

    cpdef void set_tool_table_entry(self, int pocket, int tool, double x, double y, double z, double a, double b, double c, double u, double v, double w, double diameter, double frontangle, double backangle, int orientation) except *:
        offset = (x, y, z, a, b, c, u, v, w)
        self.tools[pocket] = Tool(tool, self.tools[pocket].pocketno, offset, diameter, frontangle, backangle, orientation)

    cpdef void mist_on(self) except *:
        self.mist = True

    cpdef void mist_off(self) except *:
        self.mist = False

    cpdef void flood_on(self) except *:
        self.flood = True

    cpdef void flood_off(self) except *:
        self.flood = False

    cpdef tuple get_external_position(self):
        return tuple([self.pos[k] for k in range(9)])

    cpdef tuple get_external_probe_position(self):
        return tuple([self.probe_pos[k] for k in range(9)])

    cpdef tuple get_external_tool_offset(self):
        return tuple([self.tool[k] for k in range(9)])

    cpdef double get_external_feed_rate(self) except? -1:
        return self.feed

    cpdef double get_external_length_units(self) except? -1:
        return self.length_units

    cpdef double get_external_angle_units(self) except? -1:
        return self.angle_units

    cpdef int get_external_length_unit_type(self) except? -1:
        return self.units

    cpdef int get_external_motion_control_mode(self) except? -1:
        return self.control_mode

    cpdef double get_external_motion_control_tolerance(self) except? -1:
        return self.tolerance

    cpdef double get_external_motion_control_naivecam_tolerance(self) except? -1:
        return self.naivecam_tolerance

    cpdef int get_external_plane(self) except? -1:
        return self.plane

    cpdef int get_external_axis_mask(self) except? -1:
        return self.axis_mask

    cpdef int get_external_spindle(self, int spindle) except? -1:
        return self.turning[spindle]

    cpdef double get_external_speed(self, int spindle) except? -1:
        return self.speed[spindle]

    cpdef int get_external_mist(self) except? -1:
        return self.mist

    cpdef int get_external_flood(self) except? -1:
        return self.flood

    cpdef int get_external_tool_slot(self) except? -1:
        return self.slot

    cpdef int get_external_selected_tool_slot(self) except? -1:
        return self.selected

    cpdef object get_external_tool_table(self, int index):
        return self.tools[index]

    cpdef int get_external_tool_index(self, int tool) except? -1:
        cdef int k
        for k in range(1, len(self.tools)):
            if self.tools[k].toolno == tool:
                return k
        return 0 if tool == 0 else -1

    cpdef int get_external_pockets_max(self) except? -1:
        return <int>len(self.tools)
