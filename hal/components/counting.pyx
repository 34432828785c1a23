"""Components that count what comes: clicks of a button, values by size, latencies; and pulses that say all is well."""

from libc.math cimport floor
from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t
from posix.time cimport CLOCK_MONOTONIC, clock_gettime, timespec

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, param_rw, pin_in, pin_out


# ---- multiclick ----

cdef enum:
    MOST_CLICKS = 4
    SPOILED = 9  # held too long, or one click too many: wait until let go

cdef struct Multiclick:
    hal_pin in_
    hal_pin single_click, single_click_only, double_click, double_click_only
    hal_pin triple_click, triple_click_only, quadruple_click, quadruple_click_only
    hal_pin state  # 2 n - 1: the n-th click is held; 2 n: let go after it
    hal_pin invert_input, max_hold_ns, max_space_ns, output_hold_ns
    int64_t left_ns[8]  # of the pulses
    int64_t since_ns  # in this state

cdef void pulse(Multiclick* s, int output) noexcept nogil:
    at((&s.single_click)[output]).b = 1
    s.left_ns[output] = at(s.output_hold_ns).u

cdef void end_pulses(Multiclick* s, long period) noexcept nogil:
    cdef hal_pin* click = &s.single_click
    cdef int i
    for i in range(8):
        if at(click[i]).b:
            s.left_ns[i] -= period
            if s.left_ns[i] <= 0:
                at(click[i]).b = 0

cdef int next_state(Multiclick* s, bint pressed) noexcept nogil:
    cdef int state = at(s.state).s
    if state == SPOILED:
        return SPOILED if pressed else 0
    if state % 2 == 1:  # held
        if not pressed:
            pulse(s, state - 1)
            return state + 1
        return SPOILED if s.since_ns > at(s.max_hold_ns).u else state
    if pressed:
        return state + 1
    if state > 0 and s.since_ns > at(s.max_space_ns).u:
        pulse(s, state - 1)
        return 0
    return state

cdef void multiclick(Multiclick* s, long period) noexcept nogil:
    cdef int old = at(s.state).s
    end_pulses(s, period)
    s.since_ns += period
    at(s.state).s = next_state(s, (at(s.in_).b != 0) != (at(s.invert_input).b != 0))
    if at(s.state).s != old:
        s.since_ns = 0

declare("multiclick", "Single, double, triple and quadruple clicks of a button", sizeof(Multiclick), [
    pin_in(BIT, "in", "the button"),
    *(pin_out(BIT, f"{number}-click{only}", "pulse when the clicks are over" if only else "pulse as soon as there are so many")
      for number in ("single", "double", "triple", "quadruple") for only in ("", "-only")),
    pin_out(S32, "state"), param_rw(BIT, "invert-input", "clicks begin with falling edges"),
    param_rw(U32, "max-hold-ns", "longest click", 250000000), param_rw(U32, "max-space-ns", "longest space between", 250000000),
    param_rw(U32, "output-hold-ns", "length of the pulses", 100000000),
], {"": <size_t>&multiclick}, uses_fp=False)


# ---- histograms ----

cdef enum:
    HISTOGRAM_BINS = 200
    LATENCY_BINS = 1000

cdef struct Histobins:
    hal_pin pintype, input, input_s32, input_u32, input_bit, nbins, binsize, minvalue, index, check, reset, method
    hal_pin input_error, binvalue, pextra, nextra, input_min, input_max, nsamples, variance, mean, availablebins
    double total, squares  # of all samples but the first
    double running_mean, running_squares  # by Welford's recurrence
    int32_t bin[HISTOGRAM_BINS]

cdef double chosen_input(Histobins* s) noexcept nogil:
    cdef uint32_t kind = at(s.pintype).u
    if kind == 1:
        return at(s.input_s32).s
    if kind == 2:
        return at(s.input_u32).u
    return <double>(at(s.input_bit).b != 0) if kind == 3 else at(s.input).f

cdef void begin_histogram(Histobins* s, double value) noexcept nogil:
    """The first value gives only the range."""
    cdef int i
    for i in range(HISTOGRAM_BINS):
        s.bin[i] = 0
    s.total = s.squares = s.running_mean = s.running_squares = 0.0
    at(s.pextra).f = at(s.nextra).f = at(s.variance).f = at(s.mean).f = 0.0
    at(s.input_min).f = at(s.input_max).f = value
    at(s.input_error).b = 0
    at(s.nsamples).u = 1

