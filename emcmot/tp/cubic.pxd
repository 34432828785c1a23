"""Cubic spans: positions, and their limits of speed, acceleration and jerk."""

from emcmot.tp.model cimport Span, TpState

cdef void cubic_position(const Span* span, double u, double* q) noexcept nogil
cdef void limit_cubic(const TpState* tp, Span* span) noexcept nogil
cdef double corner_speed(const TpState* tp, const double* turn, double half) noexcept nogil
cdef double half_for_speed(const TpState* tp, const double* turn, double speed) noexcept nogil
cdef double first_speed(const TpState* tp, const double* rate) noexcept nogil
