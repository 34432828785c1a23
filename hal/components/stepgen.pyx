"""``stepgen``: step pulses in software, from a position or a velocity command. See ``declare.py``.

Positions are counted in fixed point, 1 / `STEP` of a step. `make-pulses` adds a rate each period; `update-freq` sets the rate
that is wanted and how much the rate may change in one period of `make-pulses`.
"""

from libc.math cimport fabs
from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, numbers, param_ro, param_rw, pin_in, pin_out
from nml.errors import HalError

cdef enum:
    STEP_BITS = 28
    MAX_CHANNELS = 16
    MAX_PHASES = 5
    MAX_CYCLE = 10

cdef double STEP = 1 << STEP_BITS
cdef long ASSUMED_PERIOD_NS = 50000  # of make-pulses, until it has run once

# Phase patterns of each step type from 2 on, a bit for each phase, in the order of forward motion.
CYCLES = {
    2: (1, 3, 2, 0),
    3: (1, 2, 4),
    4: (1, 3, 2, 6, 4, 5),
    5: (1, 2, 4, 8),
    6: (3, 6, 12, 9),
    7: (1, 7, 14, 8),
    8: (5, 6, 10, 9),
    9: (1, 3, 2, 6, 4, 12, 8, 9),
    10: (1, 5, 7, 6, 14, 10, 8, 9),
    11: (1, 2, 4, 8, 16),
    12: (3, 6, 12, 24, 17),
    13: (1, 3, 2, 6, 4, 12, 8, 24, 16, 17),
    14: (3, 7, 6, 14, 12, 28, 24, 25, 17, 19),
}
cdef int cycle_length[16]
cdef int cycle_pattern[16][MAX_CYCLE]
VELOCITY_MODE = 0x100  # in a personality, with the step type below

cdef struct Stepgen:
    hal_pin counts, position_fb, enable, position_cmd, velocity_cmd
    hal_pin step, dir, up, down
    hal_pin phase[MAX_PHASES]
    hal_pin rawcounts, frequency, maxaccel, maxvel, position_scale, steplen, stepspace, dirsetup, dirhold, dirdelay
    size_t personality
    int64_t position  # 1 / STEP of a step
    int64_t rate  # of a period of make-pulses
    int64_t wanted_rate
    int64_t rate_change  # largest, of a period
    double old_command  # steps
    double frequency_wanted  # steps per s, of the last update
    long high_ns, low_ns, setup_ns, hold_ns  # until the pulse may end, the next may begin, a step may follow dir, dir may change
    uint8_t backwards
    uint8_t commanded

cdef struct Stepgens:
    size_t count
    Stepgen* channel[MAX_CHANNELS]

cdef long make_period_ns = ASSUMED_PERIOD_NS


cdef uint32_t value_or(hal_pin pin, uint32_t otherwise) noexcept nogil:
    return otherwise if pin == NULL else at(pin).u


cdef void show_phases(Stepgen* s) noexcept nogil:
    """The outputs of step types 2 and up follow the count."""
    cdef int type_ = s.personality & 0xFF
    cdef int64_t count = s.position >> STEP_BITS
    cdef int place = <int>(count % cycle_length[type_])
    cdef int pattern, i
    if place < 0:
        place += cycle_length[type_]
    pattern = cycle_pattern[type_][place]
    for i in range(MAX_PHASES):
        if s.phase[i] != NULL:
            at(s.phase[i]).b = (pattern >> i) & 1


cdef void begin_pulse(Stepgen* s) noexcept nogil:
    s.high_ns = at(s.steplen).u
    s.low_ns = s.high_ns + value_or(s.stepspace, 0)
    s.hold_ns = s.high_ns + value_or(s.dirhold, value_or(s.dirdelay, 0))
    if s.step != NULL:
        at(s.step).b = 1
    elif s.up != NULL:
        at(s.down if s.backwards else s.up).b = 1


cdef void pass_time(Stepgen* s, long period) noexcept nogil:
    """Count the timers down; end a pulse that is over."""
    s.low_ns = max(s.low_ns - period, 0)
    s.setup_ns = max(s.setup_ns - period, 0)
    s.hold_ns = max(s.hold_ns - period, 0)
    s.high_ns = max(s.high_ns - period, 0)
    if s.high_ns == 0:
        if s.step != NULL:
            at(s.step).b = 0
        if s.up != NULL:
            at(s.up).b = at(s.down).b = 0


