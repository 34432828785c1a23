"""Components that calculate numbers from numbers: sums, scales, comparisons, tables. See ``declare.py``."""

from libc.math cimport INFINITY, fabs, sqrt
from libc.stdint cimport int32_t, uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, param_rw, pin_in, pin_io, pin_out


cdef double NOTHING = 1e-6  # closer to zero than this is neither positive nor negative

cdef struct Abs:
    hal_pin in_, out, sign, is_positive, is_negative

cdef void abs_(Abs* s, long period) noexcept nogil:
    cdef double value = at(s.in_).f
    at(s.out).f = fabs(value)
    at(s.sign).b = value < 0.0
    at(s.is_negative).b = value < -NOTHING
    at(s.is_positive).b = value > NOTHING

cdef void abs_s32(Abs* s, long period) noexcept nogil:
    cdef int32_t value = at(s.in_).s
    at(s.out).u = -<uint32_t>value if value < 0 else <uint32_t>value
    at(s.sign).b = at(s.is_negative).b = value < 0
    at(s.is_positive).b = value > 0

for name, type_, code in (("abs", FLOAT, <size_t>&abs_), ("abs_s32", S32, <size_t>&abs_s32)):
    declare(name, "Absolute value and sign", sizeof(Abs), [
        pin_in(type_, "in"), pin_out(type_, "out"), pin_out(BIT, "sign", "true for a negative input"),
        pin_out(BIT, "is-positive"), pin_out(BIT, "is-negative"),
    ], {"": code}, uses_fp=type_ == FLOAT)


cdef struct Sum2:
    hal_pin in0, in1, out, gain0, gain1, offset

cdef void sum2(Sum2* s, long period) noexcept nogil:
    at(s.out).f = at(s.in0).f * at(s.gain0).f + at(s.in1).f * at(s.gain1).f + at(s.offset).f

declare("sum2", "Sum of two inputs, each with a gain, and an offset", sizeof(Sum2), [
    pin_in(FLOAT, "in0"), pin_in(FLOAT, "in1"), pin_out(FLOAT, "out", "in0 * gain0 + in1 * gain1 + offset"),
    param_rw(FLOAT, "gain0", "", 1.0), param_rw(FLOAT, "gain1", "", 1.0), param_rw(FLOAT, "offset"),
], {"": <size_t>&sum2})


cdef struct Mult2:
    hal_pin in0, in1, out

cdef void mult2(Mult2* s, long period) noexcept nogil:
    at(s.out).f = at(s.in0).f * at(s.in1).f

declare("mult2", "Product of two inputs", sizeof(Mult2), [
    pin_in(FLOAT, "in0"), pin_in(FLOAT, "in1"), pin_out(FLOAT, "out"),
], {"": <size_t>&mult2})


cdef struct Div2:
    hal_pin in0, in1, out, deadband

cdef void div2(Div2* s, long period) noexcept nogil:
    cdef double divisor = at(s.in1).f, dead = at(s.deadband).f
    if divisor == 0.0 or -dead < divisor < dead:
        divisor = -dead if divisor < 0.0 else dead
    at(s.out).f = at(s.in0).f / divisor if divisor != 0.0 else 0.0

declare("div2", "Quotient of two inputs", sizeof(Div2), [
    pin_in(FLOAT, "in0"), pin_in(FLOAT, "in1"), pin_out(FLOAT, "out", "in0 / in1"),
    param_rw(FLOAT, "deadband", "the divisor is kept at least this far from zero"),
], {"": <size_t>&div2})


cdef struct Invert:
    hal_pin in_, out, deadband

cdef void invert(Invert* s, long period) noexcept nogil:
    cdef double value = at(s.in_).f
    at(s.out).f = 0.0 if value == 0.0 or fabs(value) < at(s.deadband).f else 1.0 / value

declare("invert", "Reciprocal", sizeof(Invert), [
    pin_in(FLOAT, "in"), pin_out(FLOAT, "out", "1 / in"),
    param_rw(FLOAT, "deadband", "out is 0 for inputs closer to zero than this"),
], {"": <size_t>&invert})


cdef struct Scale:
    hal_pin in_, gain, offset, out

cdef void scale(Scale* s, long period) noexcept nogil:
    at(s.out).f = at(s.in_).f * at(s.gain).f + at(s.offset).f

declare("scale", "Gain and offset", sizeof(Scale), [
    pin_in(FLOAT, "in"), pin_in(FLOAT, "gain"), pin_in(FLOAT, "offset"), pin_out(FLOAT, "out", "in * gain + offset"),
], {"": <size_t>&scale})


