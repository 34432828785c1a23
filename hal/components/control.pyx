"""Control and test signals: pid with relay auto-tuning, siggen, supply, timedelta. See ``declare.py``."""

from libc.math cimport M_PI, cos, fabs, sin
from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t
from posix.time cimport CLOCK_MONOTONIC, clock_gettime, timespec

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, pin_in, pin_io, pin_out


# ---- pid ----

cdef struct Pid:
    hal_pin enable, command, command_deriv, feedback, feedback_deriv, error, output, saturated, saturated_s
    hal_pin saturated_count, Pgain, Igain, Dgain, FF0, FF1, FF2, FF3, bias, deadband, maxerror, maxerrorI, maxerrorD
    hal_pin maxcmdD, maxcmdDD, maxcmdDDD, maxoutput, index_enable, error_previous_target
    hal_pin tune_mode, tune_start, tune_type, tune_cycles, tune_effort
    hal_pin errorI, errorD, commandD, commandDD, commandDDD, ultimate_gain, ultimate_period
    double old_command, old_feedback, sum_error, cmd_d, cmd_dd, cmd_ddd, error_d
    uint8_t old_index
    int32_t limited  # 1 at the upper limit, -1 at the lower
    # auto-tuning
    uint8_t tuning, relay_high
    uint32_t cycles
    double effort, highest, lowest, swing_sum, period_sum, period_s


cdef double within(double value, double limit) noexcept nogil:
    """`value` cut to +-limit; a limit of 0 is none."""
    return min(max(value, -limit), limit) if limit > 0.0 else value


cdef double beyond(double value, double deadband) noexcept nogil:
    """What of `value` lies outside of +-deadband."""
    if value > deadband:
        return value - deadband
    return value + deadband if value < -deadband else 0.0


cdef bint linked(hal_pin pin) noexcept nogil:
    """Whether the pin's word points away from the pin's own cell, which follows it."""
    return pin[0] != sizeof(int64_t)


cdef void derive_command(Pid* s, double dt) noexcept nogil:
    cdef double old_d = s.cmd_d, old_dd = s.cmd_dd
    cdef bint index_fell = s.old_index and not at(s.index_enable).b
    if linked(s.command_deriv):
        s.cmd_d = at(s.command_deriv).f
    elif not index_fell:  # at an index the command jumps, and that is no speed
        s.cmd_d = (at(s.command).f - s.old_command) / dt
    s.old_index = at(s.index_enable).b
    s.old_command = at(s.command).f
    s.cmd_d = within(s.cmd_d, at(s.maxcmdD).f)
    s.cmd_dd = within((s.cmd_d - old_d) / dt, at(s.maxcmdDD).f)
    s.cmd_ddd = within((s.cmd_dd - old_dd) / dt, at(s.maxcmdDDD).f)


cdef void derive_error(Pid* s, double dt) noexcept nogil:
    """How fast command and feedback part."""
    cdef double feedback_d = (at(s.feedback).f - s.old_feedback) / dt
    if linked(s.feedback_deriv):
        feedback_d = at(s.feedback_deriv).f
    s.old_feedback = at(s.feedback).f
    s.error_d = within(s.cmd_d - feedback_d, at(s.maxerrorD).f)


cdef void put_output(Pid* s, double output, double dt) noexcept nogil:
    cdef double limit = at(s.maxoutput).f
    cdef double cut = within(output, limit)
    s.limited = (output > cut) - (output < cut)
    at(s.output).f = cut
    at(s.saturated).b = s.limited != 0
    if s.limited:
        at(s.saturated_s).f += dt
        if at(s.saturated_count).s < 2147483647:
            at(s.saturated_count).s += 1
    else:
        at(s.saturated_s).f = 0.0
        at(s.saturated_count).s = 0


