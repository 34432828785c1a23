"""Components between bits and numbers: codes, sums of weights, selectors of any size. See ``declare.py``."""

from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from nml.errors import HalError
from hal.components.declare import (
    BIT, FLOAT, S32, U32, declare, numbers, param_ro, param_rw, pin_in, pin_io, pin_out,
)


# ---- Gray code ----

cdef struct Code:
    hal_pin in_, out

cdef void bin2gray(Code* s, long period) noexcept nogil:
    at(s.out).u = at(s.in_).u ^ (at(s.in_).u >> 1)

cdef void gray2bin(Code* s, long period) noexcept nogil:
    cdef uint32_t code = at(s.in_).u
    cdef int shift = 16
    while shift:
        code ^= code >> shift
        shift >>= 1
    at(s.out).u = code

declare("bin2gray", "Binary number to Gray code", sizeof(Code), [
    pin_in(U32, "in", "binary"), pin_out(U32, "out", "Gray code"),
], {"": <size_t>&bin2gray}, uses_fp=False)
declare("gray2bin", "Gray code to binary number", sizeof(Code), [
    pin_in(U32, "in", "Gray code"), pin_out(U32, "out", "binary"),
], {"": <size_t>&gray2bin}, uses_fp=False)


# ---- one of many outputs ----

cdef struct Demux:
    hal_pin sel_bit[5]
    hal_pin sel_u32
    hal_pin out[32]
    hal_pin bargraph

cdef void demux(Demux* s, long period) noexcept nogil:
    cdef uint32_t number = at(s.sel_u32).u
    cdef uint32_t i, last = 31
    for i in range(5):
        number += <uint32_t>(at(s.sel_bit[i]).b != 0) << i
    while last > 0 and s.out[last] == NULL:
        last -= 1
    number = min(number, last)
    for i in range(last + 1):
        at(s.out[i]).b = i < number if at(s.bargraph).b else i == number

declare("demux", "One of up to 32 outputs, or a bar of them; personality= is how many", sizeof(Demux), [
    pin_in(BIT, "sel-bit-{:02}", "number of the output, in binary", count=5),
    pin_in(U32, "sel-u32", "is added to it; beyond the last output it is the last"),
    pin_out(BIT, "out-{:02}", count=32, personal=lambda p: min(p or 32, 32)),
    param_rw(BIT, "bargraph", "set all outputs below the number instead"),
], {"": <size_t>&demux}, personality=32)


cdef struct Multiswitch:
    hal_pin up, down
    hal_pin bit[32]
    hal_pin top_position, position
    uint8_t old_up, old_down

cdef void multiswitch(Multiswitch* s, long period) noexcept nogil:
    cdef int32_t top = <int32_t>min(at(s.top_position).u, <uint32_t>31)
    cdef int32_t place = at(s.position).s
    cdef int i
    if at(s.up).b and not s.old_up:
        place += 1
    if at(s.down).b and not s.old_down:
        place -= 1
    s.old_up = at(s.up).b
    s.old_down = at(s.down).b
    place = top if place < 0 else 0 if place > top else place
    at(s.position).s = place
    for i in range(32):
        if s.bit[i] != NULL:
            at(s.bit[i]).b = i == place

def positions_of(dict args) -> list:
    """The sizes of ``cfg=``; without it one switch of as many positions as ``personality=`` says."""
    return numbers("multiswitch", args, "cfg") or numbers("multiswitch", args, "personality") or [4]

declare("multiswitch", "Step through the positions of a switch with two buttons; cfg=4,2 makes one of four and one of two",
        sizeof(Multiswitch), [
    pin_in(BIT, "up", "its rising edge goes to the next position, from the last to the first"),
    pin_in(BIT, "down", "its rising edge goes to the position before"),
    pin_out(BIT, "bit-{:02}", "true in this position", count=32, personal=lambda p: min(p, 32)),
    param_rw(U32, "top-position", "the last one", default_of=lambda i, p: p - 1),
    param_rw(S32, "position"),
], {"": <size_t>&multiswitch}, counted_by="cfg", sizes=True, options=("personality",), decode=positions_of)


# ---- sums ----

cdef enum:
    MAX_WEIGHTS = 16

cdef struct WeightedSum:
    hal_pin in_[MAX_WEIGHTS]
    hal_pin weight[MAX_WEIGHTS]
    hal_pin hold, sum, offset

cdef void weighted_sum(WeightedSum* s) noexcept nogil:
    cdef int i
    cdef int32_t total = at(s.offset).s
    if at(s.hold).b:
        return
    for i in range(MAX_WEIGHTS):
        if s.in_[i] != NULL and at(s.in_[i]).b:
            total += at(s.weight[i]).s
    at(s.sum).s = total

cdef void process_wsums(int64_t* all_, long period) noexcept nogil:
    cdef int64_t i
    for i in range(all_[0]):
        weighted_sum(<WeightedSum*><size_t>all_[i + 1])

declare("weighted_sum", "Sum of the weights of the inputs that are true; wsum_sizes=4,2 makes one of four and one of two inputs",
        sizeof(WeightedSum), [
    pin_in(BIT, "bit.{}.in", count=MAX_WEIGHTS, personal=int),
    pin_io(S32, "bit.{}.weight", "2^M at first", default_of=lambda i, p: 1 << i, count=MAX_WEIGHTS, personal=int),
    pin_in(BIT, "hold", "keep the sum as it is"), pin_out(S32, "sum"), pin_io(S32, "offset", "is added to the sum"),
], {}, shared={"process_wsums": <size_t>&process_wsums}, counted_by="wsum_sizes", sizes=True, most=8, instance="wsum.{}",
   shared_prefix="")


