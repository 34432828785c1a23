"""C face of the offline machine: see offline.pyx."""

from rs274ngc.canon cimport Canon


cdef class OfflineCanon(Canon):
    cdef public double length_units, angle_units
    cdef public int units, plane, control_mode, axis_mask
    cdef public double tolerance, naivecam_tolerance, feed
    cdef public list tools              # Tool by index; 0 is the spindle
    cdef public int selected            # index of the selected tool, -1: none
    cdef public int slot                # index that the tool in the spindle came from
    cdef public bint mist, flood
    cdef double[9] pos                  # program units and coordinates
    cdef double[9] g5x
    cdef double[9] g92
    cdef double[9] tool
    cdef double[9] probe_pos
    cdef double rotation
    cdef int[8] turning
    cdef double[8] speed
    cdef void move_to(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) noexcept
    cdef void shift(self, double* offset, double x, double y, double z, double a, double b, double c, double u, double v, double w) noexcept