cdef void finish_tuning(Pid* s) noexcept nogil:
    """Ziegler and Nichols' gains from the limit cycle's amplitude and period."""
    cdef double amplitude = s.swing_sum / s.cycles / 2.0
    cdef double period = s.period_sum / s.cycles
    cdef double ultimate
    if amplitude <= 0.0 or period <= 0.0:
        return
    ultimate = 4.0 * fabs(s.effort) / (M_PI * amplitude)
    if s.ultimate_gain != NULL:
        at(s.ultimate_gain).f = ultimate
        at(s.ultimate_period).f = period
    if at(s.tune_type).u == 0:
        at(s.Pgain).f = 0.6 * ultimate
        at(s.Igain).f = 1.2 * ultimate / period
        at(s.Dgain).f = 0.075 * ultimate * period
    else:
        at(s.Pgain).f = 0.45 * ultimate
        at(s.Igain).f = 0.54 * ultimate / period
        at(s.FF1).f = 1.0


cdef void tune(Pid* s, double error, double dt) noexcept nogil:
    """Relay feedback: full effort either way, turned over each time the error changes sign."""
    if at(s.tune_start).b and not s.tuning:
        s.tuning = 1
        s.relay_high = error > 0.0
        s.cycles = 0
        s.effort = at(s.tune_effort).f
        s.highest = s.lowest = error
        s.swing_sum = s.period_sum = s.period_s = 0.0
    if not s.tuning:
        at(s.output).f = at(s.bias).f
        return
    s.period_s += dt
    s.highest = max(s.highest, error)
    s.lowest = min(s.lowest, error)
    if s.relay_high and error < 0.0:
        s.relay_high = 0
    elif not s.relay_high and error > 0.0:
        s.relay_high = 1
        s.cycles += 1
        s.swing_sum += s.highest - s.lowest
        s.period_sum += s.period_s
        s.highest = s.lowest = error
        s.period_s = 0.0
        if s.cycles >= max(at(s.tune_cycles).u, <uint32_t>1):
            finish_tuning(s)
            s.tuning = 0
            at(s.tune_start).b = 0
    at(s.output).f = at(s.bias).f + (s.effort if s.relay_high else -s.effort)


cdef double control(Pid* s, double error) noexcept nogil:
    return (at(s.bias).f + error * at(s.Pgain).f + s.sum_error * at(s.Igain).f + s.error_d * at(s.Dgain).f
            + at(s.command).f * at(s.FF0).f + s.cmd_d * at(s.FF1).f + s.cmd_dd * at(s.FF2).f + s.cmd_ddd * at(s.FF3).f)


cdef void show_insides(Pid* s) noexcept nogil:
    if s.errorI != NULL:
        at(s.errorI).f = s.sum_error
        at(s.errorD).f = s.error_d
        at(s.commandD).f = s.cmd_d
        at(s.commandDD).f = s.cmd_dd
        at(s.commandDDD).f = s.cmd_ddd


cdef void pid(Pid* s, long period) noexcept nogil:
    cdef double dt = period * 1e-9
    cdef double target = s.old_command if at(s.error_previous_target).b else at(s.command).f
    cdef double error = target - at(s.feedback).f
    at(s.error).f = error
    error = beyond(error, at(s.deadband).f)
    error = within(error, at(s.maxerror).f)
    derive_command(s, dt)
    derive_error(s, dt)
    if not at(s.enable).b or at(s.tune_mode).b:
        s.sum_error = 0.0
        s.limited = 0
        if at(s.enable).b:
            tune(s, error, dt)
        else:
            s.tuning = 0
            at(s.tune_start).b = 0
            put_output(s, 0.0, dt)
        show_insides(s)
        return
    s.tuning = 0
    if s.limited * error <= 0.0:  # no winding up against the limit
        s.sum_error = within(s.sum_error + error * dt, at(s.maxerrorI).f)
    put_output(s, control(s, error), dt)
    show_insides(s)


def debug_of(dict args) -> list:
    """debug=1 is a personality of all channels."""
    return [int(args.get("debug", "0") or 0)] * 16


