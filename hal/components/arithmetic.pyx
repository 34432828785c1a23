"""Components that calculate one number from others. Declared for ``hal.components``; see ``declare.py``."""

from libc.math cimport sqrt

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import FLOAT, declare, pin_in, pin_out


cdef struct Ddt:
    hal_pin in_, out
    double old

cdef void ddt(Ddt* s, long period) noexcept nogil:
    cdef double value = at(s.in_).f
    at(s.out).f = (value - s.old) / (period * 1e-9)
    s.old = value

declare("ddt", "Derivative of the input", sizeof(Ddt), [
    pin_in(FLOAT, "in"), pin_out(FLOAT, "out", "change of the input per second"),
], {"": <size_t>&ddt})


cdef struct Hypot:
    hal_pin in0, in1, in2, out

cdef void hypot3(Hypot* s, long period) noexcept nogil:
    cdef double a = at(s.in0).f, b = at(s.in1).f, c = at(s.in2).f
    at(s.out).f = sqrt(a * a + b * b + c * c)

declare("hypot", "Three-input hypotenuse (Euclidean distance)", sizeof(Hypot), [
    pin_in(FLOAT, "in0"), pin_in(FLOAT, "in1"), pin_in(FLOAT, "in2"),
    pin_out(FLOAT, "out", "sqrt(in0^2 + in1^2 + in2^2)"),
], {"": <size_t>&hypot3})
