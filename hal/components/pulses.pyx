"""``pwmgen`` and ``sim_parport``: outputs that switch with the base thread. See ``declare.py``."""

from libc.math cimport fabs
from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, declare, numbers, param_rw, pin_in, pin_io, pin_out
from nml.errors import HalError

cdef enum:
    MAX_CHANNELS = 8
    OUT_PINS = 12
    IN_PINS = 13


# ---- pwmgen ----

cdef struct Pwmgen:
    hal_pin enable, value, scale, offset, dither_pwm, pwm_freq, min_dc, max_dc, curr_dc, pwm, dir, up, down
    double density  # sum of a density modulation
    double duty  # size of the duty cycle
    int64_t length_ns, on_ns, at_ns  # of this pulse: whole, on, gone
    int64_t owed_ns  # on-time that is still to come, when dithering
    uint8_t on, backwards, modulate_density

cdef struct Pwmgens:
    size_t count
    Pwmgen* channel[MAX_CHANNELS]

cdef long make_period_ns = 50000


cdef void put(Pwmgen* s, bint on) noexcept nogil:
    if s.pwm != NULL:
        at(s.pwm).b = on
    if s.up != NULL:
        at(s.up).b = on and not s.backwards
        at(s.down).b = on and s.backwards


cdef void begin_pulse(Pwmgen* s) noexcept nogil:
    """Dithering carries what whole periods leave over, of the on-time and of the pulse's length."""
    s.on = 1
    if at(s.dither_pwm).b:
        s.owed_ns += s.on_ns
        s.at_ns -= s.length_ns
    else:
        s.at_ns = 0


cdef bint is_on(Pwmgen* s, long period) noexcept nogil:
    """Whether the pulse is on in this period; once it is off it stays so."""
    if at(s.dither_pwm).b:
        s.on = s.owed_ns > 0
        s.owed_ns -= period if s.on else 0
    else:
        s.on = s.on and s.at_ns < s.on_ns
    return s.on


cdef void make_pulses(Pwmgens* all_, long period) noexcept nogil:
    global make_period_ns
    cdef size_t i
    cdef Pwmgen* s
    make_period_ns = period
    for i in range(all_.count):
        s = all_.channel[i]
        if not at(s.enable).b:
            s.at_ns = s.length_ns
            s.owed_ns = 0
            s.density = 0.0
            s.backwards = 0
            put(s, False)
        elif s.modulate_density:
            s.density += s.duty
            put(s, s.density > 0.0)
            if s.density > 0.0:
                s.density -= 1.0
        else:
            if s.at_ns >= s.length_ns:
                begin_pulse(s)
            put(s, is_on(s, period))
            s.at_ns += period


cdef void set_length(Pwmgen* s) noexcept nogil:
    """The pulse length of pwm-freq, which is corrected to what the base period allows."""
    cdef double highest = 0.5e9 / make_period_ns
    cdef int64_t periods
    s.modulate_density = at(s.pwm_freq).f <= 0.0
    if s.modulate_density:
        at(s.pwm_freq).f = 0.0
        return
    if at(s.pwm_freq).f > highest:
        at(s.pwm_freq).f = highest
    if at(s.dither_pwm).b:
        s.length_ns = <int64_t>(1e9 / at(s.pwm_freq).f)
        return
    periods = <int64_t>(1e9 / at(s.pwm_freq).f / make_period_ns + 0.5)
    s.length_ns = max(periods, <int64_t>2) * make_period_ns
    at(s.pwm_freq).f = 1e9 / s.length_ns


cdef void update_channel(Pwmgen* s) noexcept nogil:
    cdef double high = min(max(at(s.max_dc).f, 0.0), 1.0)
    cdef double low = min(max(at(s.min_dc).f, 0.0), high)
    cdef double duty
    cdef int64_t periods
    at(s.min_dc).f, at(s.max_dc).f = low, high
    if at(s.scale).f == 0.0:
        at(s.scale).f = 1.0
    set_length(s)
    duty = at(s.value).f / at(s.scale).f + at(s.offset).f
    if s.dir == NULL and s.up == NULL:
        duty = max(duty, 0.0)
    s.backwards = duty < 0.0
    s.duty = min(max(fabs(duty), low), high)
    if not s.modulate_density and not at(s.dither_pwm).b:
        periods = s.length_ns // make_period_ns
        s.duty = <double><int64_t>(s.duty * periods + 0.5) / periods
        s.on_ns = <int64_t>(s.duty * periods + 0.5) * make_period_ns
    else:
        s.on_ns = <int64_t>(s.duty * s.length_ns)
    if s.dir != NULL:
        at(s.dir).b = s.backwards
    at(s.curr_dc).f = -s.duty if s.backwards else s.duty