cdef void count_value(Histobins* s, double value) noexcept nogil:
    cdef double place = floor((value - at(s.minvalue).f) / at(s.binsize).f)
    if place < 0.0:
        at(s.nextra).f += 1.0
    elif place >= at(s.nbins).u:
        at(s.pextra).f += 1.0
    else:
        s.bin[<int>place] += 1
    at(s.input_min).f = min(at(s.input_min).f, value)
    at(s.input_max).f = max(at(s.input_max).f, value)

cdef void add_statistics(Histobins* s, double value) noexcept nogil:
    cdef double n, apart = value - s.running_mean
    at(s.nsamples).u += 1
    n = at(s.nsamples).u
    s.total += value
    s.squares += value * value
    s.running_mean += apart / n
    s.running_squares += apart * (value - s.running_mean)
    if at(s.method).b:
        at(s.mean).f = s.running_mean
        at(s.variance).f = s.running_squares / (n - 1.0)
    else:
        at(s.mean).f = s.total / n
        at(s.variance).f = (s.squares - s.total * s.total / n) / (n - 1.0)

cdef void histobins(Histobins* s, long period) noexcept nogil:
    cdef double value = chosen_input(s)
    cdef int32_t index = at(s.index).s
    if at(s.reset).b or at(s.nsamples).u == 0:
        begin_histogram(s, value)
    elif not at(s.input_error).b:
        if 0 < at(s.nbins).u <= HISTOGRAM_BINS and at(s.binsize).f > 0.0 and at(s.pintype).u <= 3:
            count_value(s, value)
            add_statistics(s, value)
        else:
            at(s.input_error).b = 1
    at(s.binvalue).f = s.bin[index] if 0 <= index < <int32_t>min(at(s.nbins).u, <uint32_t>HISTOGRAM_BINS) else -1.0
    at(s.check).s = index

declare("histobins", "Histogram of a value, with its mean and variance", sizeof(Histobins), [
    pin_in(U32, "pintype", "which input counts: 0 input, 1 input-s32, 2 input-u32, 3 input-bit"), pin_in(FLOAT, "input"),
    pin_in(S32, "input-s32"), pin_in(U32, "input-u32"), pin_in(BIT, "input-bit"),
    pin_in(U32, "nbins", "number of bins, up to 200", 20), pin_in(FLOAT, "binsize", "", 1.0),
    pin_in(FLOAT, "minvalue", "where the first bin begins"), pin_in(S32, "index", "of the bin to show"),
    pin_out(S32, "check", "index, when binvalue is there"), pin_in(BIT, "reset", "begin again"),
    pin_in(BIT, "method", "variance by Welford's recurrence"), pin_out(BIT, "input-error", "no such histogram; until reset"),
    pin_out(FLOAT, "binvalue", "values in the bin; -1 where there is no such bin"), pin_out(FLOAT, "pextra", "values above all bins"),
    pin_out(FLOAT, "nextra", "values below all bins"), pin_out(FLOAT, "input-min"), pin_out(FLOAT, "input-max"),
    pin_out(U32, "nsamples"), pin_out(FLOAT, "variance"), pin_out(FLOAT, "mean"),
    pin_out(S32, "availablebins", "", HISTOGRAM_BINS),
], {"": <size_t>&histobins})


cdef struct Latencybins:
    hal_pin maxbinnumber, index, reset, nsbinsize, check, latency, latency_max, latency_min, pbinvalue, nbinvalue
    hal_pin pextra, nextra, variance, availablebins
    int64_t last_ns
    double total, squares, count
    int32_t late[LATENCY_BINS + 1]
    int32_t early[LATENCY_BINS + 1]

cdef int64_t clock_ns() noexcept nogil:
    cdef timespec t
    clock_gettime(CLOCK_MONOTONIC, &t)
    return <int64_t>t.tv_sec * 1000000000 + t.tv_nsec

cdef void begin_latencies(Latencybins* s) noexcept nogil:
    cdef int i
    for i in range(LATENCY_BINS + 1):
        s.late[i] = s.early[i] = 0
    s.total = s.squares = s.count = 0.0
    at(s.latency_max).s = at(s.latency_min).s = at(s.pextra).s = at(s.nextra).s = at(s.variance).s = 0