cdef struct Offset:
    hal_pin offset, in_, out, fb_in, fb_out

cdef void offset_output(Offset* s, long period) noexcept nogil:
    at(s.out).f = at(s.in_).f + at(s.offset).f

cdef void offset_feedback(Offset* s, long period) noexcept nogil:
    at(s.fb_out).f = at(s.fb_in).f - at(s.offset).f

declare("offset", "Add an offset to a value, and take it from its feedback", sizeof(Offset), [
    pin_in(FLOAT, "offset"), pin_in(FLOAT, "in"), pin_out(FLOAT, "out", "in + offset"),
    pin_in(FLOAT, "fb-in"), pin_out(FLOAT, "fb-out", "fb-in - offset"),
], {"update-output": <size_t>&offset_output, "update-feedback": <size_t>&offset_feedback})


cdef struct Constant:
    hal_pin out, value

cdef void constant(Constant* s, long period) noexcept nogil:
    at(s.out).f = at(s.value).f

declare("constant", "A parameter as a pin", sizeof(Constant), [
    pin_out(FLOAT, "out"), param_rw(FLOAT, "value"),
], {"": <size_t>&constant})


cdef struct Hypot:
    hal_pin in0, in1, in2, out

cdef void hypot3(Hypot* s, long period) noexcept nogil:
    cdef double a = at(s.in0).f, b = at(s.in1).f, c = at(s.in2).f
    at(s.out).f = sqrt(a * a + b * b + c * c)

declare("hypot", "Three-input hypotenuse (Euclidean distance)", sizeof(Hypot), [
    pin_in(FLOAT, "in0"), pin_in(FLOAT, "in1"), pin_in(FLOAT, "in2"),
    pin_out(FLOAT, "out", "sqrt(in0^2 + in1^2 + in2^2)"),
], {"": <size_t>&hypot3})


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


cdef struct Integ:
    hal_pin in_, gain, out, reset, max_, min_

cdef void integ(Integ* s, long period) noexcept nogil:
    cdef double out = at(s.out).f + at(s.in_).f * at(s.gain).f * period * 1e-9
    if at(s.reset).b:
        out = 0.0
    at(s.out).f = min(max(out, at(s.min_).f), at(s.max_).f)

declare("integ", "Integral of the input", sizeof(Integ), [
    pin_in(FLOAT, "in"), pin_in(FLOAT, "gain", "", 1.0), pin_out(FLOAT, "out", "integral of in * gain over time in s"),
    pin_in(BIT, "reset", "out is 0"), pin_in(FLOAT, "max", "", 1e20), pin_in(FLOAT, "min", "", -1e20),
], {"": <size_t>&integ})


cdef struct Minmax:
    hal_pin in_, reset, max_, min_

cdef void minmax(Minmax* s, long period) noexcept nogil:
    cdef double value = at(s.in_).f
    if at(s.reset).b:
        at(s.max_).f = at(s.min_).f = value
    at(s.max_).f = max(at(s.max_).f, value)
    at(s.min_).f = min(at(s.min_).f, value)

declare("minmax", "Smallest and largest value seen", sizeof(Minmax), [
    pin_in(FLOAT, "in"), pin_in(BIT, "reset", "both outputs are the input"), pin_out(FLOAT, "max"), pin_out(FLOAT, "min"),
], {"": <size_t>&minmax})


cdef struct Comp:
    hal_pin in0, in1, out, equal, hyst

cdef void comp(Comp* s, long period) noexcept nogil:
    cdef double difference = at(s.in1).f - at(s.in0).f
    cdef double half = 0.5 * at(s.hyst).f
    at(s.equal).b = fabs(difference) <= half
    if difference > half:
        at(s.out).b = 1
    elif difference < -half or half == 0.0:
        at(s.out).b = 0

declare("comp", "Comparator with hysteresis", sizeof(Comp), [
    pin_in(FLOAT, "in0", "inverting input"), pin_in(FLOAT, "in1", "input"), pin_out(BIT, "out", "in1 is larger than in0"),
    pin_out(BIT, "equal", "the inputs differ by no more than half of hyst"),
    param_rw(FLOAT, "hyst", "distance of the two switching points, around in1 = in0"),
], {"": <size_t>&comp})


cdef struct Wcomp:
    hal_pin in_, min_, max_, out, under, over