def when_debug(personality):
    return int(personality != 0)


declare("pid", "Proportional, integral and derivative controller with feed-forward and auto-tuning; debug=1 adds the "
        "values within", sizeof(Pid), [
    pin_in(BIT, "enable", "false: output 0, integrators reset"), pin_in(FLOAT, "command"),
    pin_in(FLOAT, "command-deriv", "taken from the command where it is not linked"), pin_in(FLOAT, "feedback"),
    pin_in(FLOAT, "feedback-deriv", "taken from the feedback where it is not linked"),
    pin_out(FLOAT, "error", "command - feedback"), pin_out(FLOAT, "output"), pin_out(BIT, "saturated", "output is limited"),
    pin_out(FLOAT, "saturated-s", "for how long, s"), pin_out(S32, "saturated-count", "for how many periods"),
    pin_in(FLOAT, "Pgain", "", 1.0), pin_in(FLOAT, "Igain"), pin_in(FLOAT, "Dgain"), pin_in(FLOAT, "FF0", "of the command"),
    pin_in(FLOAT, "FF1", "of its derivative"), pin_in(FLOAT, "FF2", "of its second derivative"),
    pin_in(FLOAT, "FF3", "of its third derivative"), pin_in(FLOAT, "bias"), pin_in(FLOAT, "deadband", "so much of the error is ignored"),
    pin_in(FLOAT, "maxerror", "limits of 0 are none"), pin_in(FLOAT, "maxerrorI"), pin_in(FLOAT, "maxerrorD"),
    pin_in(FLOAT, "maxcmdD"), pin_in(FLOAT, "maxcmdDD"), pin_in(FLOAT, "maxcmdDDD"), pin_in(FLOAT, "maxoutput"),
    pin_in(BIT, "index-enable", "its falling edge excuses a jump of the command"),
    pin_in(BIT, "error-previous-target", "error against the command of the last period, as motion sees it", True),
    pin_in(BIT, "tune-mode", "tune instead of control"), pin_io(BIT, "tune-start", "begin; false again when done"),
    pin_io(U32, "tune-type", "0: P, I and D; 1: P, I and FF1"), pin_io(U32, "tune-cycles", "to average over", 50),
    pin_io(FLOAT, "tune-effort", "output of the relay, either way", 0.5),
    pin_out(FLOAT, "errorI", personal=when_debug), pin_out(FLOAT, "errorD", personal=when_debug),
    pin_out(FLOAT, "commandD", personal=when_debug), pin_out(FLOAT, "commandDD", personal=when_debug),
    pin_out(FLOAT, "commandDDD", personal=when_debug),
    pin_out(FLOAT, "ultimate-gain", "found by tuning", personal=when_debug),
    pin_out(FLOAT, "ultimate-period", "found by tuning, s", personal=when_debug),
], {"do-pid-calcs": <size_t>&pid}, counted_by="num_chan", default_count=3, most=16, options=("debug",), decode=debug_of)


# ---- signals to test with ----

cdef struct Siggen:
    hal_pin square, sawtooth, triangle, sine, cosine, clock, frequency, amplitude, offset, reset
    double phase  # of a period, 0 to 1

cdef double TURN = 2.0 * 3.1415927  # to these digits, as in LinuxCNC: its samples are compared in print

cdef void siggen(Siggen* s, long period) noexcept nogil:
    cdef double amplitude = at(s.amplitude).f, offset = at(s.offset).f
    cdef double ramp, limit = 0.5 / (period * 1e-9)
    if at(s.frequency).f > limit:
        at(s.frequency).f = limit
    if at(s.reset).b:
        s.phase = 0.5
    else:
        s.phase += at(s.frequency).f * period * 1e-9
    if s.phase >= 1.0:
        s.phase -= 1.0
    ramp = 2.0 * s.phase - 1.0
    at(s.clock).b = s.phase > 0.5
    at(s.square).f = (amplitude if s.phase > 0.5 else -amplitude) + offset
    at(s.sawtooth).f = ramp * amplitude + offset
    at(s.triangle).f = (2.0 * fabs(ramp) - 1.0) * amplitude + offset
    at(s.sine).f = sin(TURN * s.phase) * amplitude + offset
    at(s.cosine).f = cos(TURN * s.phase) * amplitude + offset