cdef void count_latency(Latencybins* s, int32_t latency) noexcept nogil:
    cdef int32_t most = min(at(s.maxbinnumber).s, LATENCY_BINS)
    cdef int32_t bin = latency // max(at(s.nsbinsize).s, 1) if latency >= 0 else -latency // max(at(s.nsbinsize).s, 1)
    if bin > most and latency >= 0:
        at(s.pextra).s += 1
    elif bin > most:
        at(s.nextra).s += 1
    elif latency >= 0:
        s.late[bin] += 1
    else:
        s.early[bin] += 1
    at(s.latency).s = latency
    at(s.latency_max).s = max(at(s.latency_max).s, latency)
    at(s.latency_min).s = min(at(s.latency_min).s, latency)
    s.count += 1.0
    s.total += latency
    s.squares += <double>latency * latency
    if s.count > 1.0:
        at(s.variance).s = <int32_t>min((s.squares - s.total * s.total / s.count) / (s.count - 1.0), 2147483647.0)

cdef void latencybins(Latencybins* s, long period) noexcept nogil:
    cdef int64_t now = clock_ns()
    cdef int32_t index = at(s.index).s
    if at(s.reset).b:
        begin_latencies(s)
    elif s.last_ns != 0:
        count_latency(s, <int32_t>min(max(now - s.last_ns - period, -2147483647), 2147483647))
    s.last_ns = now
    at(s.pbinvalue).s = at(s.nbinvalue).s = -1
    if 0 <= index <= min(at(s.maxbinnumber).s, LATENCY_BINS):
        at(s.pbinvalue).s = s.late[index]
        at(s.nbinvalue).s = s.early[index]
    at(s.check).s = index

declare("latencybins", "Histogram of how late and early the thread that runs it is", sizeof(Latencybins), [
    pin_in(S32, "maxbinnumber", "number of bins each way, up to 1000", LATENCY_BINS), pin_in(S32, "index", "of the bins to show"),
    pin_in(BIT, "reset", "begin again"), pin_in(S32, "nsbinsize", "ns"), pin_out(S32, "check", "index, when the values are there"),
    pin_out(S32, "latency", "of this period, ns"), pin_out(S32, "latency-max"), pin_out(S32, "latency-min"),
    pin_out(S32, "pbinvalue", "periods that were so late; -1 where there is no such bin"), pin_out(S32, "nbinvalue", "so early"),
    pin_out(S32, "pextra", "later than all bins"), pin_out(S32, "nextra", "earlier than all bins"), pin_out(S32, "variance"),
    pin_out(S32, "availablebins", "", LATENCY_BINS),
], {"": <size_t>&latencybins}, uses_fp=False)


# ---- signs of life ----

cdef struct ChargePump:
    hal_pin out, out_2, out_4, enable
    uint32_t count

cdef void charge_pump(ChargePump* s, long period) noexcept nogil:
    cdef uint32_t shown = 0
    if at(s.enable).b:
        s.count += 1
        shown = s.count
    at(s.out).b = shown & 1
    at(s.out_2).b = shown >> 1 & 1
    at(s.out_4).b = shown >> 2 & 1

declare("charge_pump", "Square waves for a charge pump", sizeof(ChargePump), [
    pin_out(BIT, "out", "changes each period"), pin_out(BIT, "out-2", "half as fast"), pin_out(BIT, "out-4", "a quarter as fast"),
    pin_in(BIT, "enable", "false: all outputs are", True),
], {"": <size_t>&charge_pump}, uses_fp=False, default_count=1, most=1, instance="charge-pump")


# ---- threadtest ----

cdef struct ThreadTest:
    hal_pin count

cdef void threadtest_increment(ThreadTest* s, long period) noexcept nogil:
    at(s.count).u += 1

cdef void threadtest_reset(ThreadTest* s, long period) noexcept nogil:
    at(s.count).u = 0

declare("threadtest", "Counts how often one thread runs between two runs of another", sizeof(ThreadTest), [
    pin_out(U32, "count", "of increment since the last reset"),
], {"increment": <size_t>&threadtest_increment, "reset": <size_t>&threadtest_reset}, uses_fp=False)