cdef void wcomp(Wcomp* s, long period) noexcept nogil:
    cdef double value = at(s.in_).f
    at(s.under).b = value <= at(s.min_).f
    at(s.over).b = value >= at(s.max_).f
    at(s.out).b = not at(s.under).b and not at(s.over).b

declare("wcomp", "Window comparator", sizeof(Wcomp), [
    pin_in(FLOAT, "in"), pin_in(FLOAT, "min"), pin_in(FLOAT, "max"), pin_out(BIT, "out", "in is between min and max"),
    pin_out(BIT, "under", "in is min or less"), pin_out(BIT, "over", "in is max or more"),
], {"": <size_t>&wcomp})


cdef struct Near:
    hal_pin in1, in2, out, scale, difference

cdef void near(Near* s, long period) noexcept nogil:
    cdef double a = at(s.in1).f, b = at(s.in2).f, factor = at(s.scale).f
    cdef double one = a / factor if factor != 0.0 else a
    cdef double other = a * factor
    at(s.out).b = min(one, other) <= b <= max(one, other) or fabs(a - b) <= at(s.difference).f

declare("near", "Whether two values are roughly equal", sizeof(Near), [
    pin_in(FLOAT, "in1"), pin_in(FLOAT, "in2"), pin_out(BIT, "out", "within the factor, or within the difference"),
    param_rw(FLOAT, "scale", "in1/scale <= in2 <= in1*scale", 1.0), param_rw(FLOAT, "difference", "|in1 - in2|"),
], {"": <size_t>&near})


cdef struct Deadzone:
    hal_pin in_, out, center, threshold

cdef void deadzone(Deadzone* s, long period) noexcept nogil:
    cdef double value = at(s.in_).f, middle = at(s.center).f, half = 0.5 * at(s.threshold).f
    if value < middle - half:
        at(s.out).f = value + half
    elif value > middle + half:
        at(s.out).f = value - half
    else:
        at(s.out).f = middle

declare("deadzone", "The centre as long as the input is within a threshold of it", sizeof(Deadzone), [
    pin_in(FLOAT, "in"), pin_out(FLOAT, "out"), param_rw(FLOAT, "center"),
    param_rw(FLOAT, "threshold", "whole width of the dead zone", 1.0),
], {"": <size_t>&deadzone})


cdef struct Blend:
    hal_pin in1, in2, select, out, open

cdef void blend(Blend* s, long period) noexcept nogil:
    cdef double share = at(s.select).f
    if not at(s.open).b:
        share = min(max(share, 0.0), 1.0)
    at(s.out).f = at(s.in1).f * share + at(s.in2).f * (1.0 - share)

declare("blend", "Linear mix of two inputs", sizeof(Blend), [
    pin_in(FLOAT, "in1"), pin_in(FLOAT, "in2"), pin_in(FLOAT, "select", "1: in1, 0: in2, linear between"),
    pin_out(FLOAT, "out"), param_rw(BIT, "open", "let select go beyond 0 and 1"),
], {"": <size_t>&blend})


cdef struct Lincurve:
    hal_pin in_, out, out_io
    hal_pin x_val[16]
    hal_pin y_val[16]

cdef double curve(Lincurve* s, double value) noexcept nogil:
    cdef int i
    cdef double x0, x1, y0, y1
    if value <= at(s.x_val[0]).f:
        return at(s.y_val[0]).f
    for i in range(1, 16):
        if s.x_val[i] == NULL:
            return at(s.y_val[i - 1]).f
        x1 = at(s.x_val[i]).f
        if value < x1:
            x0, y0, y1 = at(s.x_val[i - 1]).f, at(s.y_val[i - 1]).f, at(s.y_val[i]).f
            return y0 + (value - x0) * (y1 - y0) / (x1 - x0)
    return at(s.y_val[15]).f

cdef void lincurve(Lincurve* s, long period) noexcept nogil:
    at(s.out).f = at(s.out_io).f = curve(s, at(s.in_).f)

declare("lincurve", "Straight lines through up to 16 points; personality= is how many", sizeof(Lincurve), [
    pin_in(FLOAT, "in"), pin_out(FLOAT, "out"), pin_io(FLOAT, "out-io", "the same, for I/O pins such as gains"),
    param_rw(FLOAT, "x-val-{:02}", "rising", count=16, personal=lambda p: min(max(p, 2), 16)),
    param_rw(FLOAT, "y-val-{:02}", count=16, personal=lambda p: min(max(p, 2), 16)),
], {"": <size_t>&lincurve}, personality=2)
