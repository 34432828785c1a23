"""Kinks: where the direction of the path changes, and how a smooth path goes round them."""

from emcmot.tp.model cimport Kink, TpState

cdef enum Side:              # of a place: which limit of the second derivative is asked for
    SIDE_BEFORE = -1
    SIDE_BEHIND = 1

cdef void path_at(const TpState* tp, double way, Side side, double* q, double* dq, double* ddq) noexcept nogil
cdef void add_kink(TpState* tp, const Kink* kink) noexcept nogil
cdef void forget_passed(TpState* tp) noexcept nogil
cdef double next_node(const TpState* tp, double limit) noexcept nogil
cdef double hat_off(double turn, double half, double away) noexcept nogil
cdef void taken(const TpState* tp, double place, double* off) noexcept nogil
cdef double reach_back(const TpState* tp, int count) noexcept nogil
cdef void size_corner(TpState* tp, Kink* corner, double tolerance, double widest) noexcept nogil
