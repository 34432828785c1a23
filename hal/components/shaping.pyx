"""Components that shape a value on its way: second-order and Kalman filters, profiles, knobs, gears. See ``declare.py``."""

from libc.math cimport M_PI, cos, fabs, pow, sin
from libc.stdint cimport int32_t, uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin
from hal.components.profile cimport Profile, approach, slow_down

from hal.components.declare import BIT, FLOAT, S32, U32, declare, param_rw, pin_in, pin_out


# ---- biquad ----

cdef struct Biquad:
    hal_pin in_, out, enable, valid, type, f0, Q, s1, s2, d1, d2, n0, n1, n2
    uint8_t old_enable

cdef void design(Biquad* s, double rate_hz) noexcept nogil:
    """Coefficients by the bilinear transform, warped so that f0 is met."""
    cdef double f0 = at(s.f0).f, q = at(s.Q).f, w = 2.0 * M_PI * f0 / rate_hz
    cdef double alpha = sin(w) / (2.0 * q), d0 = 1.0 + alpha
    cdef bint notch = at(s.type).u == 2
    if not 0.5 <= q <= 2.0 or f0 > 0.5 * rate_hz:
        at(s.valid).b = 0
        return
    at(s.n0).f = at(s.n2).f = (1.0 if notch else 0.5 * (1.0 - cos(w))) / d0
    at(s.n1).f = (-2.0 * cos(w) if notch else 1.0 - cos(w)) / d0
    at(s.d1).f = -2.0 * cos(w) / d0
    at(s.d2).f = (1.0 - alpha) / d0
    at(s.valid).b = 1

cdef void biquad(Biquad* s, long period) noexcept nogil:
    cdef double x = at(s.in_).f, y
    if at(s.enable).b and not s.old_enable:
        if at(s.type).u == 0:
            at(s.valid).b = 1
        else:
            design(s, 1e9 / period)
    s.old_enable = at(s.enable).b
    if not at(s.enable).b or not at(s.valid).b:
        at(s.out).f = x
        return
    y = x * at(s.n0).f + at(s.s1).f
    at(s.s1).f = x * at(s.n1).f - y * at(s.d1).f + at(s.s2).f
    at(s.s2).f = x * at(s.n2).f - y * at(s.d2).f
    at(s.out).f = y

declare("biquad", "Filter of the second order: (n0 + n1 z^-1 + n2 z^-2) / (1 + d1 z^-1 + d2 z^-2)", sizeof(Biquad), [
    pin_in(FLOAT, "in"), pin_out(FLOAT, "out"), pin_in(BIT, "enable", "false: out is in; its rising edge starts the filter"),
    pin_out(BIT, "valid", "f0 and Q give a filter: f0 at most half of the thread's rate, Q from 0.5 to 2"),
    pin_in(U32, "type", "0: coefficients as they are, 1: low pass, 2: notch, from f0 and Q"),
    pin_in(FLOAT, "f0", "Hz", 250.0), pin_in(FLOAT, "Q", "", 0.7071), pin_out(FLOAT, "s1", "state"), pin_out(FLOAT, "s2", "state"),
    param_rw(FLOAT, "d1"), param_rw(FLOAT, "d2"), param_rw(FLOAT, "n0", "", 1.0), param_rw(FLOAT, "n1"), param_rw(FLOAT, "n2"),
], {"": <size_t>&biquad})


# ---- Kalman ----

cdef struct Kalman:
    hal_pin debug, passthrough, reset, zk, xk_out, Rk, Qk
    double estimate, covariance
    uint8_t started

cdef void filter_kalman(Kalman* s, long period) noexcept nogil:
    cdef double gain
    if at(s.reset).b or not s.started:
        s.started = 1
        s.estimate = 0.0
        s.covariance = 1.0
        at(s.xk_out).f = 0.0
        if at(s.reset).b:
            return
    if at(s.passthrough).b:
        at(s.xk_out).f = at(s.zk).f
        return
    s.covariance += at(s.Qk).f
    gain = s.covariance / (s.covariance + at(s.Rk).f)
    s.estimate += gain * (at(s.zk).f - s.estimate)
    s.covariance *= 1.0 - gain
    at(s.xk_out).f = s.estimate

declare("filter_kalman", "Kalman filter of one value", sizeof(Kalman), [
    pin_in(BIT, "debug", "without effect"), pin_in(BIT, "passthrough", "copy zk to xk-out"),
    pin_in(BIT, "reset", "begin again, with xk-out 0"), pin_in(FLOAT, "zk", "measured"), pin_out(FLOAT, "xk-out", "estimated"),
    param_rw(FLOAT, "Rk", "covariance of the measurement's noise", 1.17549e-38),
    param_rw(FLOAT, "Qk", "covariance of the process's noise", 1.17549e-38),
], {"": <size_t>&filter_kalman})


# ---- trapezoidal profile ----

cdef struct SimpleTp:
    hal_pin target_pos, maxvel, maxaccel, enable, current_pos, current_vel, active

cdef void simple_tp(SimpleTp* s, long period) noexcept nogil:
    cdef double dt = period * 1e-9
    cdef Profile way = Profile(at(s.current_pos).f, at(s.current_vel).f)
    if at(s.enable).b:
        at(s.active).b = approach(&way, at(s.target_pos).f, at(s.maxvel).f, at(s.maxaccel).f, dt)
    else:
        at(s.active).b = slow_down(&way, at(s.maxaccel).f, dt)
    at(s.current_pos).f, at(s.current_vel).f = way.pos, way.vel

