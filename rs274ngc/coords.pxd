"""C face of the coordinate arithmetic: see coords.pyx."""


cdef class Coordinates:
    cdef readonly double length_units, angle_units
    cdef readonly double length_factor
    cdef readonly double rotation
    cdef readonly int units, g5x_index, plane
    cdef double cos_r, sin_r
    cdef double _g5x[9]
    cdef double _g92[9]
    cdef double _tool[9]
    cdef double _factor[9]
    cpdef void use_length_units(self, int units) except *
    cpdef void set_g5x(self, int index, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *
    cpdef void set_g92(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *
    cpdef void set_tool(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *
    cpdef void set_rotation(self, double degrees) except *
    cpdef tuple to_machine(self, double x, double y, double z, double a, double b, double c, double u, double v, double w)
    cpdef tuple to_program(self, double x, double y, double z, double a, double b, double c, double u, double v, double w)
    cpdef double length(self, double program) noexcept
    cpdef double feed(self, double program, bint angular=*) noexcept
    cpdef tuple direction(self, double x, double y, double z)
    cpdef tuple arc(self, tuple start, double first_end, double second_end, double first_axis, double second_axis,
                    double axis_end, double a, double b, double c, double u, double v, double w)
    cdef void machine_point(self, const double* program, double* machine) noexcept nogil
    cdef void program_point(self, const double* machine, double* program) noexcept nogil
