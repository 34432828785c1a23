"""Counting and making pulses: encoder, counter, encoder_ratio, sim_encoder. See ``declare.py``.

Each has a fast function that looks at bits and a slower one that calculates, shared by all channels.
"""

from libc.math cimport INFINITY, fabs
from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, pin_in, pin_io, pin_out

cdef enum:
    MAX_CHANNELS = 8

# Change of count by old and new phases (old A, old B, new A, new B): A leading B counts up.
cdef signed char STEP_OF[16]
STEP_OF[:] = [0, -1, 1, 0, 1, 0, 0, -1, -1, 0, 0, 1, 0, 1, -1, 0]


cdef int quadrature(uint8_t* phases, bint a, bint b) noexcept nogil:
    """Counts (-1, 0, 1) that the new phases mean; remembers them."""
    cdef uint8_t now = (a << 1) | b
    cdef int step = STEP_OF[phases[0] << 2 | now]
    phases[0] = now
    return step


# ---- encoder ----

cdef struct Encoder:
    hal_pin phase_A, phase_B, phase_Z, index_enable, reset, latch_input, latch_rising, latch_falling
    hal_pin rawcounts, counts, counts_latched, min_speed_estimate, position, position_interpolated, position_latched
    hal_pin velocity, velocity_rpm, position_scale, x4_mode, counter_mode, missing_teeth
    # the fast function's
    uint8_t phases, old_Z, old_latch
    int32_t raw
    int64_t time_ns, edge_ns  # of the next look at the phases, and of the one that saw the last count
    int64_t gap_ns  # between the last two counts
    int32_t index_raw, latch_raw
    uint8_t index_armed, index_seen, latch_seen
    # the slow function's
    int32_t zero_raw, seen_raw
    int64_t seen_ns  # time of the last count that the velocity knows
    uint8_t counts_seen  # since a standstill, up to 2

cdef struct Encoders:
    size_t count
    Encoder* channel[MAX_CHANNELS]


cdef int count_of(Encoder* s) noexcept nogil:
    """Counts in this period, by the channel's mode."""
    cdef bint a = at(s.phase_A).b != 0
    cdef uint8_t before = s.phases
    cdef int step
    if at(s.counter_mode).b:
        s.phases = a << 1
        return a and not before >> 1
    step = quadrature(&s.phases, a, at(s.phase_B).b != 0)
    if at(s.x4_mode).b or step == 0:
        return step
    # one count for each cycle: at the edge between phases 00 and 10
    return step if (before == 0 and s.phases == 2) or (before == 2 and s.phases == 0) else 0


cdef int missing_after(Encoder* s) noexcept nogil:
    """Teeth of the index gap, where this count came late enough to be the one behind it."""
    cdef int teeth = at(s.missing_teeth).s
    cdef int64_t gap = s.time_ns - s.edge_ns
    if teeth <= 0 or s.gap_ns == 0 or 2 * gap < (2 * teeth + 1) * s.gap_ns:
        return 0
    return teeth


cdef void see_index(Encoder* s, int missing) noexcept nogil:
    cdef bint z = at(s.phase_Z).b != 0
    if ((z and not s.old_Z) or missing > 0) and s.index_armed:
        s.index_raw = s.raw
        s.index_seen = 1
        s.index_armed = 0
    s.old_Z = z


cdef void see_latch(Encoder* s) noexcept nogil:
    cdef bint now = at(s.latch_input).b != 0
    if (now and not s.old_latch and at(s.latch_rising).b) or (not now and s.old_latch and at(s.latch_falling).b):
        s.latch_raw = s.raw
        s.latch_seen = 1
    s.old_latch = now