declare("simple_tp", "Way of one axis to a target, with limits of velocity and acceleration", sizeof(SimpleTp), [
    pin_in(FLOAT, "target-pos"), pin_in(FLOAT, "maxvel", "per s"), pin_in(FLOAT, "maxaccel", "per s^2"),
    pin_in(BIT, "enable", "false: come to rest"), pin_out(FLOAT, "current-pos"), pin_out(FLOAT, "current-vel", "per s"),
    pin_out(BIT, "active", "on its way"),
], {"update": <size_t>&simple_tp})


# ---- feed, gears ----

cdef struct Feedcomp:
    hal_pin out, in_, enable, vel, feed

cdef void feedcomp(Feedcomp* s, long period) noexcept nogil:
    at(s.out).f = at(s.in_).f * at(s.vel).f / at(s.feed).f if at(s.enable).b and at(s.feed).f != 0.0 else at(s.in_).f

declare("feedcomp", "A value in proportion to the velocity", sizeof(Feedcomp), [
    pin_out(FLOAT, "out", "in * vel / feed"), pin_in(FLOAT, "in"), pin_in(BIT, "enable", "false: out is in"),
    pin_in(FLOAT, "vel"), param_rw(FLOAT, "feed", "velocity at which out is in"),
], {"": <size_t>&feedcomp})


cdef struct Gearchange:
    hal_pin sel, speed_in, speed_out, dir_in, dir_out, min1, max1, min2, max2, scale2, reverse

cdef double between(double speed, double low, double high) noexcept nogil:
    """The speed with its amount between the limits."""
    cdef double amount = min(max(fabs(speed), low), high)
    return -amount if speed < 0.0 else amount

cdef void gearchange(Gearchange* s, long period) noexcept nogil:
    at(s.scale2).f = max(at(s.scale2).f, 1.0)
    if at(s.sel).b:
        at(s.speed_out).f = between(at(s.speed_in).f, at(s.min2).f, at(s.max2).f) / at(s.scale2).f
        at(s.dir_out).b = (at(s.dir_in).b != 0) != (at(s.reverse).b != 0)
    else:
        at(s.speed_out).f = between(at(s.speed_in).f, at(s.min1).f, at(s.max1).f)
        at(s.dir_out).b = at(s.dir_in).b

declare("gearchange", "Spindle speed for one of two gears", sizeof(Gearchange), [
    pin_in(BIT, "sel", "true for the second gear"), pin_in(FLOAT, "speed-in"), pin_out(FLOAT, "speed-out"),
    pin_in(BIT, "dir-in"), pin_out(BIT, "dir-out"), param_rw(FLOAT, "min1", "least speed in the first gear"),
    param_rw(FLOAT, "max1", "", 100000.0), param_rw(FLOAT, "min2", "least speed in the second gear"),
    param_rw(FLOAT, "max2", "", 100000.0), param_rw(FLOAT, "scale2", "how much faster the second gear is, at least 1", 1.0),
    param_rw(BIT, "reverse", "the second gear turns the other way"),
], {"": <size_t>&gearchange})


# ---- knobs ----

cdef struct Knob2float:
    hal_pin counts, enable, scale, out, max_out, min_out
    int32_t old_counts

cdef void knob2float(Knob2float* s, long period) noexcept nogil:
    cdef int32_t turned = <int32_t>(<uint32_t>at(s.counts).s - <uint32_t>s.old_counts)
    s.old_counts = at(s.counts).s
    if at(s.enable).b:
        at(s.out).f += turned * at(s.scale).f
    at(s.out).f = min(max(at(s.out).f, at(s.min_out).f), at(s.max_out).f)

declare("knob2float", "A value that a knob's counts change", sizeof(Knob2float), [
    pin_in(S32, "counts"), pin_in(BIT, "enable", "false: out stays as it is"), pin_in(FLOAT, "scale", "of out for a count"),
    pin_out(FLOAT, "out"), param_rw(FLOAT, "max-out", "", 1.0), param_rw(FLOAT, "min-out"),
], {"": <size_t>&knob2float})


cdef struct Joyhandle:
    hal_pin in_, out, power, deadband, scale, offset, inverse

cdef double curved(double x, double power, double dead) noexcept nogil:
    """a x^power + b x through (dead, 0) and (1, 1)."""
    cdef double a = 1.0 if dead <= 0.0 else dead / (dead - pow(dead, power))
    return a * pow(x, power) + (1.0 - a) * x

cdef void joyhandle(Joyhandle* s, long period) noexcept nogil:
    cdef double x = min(fabs(at(s.in_).f), 1.0), dead = at(s.deadband).f, y
    if x < dead or x == 0.0:
        at(s.out).f = 0.0
        return
    if at(s.inverse).b:
        y = 1.0 - curved(1.0 + dead - x, at(s.power).f, dead)
    else:
        y = curved(x, at(s.power).f, dead)
    y = y * at(s.scale).f + at(s.offset).f
    at(s.out).f = -y if at(s.in_).f < 0.0 else y

declare("joyhandle", "Curve for a joystick, fine in the middle", sizeof(Joyhandle), [
    pin_in(FLOAT, "in", "-1 to 1"), pin_out(FLOAT, "out", "scale * (a in^power + b in) + offset"),
    param_rw(FLOAT, "power", "at least 1", 2.0), param_rw(FLOAT, "deadband", "out is 0 below it"),
    param_rw(FLOAT, "scale", "", 1.0), param_rw(FLOAT, "offset"), param_rw(BIT, "inverse", "fine at the ends instead"),
], {"": <size_t>&joyhandle})
