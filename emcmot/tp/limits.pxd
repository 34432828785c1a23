"""What the axis limits allow on one span: the backward step of the speed profile, and accelerations right now."""

from emcmot.tp.model cimport Span

cdef double entry_limit(const Span* span, const double* amax, double cap, double exit_w, int* settled) noexcept nogil
cdef int acceleration_range(
    const Span* span, const double* amax, double u, double w, double* low, double* high) noexcept nogil
cdef double hardest_stop(const Span* span, const double* amax, double u, double w) noexcept nogil
