"""Components that combine bits without time: gates, latches, selectors. Declared for ``hal.components``; see ``declare.py``."""

from libc.stdint cimport uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, param_rw, pin_in, pin_io, pin_out


cdef struct Gate2:
    hal_pin in0, in1, out

cdef void and2(Gate2* s, long period) noexcept nogil:
    at(s.out).b = at(s.in0).b and at(s.in1).b

cdef void or2(Gate2* s, long period) noexcept nogil:
    at(s.out).b = at(s.in0).b or at(s.in1).b

cdef void xor2(Gate2* s, long period) noexcept nogil:
    at(s.out).b = (at(s.in0).b != 0) != (at(s.in1).b != 0)

declare("and2", "Two-input AND gate", sizeof(Gate2), [
    pin_in(BIT, "in0"), pin_in(BIT, "in1"), pin_out(BIT, "out", "true when both inputs are"),
], {"": <size_t>&and2}, uses_fp=False)
declare("or2", "Two-input OR gate", sizeof(Gate2), [
    pin_in(BIT, "in0"), pin_in(BIT, "in1"), pin_out(BIT, "out", "true when either input is"),
], {"": <size_t>&or2}, uses_fp=False)
declare("xor2", "Two-input exclusive OR gate", sizeof(Gate2), [
    pin_in(BIT, "in0"), pin_in(BIT, "in1"), pin_out(BIT, "out", "true when just one input is"),
], {"": <size_t>&xor2}, uses_fp=False)


cdef struct Not:
    hal_pin in_, out

cdef void not_(Not* s, long period) noexcept nogil:
    at(s.out).b = not at(s.in_).b

declare("not", "Inverter", sizeof(Not), [
    pin_in(BIT, "in"), pin_out(BIT, "out", "the inverted input"),
], {"": <size_t>&not_}, uses_fp=False)


cdef struct Maj3:
    hal_pin in_[3]
    hal_pin out, invert

cdef void maj3(Maj3* s, long period) noexcept nogil:
    cdef int votes = at(s.in_[0]).b + at(s.in_[1]).b + at(s.in_[2]).b
    at(s.out).b = (votes >= 2) != (at(s.invert).b != 0)

declare("maj3", "Majority of three inputs", sizeof(Maj3), [
    pin_in(BIT, "in1"), pin_in(BIT, "in2"), pin_in(BIT, "in3"),
    pin_out(BIT, "out", "true when at least two inputs are"), param_rw(BIT, "invert", "invert the output"),
], {"": <size_t>&maj3}, uses_fp=False)


cdef struct Lut5:
    hal_pin in_[5]
    hal_pin out, function

cdef void lut5(Lut5* s, long period) noexcept nogil:
    cdef int i, row = 0
    for i in range(5):
        row |= (at(s.in_[i]).b != 0) << i
    at(s.out).b = (at(s.function).u >> row) & 1

declare("lut5", "Five-input logic function from a table of 32 bits", sizeof(Lut5), [
    pin_in(BIT, "in-{}", count=5), pin_out(BIT, "out"),
    param_rw(U32, "function", "bit n is the output where the inputs, in-0 lowest, read as the number n"),
], {"": <size_t>&lut5}, uses_fp=False)


cdef struct Logic:
    hal_pin in_[16]
    hal_pin and_, or_, xor, nand, nor

cdef void logic(Logic* s, long period) noexcept nogil:
    cdef int i, count = 0, true_ones = 0
    for i in range(16):
        if s.in_[i] != NULL:
            count += 1
            true_ones += at(s.in_[i]).b != 0
    if s.and_ != NULL:
        at(s.and_).b = true_ones == count
    if s.or_ != NULL:
        at(s.or_).b = true_ones > 0
    if s.xor != NULL:
        at(s.xor).b = true_ones & 1
    if s.nand != NULL:
        at(s.nand).b = true_ones != count
    if s.nor != NULL:
        at(s.nor).b = true_ones == 0