cdef void make_channel(Stepgen* s, long period) noexcept nogil:
    cdef int64_t before = s.position >> STEP_BITS
    cdef int64_t change = min(max(s.wanted_rate - s.rate, -s.rate_change), s.rate_change)
    pass_time(s, period)
    if not at(s.enable).b:
        s.rate = 0
        return
    s.rate += change
    if s.rate != 0 and (s.rate < 0) != (s.backwards != 0):
        if s.hold_ns > 0:
            return  # the position waits with the direction
        s.backwards = s.rate < 0
        s.setup_ns = value_or(s.dirsetup, 0)
        if s.dir != NULL:
            at(s.dir).b = s.backwards
    if s.setup_ns > 0 and (s.position + s.rate) >> STEP_BITS != before:
        return
    s.position += s.rate
    if s.position >> STEP_BITS != before:
        begin_pulse(s)
    if (s.personality & 0xFF) >= 2:
        show_phases(s)
    at(s.rawcounts).s = <int32_t>(s.position >> STEP_BITS)


cdef void make_pulses(Stepgens* all_, long period) noexcept nogil:
    global make_period_ns
    cdef size_t i
    make_period_ns = period
    for i in range(all_.count):
        make_channel(all_.channel[i], period)


cdef void capture_position(Stepgens* all_, long period) noexcept nogil:
    cdef size_t i
    cdef Stepgen* s
    cdef double scale
    for i in range(all_.count):
        s = all_.channel[i]
        scale = at(s.position_scale).f
        at(s.counts).s = <int32_t>(s.position >> STEP_BITS)
        at(s.position_fb).f = (s.position / STEP - 0.5) / (scale if scale != 0.0 else 1.0)


cdef double highest_frequency(Stepgen* s) noexcept nogil:
    """Steps per s that the pulse timing allows, each time a whole number of periods."""
    cdef long period = make_period_ns
    cdef long high = (at(s.steplen).u + period - 1) // period
    cdef long low = (value_or(s.stepspace, 0) + period - 1) // period
    return 1e9 / (period * max(high + low, 1))


cdef double to_position(Stepgen* s, double v, double maxaccel, double dt) noexcept nogil:
    """The frequency of the next period on the way to the commanded position, which may move.

    Relative to the command it goes on to accelerate while it would stop short by more than the way of two periods,
    else it brakes; and within reach of one period's braking it closes the rest.
    """
    cdef double command = at(s.position_cmd).f * at(s.position_scale).f
    cdef double command_v = (command - s.old_command) / dt if s.commanded else 0.0
    cdef double rest = command - command_v * dt - (s.position / STEP - 0.5)
    cdef double w, short
    if fabs(command_v) > fabs(at(s.maxvel).f * at(s.position_scale).f) > 0.0:
        command_v = 0.0  # a jump: come to rest there
        rest = command - (s.position / STEP - 0.5)
    s.old_command = command
    s.commanded = 1
    w = v - command_v
    if fabs(w) < maxaccel * dt * 1.0001:
        return command_v + 0.5 * rest / dt
    short = (rest if w > 0.0 else -rest) - w * w / (2.0 * maxaccel)
    return v + maxaccel * dt if (short > 2.0 * fabs(w) * dt) == (w > 0.0) else v - maxaccel * dt


cdef void update_channel(Stepgen* s, double dt) noexcept nogil:
    cdef double scale = fabs(at(s.position_scale).f) if at(s.position_scale).f != 0.0 else 1.0
    cdef double make_dt = make_period_ns * 1e-9
    cdef double top = highest_frequency(s)
    cdef double maxaccel = fabs(at(s.maxaccel).f) * scale
    cdef double v = s.frequency_wanted  # make-pulses may still be on its way there
    cdef double wanted
    if 0.0 < at(s.maxvel).f * scale:
        if at(s.maxvel).f * scale > top:
            at(s.maxvel).f = top / scale
        top = min(top, at(s.maxvel).f * scale)
    if maxaccel == 0.0:
        maxaccel = top / dt
    if not at(s.enable).b:
        s.wanted_rate = s.rate = 0
        s.commanded = 0
        s.frequency_wanted = at(s.frequency).f = 0.0
        return
    if s.velocity_cmd != NULL:
        wanted = at(s.velocity_cmd).f * at(s.position_scale).f
    else:
        wanted = to_position(s, v, maxaccel, dt)
    wanted = min(max(wanted, v - maxaccel * dt), v + maxaccel * dt)
    wanted = min(max(wanted, -top), top)
    s.frequency_wanted = at(s.frequency).f = wanted
    s.wanted_rate = <int64_t>(wanted * make_dt * STEP)
    s.rate_change = max(<int64_t>(maxaccel * make_dt * make_dt * STEP), <int64_t>1)