cdef void update_counters(Encoders* all_, long period) noexcept nogil:
    cdef size_t i
    cdef Encoder* s
    cdef int step, missing
    for i in range(all_.count):
        s = all_.channel[i]
        step = count_of(s)
        missing = 0
        if step != 0:
            if at(s.counter_mode).b:
                missing = missing_after(s)
            s.raw += step + missing
            if missing == 0:
                s.gap_ns = s.time_ns - s.edge_ns
            s.edge_ns = s.time_ns
        see_index(s, missing)
        see_latch(s)
        at(s.rawcounts).s = s.raw
        s.time_ns += period


cdef void estimate_velocity(Encoder* s, double scale) noexcept nogil:
    """From the times of the counts: exact over whole counts, and falling off by itself when none come.

    After a standstill the first count has no time before it, and the second may have come from anywhere: they tell none.
    """
    cdef int32_t counts = s.raw - s.seen_raw
    cdef double bound
    if counts != 0:
        if s.counts_seen >= 2:
            at(s.velocity).f = counts / scale / (max(s.edge_ns - s.seen_ns, <int64_t>1) * 1e-9)
        else:
            s.counts_seen += 1
        s.seen_raw = s.raw
        s.seen_ns = s.edge_ns
    else:
        bound = 1.0 / (fabs(scale) * (s.time_ns - s.seen_ns) * 1e-9) if s.time_ns > s.seen_ns else INFINITY
        if bound < at(s.min_speed_estimate).f:
            at(s.velocity).f = 0.0
            s.counts_seen = 0
        elif fabs(at(s.velocity).f) > bound:
            at(s.velocity).f = bound if at(s.velocity).f > 0.0 else -bound
    at(s.velocity_rpm).f = at(s.velocity).f * 60.0


cdef void capture(Encoder* s) noexcept nogil:
    cdef double scale = at(s.position_scale).f if at(s.position_scale).f != 0.0 else 1.0
    if s.index_seen:
        s.index_seen = 0
        s.zero_raw = s.index_raw
        at(s.index_enable).b = 0
    s.index_armed = at(s.index_enable).b
    if at(s.reset).b:
        s.zero_raw = s.raw
    at(s.counts).s = s.raw - s.zero_raw
    at(s.position).f = at(s.counts).s / scale
    if s.latch_seen:
        s.latch_seen = 0
        at(s.counts_latched).s = s.latch_raw - s.zero_raw
        at(s.position_latched).f = at(s.counts_latched).s / scale
    estimate_velocity(s, scale)
    at(s.position_interpolated).f = at(s.position).f
    if fabs(at(s.velocity).f) > at(s.min_speed_estimate).f:
        at(s.position_interpolated).f += at(s.velocity).f * (s.time_ns - s.edge_ns) * 1e-9


cdef void capture_position(Encoders* all_, long period) noexcept nogil:
    cdef size_t i
    for i in range(all_.count):
        capture(all_.channel[i])


declare("encoder", "Software counter of quadrature encoders, or of one phase in counter mode", sizeof(Encoder), [
    pin_in(BIT, "phase-A"), pin_in(BIT, "phase-B"), pin_in(BIT, "phase-Z", "index pulse"),
    pin_io(BIT, "index-enable", "the next rising edge of phase-Z makes the position zero, and clears this"),
    pin_in(BIT, "reset", "position is zero"), pin_in(BIT, "latch-input"),
    pin_in(BIT, "latch-rising", "latch at the rising edge", True), pin_in(BIT, "latch-falling", "and the falling", True),
    pin_out(S32, "rawcounts", "counts by update-counters; not reset"), pin_out(S32, "counts"), pin_out(S32, "counts-latched"),
    pin_in(FLOAT, "min-speed-estimate", "slower than this is 0", 1.0), pin_out(FLOAT, "position", "counts / scale"),
    pin_out(FLOAT, "position-interpolated", "between counts; for steady speeds only"), pin_out(FLOAT, "position-latched"),
    pin_out(FLOAT, "velocity", "units per s"), pin_out(FLOAT, "velocity-rpm", "units per minute"),
    pin_io(FLOAT, "position-scale", "counts per unit", 1.0), pin_io(BIT, "x4-mode", "count all four edges", True),
    pin_io(BIT, "counter-mode", "count rising edges of phase-A"), pin_in(S32, "missing-teeth", "teeth that make the index gap"),
], {}, shared={"update-counters": <size_t>&update_counters, "capture-position": <size_t>&capture_position},
   integer=("update-counters",),
   counted_by="num_chan", default_count=3, most=MAX_CHANNELS)


