"""Joints that are not axes, in the look-ahead."""

from emcmot.tp.model cimport Segment, Span, TpState

ctypedef struct Curve:       # a segment, the blend between `before` and `seg`, or a cubic span
    const Span* cubic        # NULL: none
    const Segment* before    # NULL: the segment alone
    const Segment* seg
    double trim
    double length

cdef void add_joints(const TpState* tp, const Curve* curve, Span* span) noexcept nogil