cdef void update_freq(Stepgens* all_, long period) noexcept nogil:
    cdef size_t i
    for i in range(all_.count):
        update_channel(all_.channel[i], period * 1e-9)


def set_up(size_t address):
    """Begin half a step from the edge, so that rounding is even."""
    (<Stepgen*>address).position = 1 << (STEP_BITS - 1)


def decode(dict args) -> list:
    """Personalities from step_type= and ctrl_type=; the waveform of user_step_type= becomes type 15."""
    types = numbers("stepgen", args, "step_type")
    if not types:
        raise HalError("stepgen: step_type= is required, a number for each channel")
    if "user_step_type" in args:
        CYCLES[15] = tuple(numbers("stepgen", args, "user_step_type"))
        if not 1 <= len(CYCLES[15]) <= MAX_CYCLE or not all(0 <= p < 1 << MAX_PHASES for p in CYCLES[15]):
            raise HalError(f"stepgen: user_step_type: 1 to {MAX_CYCLE} patterns of {MAX_PHASES} bits are possible")
    for number in types:
        if number not in (0, 1) and number not in CYCLES:
            raise HalError(f"stepgen: step_type {number} is none of 0 to 14, or 15 with user_step_type=")
    for type_, patterns in CYCLES.items():
        cycle_length[type_] = len(patterns)
        for i, pattern in enumerate(patterns):
            cycle_pattern[type_][i] = pattern
    modes = [mode for mode in args.get("ctrl_type", "").split(",") if mode]
    for mode in modes:
        if mode not in ("p", "v"):
            raise HalError(f"stepgen: ctrl_type '{mode}': p (position) or v (velocity) would be right")
    modes += ["p"] * (len(types) - len(modes))
    return [type_ | (VELOCITY_MODE if mode == "v" else 0) for type_, mode in zip(types, modes)]


def phases(int personality) -> int:
    """How many phase outputs a step type has."""
    patterns = CYCLES.get(personality & 0xFF, ())
    return max(patterns).bit_length() if patterns else 0


def only(*types):
    """For a table entry that exists for these step types."""
    return lambda personality: int(personality & 0xFF in types)


declare("stepgen", "Step pulses in software. step_type=0,... is 0 step/dir, 1 up/down, 2 quadrature, 3-14 phase patterns, "
        "15 user_step_type=; ctrl_type=p,v,... chooses position or velocity commands", sizeof(Stepgen), [
    pin_out(S32, "counts", "steps, by capture-position"), pin_out(FLOAT, "position-fb", "counts / scale, finer than a step"),
    pin_in(BIT, "enable"), pin_in(FLOAT, "position-cmd", "units", personal=lambda p: int(not p & VELOCITY_MODE)),
    pin_in(FLOAT, "velocity-cmd", "units per s", personal=lambda p: int(bool(p & VELOCITY_MODE))),
    pin_out(BIT, "step", personal=only(0)), pin_out(BIT, "dir", "true backwards", personal=only(0)),
    pin_out(BIT, "up", personal=only(1)), pin_out(BIT, "down", personal=only(1)),
    pin_out(BIT, "phase-{letter}", count=MAX_PHASES, personal=phases),
    param_ro(S32, "rawcounts", "steps, by make-pulses"), param_ro(FLOAT, "frequency", "steps per s"),
    param_rw(FLOAT, "maxaccel", "units per s^2; 0 is no limit"), param_rw(FLOAT, "maxvel", "units per s; 0 is no limit"),
    param_rw(FLOAT, "position-scale", "steps per unit", 1.0), param_rw(U32, "steplen", "length of a pulse, ns", 1),
    param_rw(U32, "stepspace", "shortest time between pulses, ns", 1, personal=only(0, 1)),
    param_rw(U32, "dirsetup", "from dir to step, ns", 1, personal=only(0)),
    param_rw(U32, "dirhold", "from step to dir, ns", 1, personal=only(0)),
    param_rw(U32, "dirdelay", "between steps of opposite directions, ns", 1, personal=lambda p: int(p & 0xFF != 0)),
], {}, integer=("make-pulses",), shared={"make-pulses": <size_t>&make_pulses, "update-freq": <size_t>&update_freq,
               "capture-position": <size_t>&capture_position},
   counted_by="step_type", sizes=True, most=MAX_CHANNELS, options=("ctrl_type", "user_step_type"), decode=decode,
   keep_personality=True, set_up=set_up)