# ---- counter ----

cdef struct Counter:
    hal_pin phase_A, phase_Z, index_enable, reset, rawcounts, counts, position, velocity, position_scale
    uint8_t old_A, old_Z
    int32_t raw, zero_raw, index_raw, seen_raw
    uint8_t index_seen

cdef struct Counters:
    size_t count
    Counter* channel[MAX_CHANNELS]

cdef void count_edges(Counters* all_, long period) noexcept nogil:
    cdef size_t i
    cdef Counter* s
    for i in range(all_.count):
        s = all_.channel[i]
        if at(s.phase_A).b and not s.old_A:
            s.raw += 1
        if at(s.phase_Z).b and not s.old_Z and at(s.index_enable).b:
            s.index_raw = s.raw
            s.index_seen = 1
            at(s.index_enable).b = 0
        s.old_A, s.old_Z = at(s.phase_A).b, at(s.phase_Z).b
        at(s.rawcounts).s = s.raw

cdef void capture_counts(Counters* all_, long period) noexcept nogil:
    cdef size_t i
    cdef Counter* s
    cdef double scale
    for i in range(all_.count):
        s = all_.channel[i]
        scale = at(s.position_scale).f if at(s.position_scale).f != 0.0 else 1.0
        if s.index_seen:
            s.index_seen = 0
            s.zero_raw = s.index_raw
        if at(s.reset).b:
            s.zero_raw = s.raw
        at(s.counts).s = s.raw - s.zero_raw
        at(s.position).f = at(s.counts).s / scale
        at(s.velocity).f = (s.raw - s.seen_raw) / scale / (period * 1e-9)
        s.seen_raw = s.raw

declare("counter", "Counter of rising edges; encoder in counter mode does the same", sizeof(Counter), [
    pin_in(BIT, "phase-A"), pin_in(BIT, "phase-Z", "index pulse"), pin_io(BIT, "index-enable"), pin_in(BIT, "reset"),
    pin_out(S32, "rawcounts"), pin_out(S32, "counts"), pin_out(FLOAT, "position"), pin_out(FLOAT, "velocity", "units per s"),
    pin_io(FLOAT, "position-scale", "counts per unit", 1.0),
], {}, shared={"update-counters": <size_t>&count_edges, "capture-position": <size_t>&capture_counts}, integer=("update-counters",),
  
   counted_by="num_chan", most=MAX_CHANNELS, takes_names=False)


# ---- encoder_ratio ----

cdef struct EncoderRatio:
    hal_pin master_A, master_B, slave_A, slave_B, enable, error, master_ppr, slave_ppr, master_teeth, slave_teeth
    uint8_t master_phases, slave_phases, enabled, sampled
    int64_t master, slave  # counts since enable rose; of the slave since the start

cdef struct EncoderRatios:
    size_t count
    EncoderRatio* channel[MAX_CHANNELS]

cdef void sample_ratio(EncoderRatios* all_, long period) noexcept nogil:
    cdef size_t i
    cdef EncoderRatio* s
    cdef int master, slave
    for i in range(all_.count):
        s = all_.channel[i]
        master = quadrature(&s.master_phases, at(s.master_A).b != 0, at(s.master_B).b != 0)
        slave = quadrature(&s.slave_phases, at(s.slave_A).b != 0, at(s.slave_B).b != 0)
        if s.sampled:  # the phases with which it all begins are no movement
            s.master += master
            s.slave += slave
        s.sampled = 1

cdef double turns(int64_t counts, uint32_t ppr) noexcept nogil:
    return counts / <double>ppr if ppr > 0 else 0.0