declare("siggen", "Signal generator", sizeof(Siggen), [
    pin_out(FLOAT, "square", "positive while triangle and cosine rise"),
    pin_out(FLOAT, "sawtooth", "rises; falls while triangle and cosine are highest"), pin_out(FLOAT, "triangle"),
    pin_out(FLOAT, "sine", "lags cosine by 90 degrees"), pin_out(FLOAT, "cosine"), pin_out(BIT, "clock", "square as a bit"),
    pin_in(FLOAT, "frequency", "Hz; at most half of the thread's", 1.0), pin_in(FLOAT, "amplitude", "", 1.0),
    pin_in(FLOAT, "offset", "added to all but clock"), pin_in(BIT, "reset", "hold where the sawtooth crosses zero"),
], {"update": <size_t>&siggen}, counted_by="num_chan", most=16)


cdef struct Supply:
    hal_pin q, _q, variable, _variable, d, value

cdef void supply(Supply* s, long period) noexcept nogil:
    at(s.q).b = at(s.d).b
    at(s._q).b = not at(s.d).b
    at(s.variable).f = at(s.value).f
    at(s._variable).f = -at(s.value).f

declare("supply", "Values set by hand, as outputs; setp and sets have made it unnecessary", sizeof(Supply), [
    pin_out(BIT, "q", "d"), pin_out(BIT, "_q", "not d", True), pin_out(FLOAT, "variable", "value"),
    pin_out(FLOAT, "_variable", "-value"), pin_io(BIT, "d"), pin_io(FLOAT, "value"),
], {"update": <size_t>&supply}, counted_by="num_chan", most=8, takes_names=False)


# ---- the thread's own timing ----

cdef struct Timedelta:
    hal_pin jitter, current_jitter, current_error, min_, max_, reset, out, err, avg_err
    int64_t last
    double total
    uint32_t count

cdef int64_t now_ns() noexcept nogil:
    cdef timespec t
    clock_gettime(CLOCK_MONOTONIC, &t)
    return <int64_t>t.tv_sec * 1000000000 + t.tv_nsec

cdef void timedelta(Timedelta* s, long period) noexcept nogil:
    cdef int64_t now = now_ns()
    cdef int32_t took = <int32_t>(now - s.last)
    cdef int32_t error = <int32_t>(took - period)
    if s.last == 0 or at(s.reset).b:
        at(s.jitter).s = at(s.max_).s = at(s.err).s = 0
        at(s.min_).s = 2147483647
        s.total = 0.0
        s.count = 0
    else:
        at(s.out).s = took
        at(s.current_error).s = error
        at(s.current_jitter).s = error if error >= 0 else -error
        at(s.jitter).s = max(at(s.jitter).s, at(s.current_jitter).s)
        at(s.min_).s = min(at(s.min_).s, took)
        at(s.max_).s = max(at(s.max_).s, took)
        at(s.err).s += error
        s.total += error
        s.count += 1
        at(s.avg_err).f = s.total / s.count
    s.last = now

declare("timedelta", "Timing of the thread that runs it, in ns", sizeof(Timedelta), [
    pin_out(S32, "jitter", "largest difference to the period"), pin_out(S32, "current-jitter"),
    pin_out(S32, "current-error", "positive when late"), pin_out(S32, "min", "shortest time between two runs"),
    pin_out(S32, "max"), pin_in(BIT, "reset", "begin the statistics again"), pin_out(S32, "out", "time since the last run"),
    pin_out(S32, "err", "sum of the errors"), pin_out(FLOAT, "avg-err"),
], {"": <size_t>&timedelta}, uses_fp=False)
