"""Components in which time or counting matters to bits: edges, delays, debouncing, counters. See ``declare.py``."""

from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, param_ro, param_rw, pin_in, pin_out


cdef struct Edge:
    hal_pin in_, out, out_invert, both, in_edge, out_width_ns, time_left_ns, last_in
    uint8_t started

cdef void edge(Edge* s, long period) noexcept nogil:
    cdef bint now = at(s.in_).b != 0
    cdef bint before = at(s.last_in).b != 0
    cdef bint falling = at(s.in_edge).b != 0
    if s.started and now != before and (at(s.both).b or now != falling):
        at(s.time_left_ns).s = at(s.out_width_ns).s
        at(s.out).b = 1
    elif at(s.time_left_ns).s > 0:
        at(s.time_left_ns).s -= <int32_t>min(period, at(s.time_left_ns).s)
        at(s.out).b = at(s.time_left_ns).s > 0
    else:
        at(s.out).b = 0
    s.started = 1
    at(s.out_invert).b = not at(s.out).b
    at(s.last_in).b = now

declare("edge", "Edge detector", sizeof(Edge), [
    pin_in(BIT, "in"), pin_out(BIT, "out", "true when the edge is seen"), pin_out(BIT, "out-invert", "the inverted output"),
    param_rw(BIT, "both", "both edges"), param_rw(BIT, "in-edge", "true for the falling edge, false for the rising", True),
    param_rw(S32, "out-width-ns", "length of the pulse"), param_ro(S32, "time-left-ns", "time left in this pulse"),
    param_ro(BIT, "last-in", "the input of the last period"),
], {"": <size_t>&edge}, uses_fp=False)


cdef struct Oneshot:
    hal_pin in_, reset, out, out_not, width, time_left, retriggerable, rising, falling
    uint8_t old

cdef void oneshot(Oneshot* s, long period) noexcept nogil:
    cdef bint now = at(s.in_).b != 0
    cdef bint fired = at(s.rising).b and now and not s.old or at(s.falling).b and not now and s.old
    if at(s.reset).b:
        at(s.time_left).f = 0.0
    elif fired and (at(s.retriggerable).b or at(s.time_left).f <= 0.0):
        at(s.time_left).f = at(s.width).f
    elif at(s.time_left).f > 0.0:
        at(s.time_left).f = max(0.0, at(s.time_left).f - period * 1e-9)
    s.old = now
    at(s.out).b = at(s.time_left).f > 0.0
    at(s.out_not).b = not at(s.out).b

declare("oneshot", "One pulse for each edge", sizeof(Oneshot), [
    pin_in(BIT, "in", "trigger"), pin_in(BIT, "reset", "end the pulse"), pin_out(BIT, "out"),
    pin_out(BIT, "out-not", "the inverted output"), pin_in(FLOAT, "width", "s"), pin_out(FLOAT, "time-left", "s"),
    param_rw(BIT, "retriggerable", "another edge makes the pulse longer", True),
    param_rw(BIT, "rising", "trigger on the rising edge", True), param_rw(BIT, "falling", "trigger on the falling edge"),
], {"": <size_t>&oneshot})


cdef struct Timedelay:
    hal_pin in_, out, on_delay, off_delay, elapsed
    double timer

cdef void timedelay(Timedelay* s, long period) noexcept nogil:
    cdef bint wanted = at(s.in_).b != 0
    if wanted == (at(s.out).b != 0):
        s.timer = 0.0
        return
    s.timer += period * 1e-9
    at(s.elapsed).f = s.timer
    if s.timer >= (at(s.on_delay).f if wanted else at(s.off_delay).f):
        at(s.out).b = wanted
        s.timer = 0.0

declare("timedelay", "Delay of both edges: out follows in that has held for the delay", sizeof(Timedelay), [
    pin_in(BIT, "in"), pin_out(BIT, "out"), pin_in(FLOAT, "on-delay", "s", 0.5), pin_in(FLOAT, "off-delay", "s", 0.5),
    pin_out(FLOAT, "elapsed", "time that in and out have differed, now or the last time, s"),
], {"": <size_t>&timedelay})


cdef struct Timer:
    hal_pin in_, q, pt, et
    uint8_t old

cdef void ton(Timer* s, long period) noexcept nogil:
    at(s.et).f = min(at(s.et).f + period * 1e-9, at(s.pt).f) if at(s.in_).b else 0.0
    at(s.q).b = at(s.in_).b and at(s.et).f >= at(s.pt).f

cdef void tof(Timer* s, long period) noexcept nogil:
    if at(s.in_).b:
        at(s.et).f = 0.0
        at(s.q).b = 1
    elif at(s.q).b:
        at(s.et).f = min(at(s.et).f + period * 1e-9, at(s.pt).f)
        at(s.q).b = at(s.et).f < at(s.pt).f

cdef void tp(Timer* s, long period) noexcept nogil:
    cdef bint now = at(s.in_).b != 0
    if at(s.q).b:
        at(s.et).f = min(at(s.et).f + period * 1e-9, at(s.pt).f)
        at(s.q).b = at(s.et).f < at(s.pt).f
    elif now and not s.old:
        at(s.et).f = 0.0
        at(s.q).b = at(s.pt).f > 0.0
    elif not now:
        at(s.et).f = 0.0
    s.old = now