declare("logic", "Logic function of up to 16 inputs; personality= is their number plus the outputs wanted: "
        "0x100 and, 0x200 or, 0x400 xor, 0x800 nand, 0x1000 nor", sizeof(Logic), [
    pin_in(BIT, "in-{:02}", count=16, personal=lambda p: min(p & 0xFF, 16)),
    pin_out(BIT, "and", personal=lambda p: p >> 8 & 1), pin_out(BIT, "or", personal=lambda p: p >> 9 & 1),
    pin_out(BIT, "xor", personal=lambda p: p >> 10 & 1), pin_out(BIT, "nand", personal=lambda p: p >> 11 & 1),
    pin_out(BIT, "nor", personal=lambda p: p >> 12 & 1),
], {"": <size_t>&logic}, uses_fp=False, personality=0)


cdef struct Match8:
    hal_pin in_
    hal_pin a[8]
    hal_pin b[8]
    hal_pin out

cdef void match8(Match8* s, long period) noexcept nogil:
    cdef int i
    cdef bint same = at(s.in_).b != 0
    for i in range(8):
        same = same and (at(s.a[i]).b != 0) == (at(s.b[i]).b != 0)
    at(s.out).b = same

declare("match8", "Eight-bit comparison for equality", sizeof(Match8), [
    pin_in(BIT, "in", "true to compare at all; for joining several", True), pin_in(BIT, "a{}", count=8),
    pin_in(BIT, "b{}", count=8), pin_out(BIT, "out", "true when in is and each a equals its b"),
], {"": <size_t>&match8}, uses_fp=False)


cdef struct Select8:
    hal_pin sel, enable
    hal_pin out[8]

cdef void select8(Select8* s, long period) noexcept nogil:
    cdef int i
    for i in range(8):
        at(s.out[i]).b = at(s.enable).b and at(s.sel).s == i

declare("select8", "One of eight outputs by number", sizeof(Select8), [
    pin_in(S32, "sel", "number of the output to set; none where it is not 0 to 7"),
    pin_in(BIT, "enable", "false clears all outputs", True), pin_out(BIT, "out{}", count=8),
], {"": <size_t>&select8}, uses_fp=False)


cdef struct Flipflop:
    hal_pin data, clk, set_, reset, out, out_not
    uint8_t old

cdef void flipflop(Flipflop* s, long period) noexcept nogil:
    if at(s.reset).b:
        at(s.out).b = 0
    elif at(s.set_).b:
        at(s.out).b = 1
    elif at(s.clk).b and not s.old:
        at(s.out).b = at(s.data).b
    s.old = at(s.clk).b
    at(s.out_not).b = not at(s.out).b

declare("flipflop", "D type flip-flop", sizeof(Flipflop), [
    pin_in(BIT, "data"), pin_in(BIT, "clk", "its rising edge copies data to out"),
    pin_in(BIT, "set", "forces out true"), pin_in(BIT, "reset", "forces out false, whatever set says"),
    pin_io(BIT, "out"), pin_io(BIT, "out-not", "the inverted output"),
], {"": <size_t>&flipflop}, uses_fp=False)


cdef struct Toggle:
    hal_pin in_, out, debounce
    uint32_t held
    uint8_t pressed

cdef void toggle(Toggle* s, long period) noexcept nogil:
    if (at(s.in_).b != 0) == (s.pressed != 0):
        s.held = 0
        return
    s.held += 1
    if s.held < (at(s.debounce).u or 2):
        return
    s.held = 0
    s.pressed = not s.pressed
    if s.pressed:
        at(s.out).b = not at(s.out).b

declare("toggle", "Push-on, push-off from a push button", sizeof(Toggle), [
    pin_in(BIT, "in", "the button"), pin_io(BIT, "out", "changes each time the button is pressed"),
    param_rw(U32, "debounce", "periods that the button must hold still; 0 is 2", 2),
], {"": <size_t>&toggle}, uses_fp=False)


cdef struct Toggle2nist:
    hal_pin in_, is_on, on, off
    uint8_t old_in, waiting