cdef void update(Pwmgens* all_, long period) noexcept nogil:
    cdef size_t i
    for i in range(all_.count):
        update_channel(all_.channel[i])


def decode(dict args) -> list:
    """Personalities: the output types."""
    types = numbers("pwmgen", args, "output_type")
    if not types:
        raise HalError("pwmgen: output_type= is required, a number for each channel")
    if not all(number in (0, 1, 2) for number in types):
        raise HalError(f"pwmgen: output_type={args['output_type']}: 0 (single), 1 (pwm/dir) or 2 (up/down) would be right")
    return types


declare("pwmgen", "Pulse width or density modulation in software; output_type=0,... is 0 single, 1 pwm and direction, "
        "2 up and down", sizeof(Pwmgen), [
    pin_in(BIT, "enable"), pin_in(FLOAT, "value"), pin_io(FLOAT, "scale", "value of full duty", 1.0),
    pin_io(FLOAT, "offset", "added to value / scale"), pin_io(BIT, "dither-pwm", "vary pulses to meet the mean exactly"),
    pin_io(FLOAT, "pwm-freq", "Hz; 0 modulates the density of pulses"), pin_io(FLOAT, "min-dc"),
    pin_io(FLOAT, "max-dc", "", 1.0), pin_out(FLOAT, "curr-dc", "duty cycle now, -1 to 1"),
    pin_out(BIT, "pwm", personal=lambda p: int(p < 2)), pin_out(BIT, "dir", "true backwards", personal=lambda p: int(p == 1)),
    pin_out(BIT, "up", personal=lambda p: int(p == 2)), pin_out(BIT, "down", personal=lambda p: int(p == 2)),
], {}, shared={"make-pulses": <size_t>&make_pulses, "update": <size_t>&update}, integer=("make-pulses",), counted_by="output_type", sizes=True,
   most=MAX_CHANNELS, decode=decode)


# ---- sim_parport ----

OUTPUTS = (1, 2, 3, 4, 5, 6, 7, 8, 9, 14, 16, 17)
INPUTS = (2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 15)

cdef struct SimParport:
    hal_pin pin_out[OUT_PINS]
    hal_pin pin_out_fake[OUT_PINS]
    hal_pin pin_out_invert[OUT_PINS]
    hal_pin pin_out_reset[OUT_PINS]
    hal_pin pin_in_fake[IN_PINS]
    hal_pin pin_in[IN_PINS]
    hal_pin pin_in_not[IN_PINS]
    hal_pin reset_time

cdef void parport_read(SimParport* s, long period) noexcept nogil:
    cdef int i
    for i in range(IN_PINS):
        at(s.pin_in[i]).b = at(s.pin_in_fake[i]).b
        at(s.pin_in_not[i]).b = not at(s.pin_in_fake[i]).b

cdef void parport_write(SimParport* s, long period) noexcept nogil:
    cdef int i
    for i in range(OUT_PINS):
        at(s.pin_out_fake[i]).b = (at(s.pin_out[i]).b != 0) != (at(s.pin_out_invert[i]).b != 0)

cdef void parport_reset(SimParport* s, long period) noexcept nogil:
    cdef int i
    for i in range(OUT_PINS):
        if at(s.pin_out_reset[i]).b:
            at(s.pin_out_fake[i]).b = at(s.pin_out_invert[i]).b

declare("sim_parport", "Parallel port without hardware: what would be its wires are the pins ending in -fake",
        sizeof(SimParport), [
    *(pin_in(BIT, f"pin-{n:02}-out") for n in OUTPUTS), *(pin_out(BIT, f"pin-{n:02}-out-fake") for n in OUTPUTS),
    *(param_rw(BIT, f"pin-{n:02}-out-invert") for n in OUTPUTS),
    *(param_rw(BIT, f"pin-{n:02}-out-reset", "low again when reset runs") for n in OUTPUTS),
    *(pin_in(BIT, f"pin-{n:02}-in-fake") for n in INPUTS), *(pin_out(BIT, f"pin-{n:02}-in") for n in INPUTS),
    *(pin_out(BIT, f"pin-{n:02}-in-not") for n in INPUTS), pin_in(FLOAT, "reset-time", "ns; this port resets at once"),
], {"read": <size_t>&parport_read, "write": <size_t>&parport_write, "reset": <size_t>&parport_reset}, uses_fp=False)
