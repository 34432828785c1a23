"""Shared geometry of kinematics; the texts are in ``frames.pyx``."""

cdef extern from *:
    """
    static const double DEGREE = 3.14159265358979323846 / 180.0;
    """
    const double DEGREE      # rad

cdef double nearest_turn(double angle, double to) noexcept nogil
cdef void attitude_matrix(const double* pose, double* r) noexcept nogil
cdef void attitude_of_matrix(const double* r, double* pose) noexcept nogil
cdef void turn_plane(double* u, double* v, double degrees) noexcept nogil
cdef int lower_meeting_point(const double* centres, double radius, double* point) noexcept nogil