cdef void toggle2nist(Toggle2nist* s, long period) noexcept nogil:
    cdef bint is_on = at(s.is_on).b != 0
    if at(s.in_).b and not s.old_in and not at(s.on).b and not at(s.off).b:
        at(s.on).b = not is_on
        at(s.off).b = is_on
    s.old_in = at(s.in_).b
    if is_on:
        at(s.on).b = 0
    else:
        at(s.off).b = 0

declare("toggle2nist", "On and off requests from a push button, for a device that reports its state", sizeof(Toggle2nist), [
    pin_in(BIT, "in", "the button"), pin_in(BIT, "is-on", "state of the device"),
    pin_out(BIT, "on", "asked to go on, until is-on is true"), pin_out(BIT, "off", "asked to go off, until is-on is false"),
], {"": <size_t>&toggle2nist}, uses_fp=False)


cdef struct EstopLatch:
    hal_pin ok_in, fault_in, reset, ok_out, fault_out, watchdog
    uint8_t old_reset, okay

cdef void estop_latch(EstopLatch* s, long period) noexcept nogil:
    cdef bint healthy = at(s.ok_in).b and not at(s.fault_in).b
    if not healthy:
        s.okay = 0
    elif at(s.reset).b and not s.old_reset:
        s.okay = 1
    s.old_reset = at(s.reset).b
    at(s.ok_out).b = s.okay
    at(s.fault_out).b = not s.okay
    if s.okay:
        at(s.watchdog).b = not at(s.watchdog).b

declare("estop_latch", "Emergency stop latch: faulted until reset rises while nothing is wrong", sizeof(EstopLatch), [
    pin_in(BIT, "ok-in", "false is a fault", True), pin_in(BIT, "fault-in", "true is a fault"),
    pin_in(BIT, "reset", "its rising edge clears the latch"), pin_out(BIT, "ok-out"),
    pin_out(BIT, "fault-out", "the opposite of ok-out", True), pin_out(BIT, "watchdog", "toggles while all is well"),
], {"": <size_t>&estop_latch}, uses_fp=False)


cdef struct Tristate:
    hal_pin in_, out, enable

cdef void tristate(Tristate* s, long period) noexcept nogil:
    if at(s.enable).b:
        at(s.out)[0] = at(s.in_)[0]

for name, type_ in (("tristate_bit", BIT), ("tristate_float", FLOAT)):
    declare(name, "Copy the input to the I/O pin only while enabled", sizeof(Tristate), [
        pin_in(type_, "in"), pin_io(type_, "out"), pin_in(BIT, "enable", "copy in to out"),
    ], {"": <size_t>&tristate}, uses_fp=type_ == FLOAT)


cdef struct Bitslice:
    hal_pin in_
    hal_pin out[32]

cdef void bitslice(Bitslice* s, long period) noexcept nogil:
    cdef int i
    for i in range(32):
        if s.out[i] != NULL:
            at(s.out[i]).b = (at(s.in_).u >> i) & 1

declare("bitslice", "The bits of a number; personality= is how many", sizeof(Bitslice), [
    pin_in(U32, "in"), pin_out(BIT, "out-{:02}", count=32, personal=lambda p: min(p or 16, 32)),
], {"": <size_t>&bitslice}, uses_fp=False, personality=16)


cdef struct Bitwise:
    hal_pin in0, in1, out_and, out_or, out_xor, out_nand, out_nor, out_xnor

cdef void bitwise(Bitwise* s, long period) noexcept nogil:
    cdef uint32_t a = at(s.in0).u, b = at(s.in1).u
    at(s.out_and).u = a & b
    at(s.out_or).u = a | b
    at(s.out_xor).u = a ^ b
    at(s.out_nand).u = ~(a & b)
    at(s.out_nor).u = ~(a | b)
    at(s.out_xnor).u = ~(a ^ b)

declare("bitwise", "Logic of two numbers, bit by bit", sizeof(Bitwise), [
    pin_in(U32, "in0"), pin_in(U32, "in1"), pin_out(U32, "out-and"), pin_out(U32, "out-or"), pin_out(U32, "out-xor"),
    pin_out(U32, "out-nand"), pin_out(U32, "out-nor"), pin_out(U32, "out-xnor"),
], {"": <size_t>&bitwise}, uses_fp=False)