for name, doc, code in (("ton", "IEC timer: delay of the rising edge", <size_t>&ton),
                        ("tof", "IEC timer: delay of the falling edge", <size_t>&tof),
                        ("tp", "IEC timer: a pulse of fixed length from the rising edge", <size_t>&tp)):
    declare(name, doc, sizeof(Timer), [
        pin_in(BIT, "in"), pin_out(BIT, "q"), param_rw(FLOAT, "pt", "preset time, s"), pin_out(FLOAT, "et", "elapsed time, s"),
    ], {"": code})


cdef struct Dbounce:
    hal_pin in_, out, delay
    int32_t count

cdef void filter_bit(hal_pin in_, hal_pin out, int32_t* count, int32_t delay) noexcept nogil:
    """Count the samples that agree; the output follows when `delay` of them were true, or none are left."""
    if at(in_).b:
        count[0] = min(count[0] + 1, delay)
        if count[0] >= delay:
            at(out).b = 1
    else:
        count[0] = max(count[0] - 1, 0)
        if count[0] == 0:
            at(out).b = 0

cdef void dbounce(Dbounce* s, long period) noexcept nogil:
    filter_bit(s.in_, s.out, &s.count, <int32_t>max(at(s.delay).u, <uint32_t>1))

declare("dbounce", "Filter for a noisy input", sizeof(Dbounce), [
    pin_in(BIT, "in"), pin_out(BIT, "out"), pin_in(U32, "delay", "periods that the input must hold still", 5),
], {"": <size_t>&dbounce}, uses_fp=False)


cdef enum:
    MAX_FILTERS = 64

cdef struct Debounce:
    hal_pin delay
    hal_pin in_[MAX_FILTERS]
    hal_pin out[MAX_FILTERS]
    int32_t count[MAX_FILTERS]

cdef void debounce(Debounce* s, long period) noexcept nogil:
    """A delay of N needs N + 1 samples, as the stock component's code has it (its manual says N)."""
    cdef int i
    cdef int32_t delay = max(at(s.delay).s, 0)
    for i in range(MAX_FILTERS):
        if s.in_[i] == NULL:
            return
        filter_bit(s.in_[i], s.out[i], &s.count[i], delay + 1)

declare("debounce", "Groups of filters for noisy inputs; cfg=4,2 makes a group of four and one of two", sizeof(Debounce), [
    param_rw(S32, "delay", "samples that an input must hold still", 5),
    pin_in(BIT, "{}.in", count=MAX_FILTERS, personal=int), pin_out(BIT, "{}.out", count=MAX_FILTERS, personal=int),
], {"": <size_t>&debounce}, uses_fp=False, counted_by="cfg", sizes=True)


cdef struct Updown:
    hal_pin countup, countdown, reset, count, clamp, wrap, max_, min_
    uint8_t old_up, old_down, old_reset

cdef void updown(Updown* s, long period) noexcept nogil:
    cdef int64_t count = at(s.count).s
    cdef int32_t low = at(s.min_).s, high = at(s.max_).s
    if at(s.countup).b and not s.old_up:
        count += 1
    if at(s.countdown).b and not s.old_down:
        count -= 1
    if at(s.reset).b and not s.old_reset:
        count = 0
    if at(s.wrap).b:
        count = low if count > high else high if count < low else count
    elif at(s.clamp).b:
        count = min(max(count, low), high)
    at(s.count).s = <int32_t>count
    s.old_up, s.old_down, s.old_reset = at(s.countup).b, at(s.countdown).b, at(s.reset).b

declare("updown", "Counter of edges, up and down", sizeof(Updown), [
    pin_in(BIT, "countup"), pin_in(BIT, "countdown"), pin_in(BIT, "reset"), pin_out(S32, "count"),
    param_rw(BIT, "clamp", "stay between min and max"), param_rw(BIT, "wrap", "go on at the other end of min to max"),
    param_rw(S32, "max", "", 0x7FFFFFFF), param_rw(S32, "min"),
], {"": <size_t>&updown}, uses_fp=False)


cdef struct Time:
    hal_pin start, pause, seconds, minutes, hours
    uint8_t running
    double total

cdef void time_(Time* s, long period) noexcept nogil:
    if at(s.start).b and not s.running:
        s.total = 0.0
    s.running = at(s.start).b
    if s.running and not at(s.pause).b:
        s.total += period * 1e-9
    at(s.seconds).u = <uint32_t>s.total % 60
    at(s.minutes).u = <uint32_t>(s.total / 60.0) % 60
    at(s.hours).u = <uint32_t>(s.total / 3600.0)

declare("time", "Stop watch in hours, minutes and seconds", sizeof(Time), [
    pin_in(BIT, "start", "its rising edge begins at zero; runs while true"), pin_in(BIT, "pause"),
    pin_out(U32, "seconds"), pin_out(U32, "minutes"), pin_out(U32, "hours"),
], {"": <size_t>&time_})
