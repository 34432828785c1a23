"""Multiplexers: one of several inputs, chosen by bits or a number. See ``declare.py``."""

from libc.stdint cimport int32_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, param_ro, pin_in, pin_out

cdef enum:
    MOST = 16


cdef struct Mux:
    hal_pin sel[4]
    hal_pin in_[MOST]
    hal_pin out

cdef int selected(Mux* s) noexcept nogil:
    cdef int i, number = 0
    for i in range(4):
        if s.sel[i] != NULL and at(s.sel[i]).b:
            number |= 1 << i
    return number

cdef void mux(Mux* s, long period) noexcept nogil:
    at(s.out).f = at(s.in_[selected(s)]).f


def declare_mux(int inputs, int bits):
    """`mux2`, `mux4` and `mux8` share a struct; the words that one does not use stay NULL."""
    sel = "sel" if bits == 1 else "sel{}"
    declare(f"mux{inputs}", f"One of {inputs} inputs", sizeof(Mux), [
        pin_in(BIT, sel, "number of the input, in binary", count=4, personal=lambda p: bits),
        pin_in(FLOAT, "in{}", count=MOST, personal=lambda p: inputs), pin_out(FLOAT, "out"),
    ], {"": <size_t>&mux})


declare_mux(2, 1)
declare_mux(4, 2)
declare_mux(8, 3)


cdef struct Mux16:
    hal_pin sel[4]
    hal_pin in_[MOST]
    hal_pin use_graycode, suppress_no_input, debounce_time, out_f, out_s, elapsed, selected
    int32_t seen

cdef int gray_to_binary(int code) noexcept nogil:
    code ^= code >> 2
    return code ^ (code >> 1)

cdef int32_t to_s32(double value) noexcept nogil:
    if value >= 2147483647.0:
        return 2147483647
    return <int32_t>value if value > -2147483648.0 else -2147483647 - 1

cdef void mux16(Mux16* s, long period) noexcept nogil:
    cdef int bits = selected(<Mux*>s)
    cdef int number = gray_to_binary(bits) if at(s.use_graycode).b else bits
    if number != s.seen:
        s.seen = number
        at(s.elapsed).f = 0.0
    elif at(s.elapsed).f < at(s.debounce_time).f:
        at(s.elapsed).f += period * 1e-9
    if at(s.elapsed).f < at(s.debounce_time).f or (at(s.suppress_no_input).b and bits == 0):
        return
    at(s.selected).s = number
    at(s.out_f).f = at(s.in_[number]).f
    at(s.out_s).s = to_s32(at(s.out_f).f)

declare("mux16", "One of 16 inputs, by binary or Gray code", sizeof(Mux16), [
    pin_in(BIT, "sel{}", count=4), pin_in(FLOAT, "in{:02}", count=MOST),
    pin_in(BIT, "use-graycode"), pin_in(BIT, "suppress-no-input", "keep the output while no sel is true"),
    pin_in(FLOAT, "debounce-time", "how long the choice must hold still, s"), pin_out(FLOAT, "out-f"),
    pin_out(S32, "out-s", "the same, cut to a whole number"), param_ro(FLOAT, "elapsed", "time of the choice, s"),
    param_ro(S32, "selected", "input that the output follows"),
], {"": <size_t>&mux16})