cdef void update_ratio(EncoderRatios* all_, long period) noexcept nogil:
    cdef size_t i
    cdef EncoderRatio* s
    cdef double ratio
    for i in range(all_.count):
        s = all_.channel[i]
        if at(s.enable).b and not s.enabled:
            s.master = 0
        s.enabled = at(s.enable).b
        ratio = at(s.master_teeth).u / <double>at(s.slave_teeth).u if at(s.slave_teeth).u else 0.0
        at(s.error).f = turns(s.slave, at(s.slave_ppr).u)
        if s.enabled:
            at(s.error).f -= turns(s.master, at(s.master_ppr).u) * ratio

declare("encoder_ratio", "Electronic gear: error of a slave encoder against a master", sizeof(EncoderRatio), [
    pin_in(BIT, "master-A"), pin_in(BIT, "master-B"), pin_in(BIT, "slave-A"), pin_in(BIT, "slave-B"),
    pin_in(BIT, "enable", "false: error is the slave's position"), pin_out(FLOAT, "error", "revolutions of the slave"),
    pin_io(U32, "master-ppr", "counts per revolution: all edges of both phases"), pin_io(U32, "slave-ppr"), pin_io(U32, "master-teeth"),
    pin_io(U32, "slave-teeth"),
], {}, shared={"sample": <size_t>&sample_ratio, "update": <size_t>&update_ratio}, integer=("sample",),
   counted_by="num_chan", most=MAX_CHANNELS)


# ---- sim_encoder ----

cdef enum:
    COUNT_BITS = 27

cdef double COUNT = 1 << COUNT_BITS

cdef struct SimEncoder:
    hal_pin phase_A, phase_B, phase_Z, ppr, speed, scale, rawcounts
    double rate  # counts per s
    int64_t position  # 1 / COUNT of a count
    int32_t counts_per_turn

cdef struct SimEncoders:
    size_t count
    SimEncoder* channel[MAX_CHANNELS]

cdef void sim_make_pulses(SimEncoders* all_, long period) noexcept nogil:
    """At most one count a period, so that no edge is lost."""
    cdef size_t i
    cdef SimEncoder* s
    cdef int64_t count
    for i in range(all_.count):
        s = all_.channel[i]
        s.position += <int64_t>(min(max(s.rate * period * 1e-9, -1.0), 1.0) * COUNT)
        count = s.position >> COUNT_BITS
        at(s.rawcounts).s = <int32_t>count
        at(s.phase_A).b = (count & 3) == 0 or (count & 3) == 1
        at(s.phase_B).b = (count & 3) == 1 or (count & 3) == 2
        at(s.phase_Z).b = count == 0 or (s.counts_per_turn > 0 and count % s.counts_per_turn == 0)

cdef void sim_update_speed(SimEncoders* all_, long period) noexcept nogil:
    cdef size_t i
    cdef SimEncoder* s
    cdef double scale
    for i in range(all_.count):
        s = all_.channel[i]
        scale = at(s.scale).f if at(s.scale).f != 0.0 else 1.0
        s.counts_per_turn = <int32_t>(at(s.ppr).u * 4)
        s.rate = at(s.speed).f / scale * s.counts_per_turn

declare("sim_encoder", "Simulated quadrature encoder with index", sizeof(SimEncoder), [
    pin_out(BIT, "phase-A"), pin_out(BIT, "phase-B"), pin_out(BIT, "phase-Z", "once a revolution"),
    pin_io(U32, "ppr", "pulses per revolution, four counts each", 100), pin_in(FLOAT, "speed", "speed / scale is in rev/s"),
    pin_io(FLOAT, "scale", "", 1.0), pin_in(S32, "rawcounts", "counts made"),
], {}, shared={"make-pulses": <size_t>&sim_make_pulses, "update-speed": <size_t>&sim_update_speed}, integer=("make-pulses",),
   counted_by="num_chan", most=MAX_CHANNELS)