cdef struct ScaledSums:
    hal_pin in_[4]
    hal_pin scale[4]
    hal_pin out_s, out_f

cdef void scaled_s32_sums(ScaledSums* s, long period) noexcept nogil:
    cdef int i
    cdef double total = 0.0
    for i in range(4):
        total += at(s.in_[i]).s * at(s.scale[i]).f
    at(s.out_f).f = total
    at(s.out_s).s = <int32_t>max(min(total, 2147483647.0), -2147483648.0)

declare("scaled_s32_sums", "Sum of four whole numbers, each with a scale", sizeof(ScaledSums), [
    pin_in(S32, "in{}", count=4), pin_in(FLOAT, "scale{}", "", 1.0, count=4),
    pin_out(S32, "out-s", "cut to a whole number"), pin_out(FLOAT, "out-f"),
], {"": <size_t>&scaled_s32_sums})


# ---- multiplexer of any type ----

cdef enum:
    MAX_CHOICES = 1024
    MAX_SELECT_BITS = 10

TYPES = {"b": BIT, "f": FLOAT, "s": S32, "u": U32}
LETTERS = "bfsu"

cdef struct MuxGeneric:
    hal_pin suppress_no_input, debounce_us, sel_int
    hal_pin sel_bit[MAX_SELECT_BITS]
    hal_pin out, elapsed, selected
    hal_pin in_[MAX_CHOICES]
    int64_t personality  # as `packed` makes it
    int64_t held_ns
    uint32_t seen

cdef double read_number(hal_pin pin, int letter) noexcept nogil:
    if letter == 0:
        return at(pin).b != 0
    if letter == 1:
        return at(pin).f
    return <double>at(pin).s if letter == 2 else <double>at(pin).u

cdef void write_number(hal_pin pin, int letter, double value) noexcept nogil:
    """As C converts a double; what does not fit is the lowest s32, or the number's low bits."""
    if letter == 0:
        at(pin).b = value != 0.0
    elif letter == 1:
        at(pin).f = value
    elif letter == 2:
        at(pin).s = <int32_t>value if -2147483649.0 < value < 2147483648.0 else -2147483647 - 1
    else:
        at(pin).u = <uint32_t><int64_t>value

cdef void mux_generic(MuxGeneric* s, long period) noexcept nogil:
    cdef int size = s.personality & 0xFFF, i
    cdef uint32_t number = at(s.sel_int).u
    for i in range(MAX_SELECT_BITS):
        if s.sel_bit[i] != NULL and at(s.sel_bit[i]).b:
            number += 1 << i
    if number == 0 and at(s.suppress_no_input).b:
        return
    if number != s.seen:
        s.seen = number
        s.held_ns = 0
    at(s.elapsed).u = <uint32_t>(s.held_ns // 1000)
    if s.held_ns < <int64_t>at(s.debounce_us).u * 1000:
        s.held_ns += period
        return
    number = min(number, <uint32_t>(size - 1))
    at(s.selected).u = number
    write_number(s.out, s.personality >> 14 & 3, read_number(s.in_[number], s.personality >> 12 & 3))

def packed(dict args) -> list:
    """``config=bb4,fu12`` as personalities: number of inputs, type of the inputs, type of the output."""
    found = []
    for word in args.get("config", "").lower().split(","):
        size = word[2:]
        if len(word) < 3 or not set(word[:2]) <= set(LETTERS) or not size.isdecimal() or not 0 < int(size) <= MAX_CHOICES:
            raise HalError(f"mux_generic: config={args.get('config', '')}: two letters of b, f, s, u and a number up to "
                           f"{MAX_CHOICES} would be right, as in bb4,fu12", -22)
        found.append(int(size) | LETTERS.index(word[0]) << 12 | LETTERS.index(word[1]) << 14)
    return found

def select_bits(int personality) -> int:
    """How many bits are made: as many as the inputs fill."""
    return max((personality & 0xFFF).bit_length() - 1, 0)

declare("mux_generic", "One of up to 1024 inputs, of any type; config=bb4,fu12 makes one of four bits, and one of twelve "
        "floats with an output of type u32", sizeof(MuxGeneric), [
    pin_in(BIT, "suppress-no-input", "keep the output while nothing is selected"),
    pin_in(U32, "debounce-us", "how long the choice must hold still, us"), pin_in(U32, "sel-int", "number of the input"),
    pin_in(BIT, "sel-bit-{:02}", "is added to it, in binary", count=MAX_SELECT_BITS, personal=select_bits),
    pin_out(BIT, "out-{type}", type_of=lambda p: TYPES[LETTERS[p >> 14 & 3]]),
    param_ro(U32, "elapsed", "how long the choice has held still, us"), param_ro(U32, "selected", "input that the output follows"),
    pin_in(BIT, "in-{type}-{:02}", count=MAX_CHOICES, personal=lambda p: p & 0xFFF, type_of=lambda p: TYPES[LETTERS[p >> 12 & 3]]),
], {"": <size_t>&mux_generic}, counted_by="config", sizes=True, decode=packed, keep_personality=True, instance="mux-gen.{:02}",
   uses_fp=lambda p: 1 in (p >> 12 & 3, p >> 14 & 3))
