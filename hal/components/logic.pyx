"""Components that combine bits: gates, latches, edges, delays. Declared for ``hal.components``; see ``declare.py``."""

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, declare, pin_in, pin_out


cdef struct And2:
    hal_pin in0, in1, out

cdef void and2(And2* s, long period) noexcept nogil:
    at(s.out).b = at(s.in0).b and at(s.in1).b

declare("and2", "Two-input AND gate", sizeof(And2), [
    pin_in(BIT, "in0"), pin_in(BIT, "in1"), pin_out(BIT, "out", "true when both inputs are"),
], {"": <size_t>&and2}, uses_fp=False)


cdef struct Or2:
    hal_pin in0, in1, out

cdef void or2(Or2* s, long period) noexcept nogil:
    at(s.out).b = at(s.in0).b or at(s.in1).b

declare("or2", "Two-input OR gate", sizeof(Or2), [
    pin_in(BIT, "in0"), pin_in(BIT, "in1"), pin_out(BIT, "out", "true when either input is"),
], {"": <size_t>&or2}, uses_fp=False)


cdef struct Not:
    hal_pin in_, out

cdef void not_(Not* s, long period) noexcept nogil:
    at(s.out).b = not at(s.in_).b

declare("not", "Inverter", sizeof(Not), [
    pin_in(BIT, "in"), pin_out(BIT, "out", "the inverted input"),
], {"": <size_t>&not_}, uses_fp=False)
