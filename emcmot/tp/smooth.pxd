"""The commanded position as an average of planned ones, and what that leaves to the speed along the path."""

from emcmot.tp.model cimport Segment, Span, TpState

cdef double ALONG            # share of an axis's jerk for changes of the speed, where bends are near

cdef void choose_smoothing(TpState* tp, double tolerance) noexcept nogil
cdef double blend_share(const TpState* tp) noexcept nogil
cdef double smoothing_tolerance(const Segment* seg) noexcept nogil
cdef void limit_smooth(const TpState* tp, double tolerance, Span* span) noexcept nogil
cdef void command_planned(TpState* tp) noexcept nogil
cdef void command_smoothed(TpState* tp) noexcept nogil
cdef double bend_speed(const TpState* tp, double tolerance, const double* bend) noexcept nogil
cdef double first_speed(const TpState* tp, const double* rate) noexcept nogil
