"""Components that limit or smooth a value over time. See ``declare.py``."""

from libc.math cimport ceil, fabs, sqrt
from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, param_rw, pin_in, pin_out


cdef double clamped(double value, double low, double high) noexcept nogil:
    return low if value < low else high if value > high else value


cdef struct Limit1:
    hal_pin in_, out, min_, max_

cdef void limit1(Limit1* s, long period) noexcept nogil:
    at(s.out).f = clamped(at(s.in_).f, at(s.min_).f, at(s.max_).f)

declare("limit1", "Limit a value", sizeof(Limit1), [
    pin_in(FLOAT, "in"), pin_out(FLOAT, "out"), pin_in(FLOAT, "min", "", -1e20), pin_in(FLOAT, "max", "", 1e20),
], {"": <size_t>&limit1})


cdef struct Limit2:
    hal_pin in_, out, load, min_, max_, maxv

cdef void limit2(Limit2* s, long period) noexcept nogil:
    cdef double target = clamped(at(s.in_).f, at(s.min_).f, at(s.max_).f)
    cdef double step = at(s.maxv).f * period * 1e-9
    cdef double out = at(s.out).f
    at(s.out).f = target if at(s.load).b else clamped(target, out - step, out + step)

declare("limit2", "Limit a value and how fast it changes", sizeof(Limit2), [
    pin_in(FLOAT, "in"), pin_out(FLOAT, "out"), pin_in(BIT, "load", "set out to in at once"),
    pin_in(FLOAT, "min", "", -1e20), pin_in(FLOAT, "max", "", 1e20), pin_in(FLOAT, "maxv", "per s", 1e20),
], {"": <size_t>&limit2})


cdef struct Limit3:
    hal_pin in_, enable, out, load, min_, max_, maxv, maxa, smooth_steps
    double v  # per s, of the last period
    double old_target
    uint8_t started

cdef double approach(double distance, double maxa, double dt) noexcept nogil:
    """The highest velocity of this period after which braking by `maxa` in whole periods still ends at the distance.

    Of `n` periods the first goes at v and each later one slower by `step`: n v - step n (n - 1) / 2 periods' ways in all.
    """
    cdef double step = maxa * dt
    cdef double ways = fabs(distance) / dt
    cdef double n, v
    if ways <= step:
        v = ways
    else:
        n = ceil(0.5 * (sqrt(1.0 + 8.0 * ways / step) - 1.0) - 1e-9)
        v = ways / n + 0.5 * step * (n - 1.0)
    return -v if distance < 0.0 else v

cdef double limited_velocity(Limit3* s, double target, double dt) noexcept nogil:
    """Velocity of this period: catch the target, moving or not, and be able to stop at min and max."""
    cdef double out = at(s.out).f, maxv = at(s.maxv).f, maxa = at(s.maxa).f
    cdef double target_v = (target - s.old_target) / dt
    cdef double v, rest
    if fabs(target_v) > maxv:
        target_v = 0.0  # a jump: come to rest there
    rest = target - out - target_v * dt
    v = target_v + approach(rest, maxa, dt)
    if fabs(v) > fabs(s.v) and at(s.smooth_steps).u > 0:
        v = clamped(v, -max(fabs(s.v), fabs(target_v) + fabs(rest) / (at(s.smooth_steps).u * dt)),
                    max(fabs(s.v), fabs(target_v) + fabs(rest) / (at(s.smooth_steps).u * dt)))
    v = clamped(v, max(-maxv, approach(at(s.min_).f - out, maxa, dt)), min(maxv, approach(at(s.max_).f - out, maxa, dt)))
    return clamped(v, s.v - maxa * dt, s.v + maxa * dt)

cdef void limit3(Limit3* s, long period) noexcept nogil:
    cdef double dt = period * 1e-9
    cdef double target = clamped(at(s.in_).f if at(s.enable).b else 0.0, at(s.min_).f, at(s.max_).f)
    if not s.started:
        s.started = 1
        s.old_target = target
    if at(s.load).b:
        s.v = 0.0
        at(s.out).f = target
    else:
        s.v = limited_velocity(s, target, dt)
        at(s.out).f += s.v * dt
        if fabs(at(s.out).f - target) < 1e-12 * fabs(target):
            at(s.out).f = target
    s.old_target = target

declare("limit3", "Limit a value, its velocity and its acceleration", sizeof(Limit3), [
    pin_in(FLOAT, "in"), pin_in(BIT, "enable", "false: go to 0, within the limits", True), pin_out(FLOAT, "out"),
    pin_in(BIT, "load", "set out to in at once"), pin_in(FLOAT, "min", "", -1e20), pin_in(FLOAT, "max", "", 1e20),
    pin_in(FLOAT, "maxv", "per s", 1e20), pin_in(FLOAT, "maxa", "per s^2", 1e20),
    pin_in(U32, "smooth-steps", "periods before the target in which out accelerates no more", 2),
], {"": <size_t>&limit3})


cdef struct Lowpass:
    hal_pin in_, out, load, gain

cdef void lowpass(Lowpass* s, long period) noexcept nogil:
    if at(s.load).b:
        at(s.out).f = at(s.in_).f
    else:
        at(s.out).f += (at(s.in_).f - at(s.out).f) * at(s.gain).f

declare("lowpass", "Low-pass filter of the first order", sizeof(Lowpass), [
    pin_in(FLOAT, "in"), pin_out(FLOAT, "out", "moves by (in - out) * gain each period"),
    pin_in(BIT, "load", "set out to in at once"), param_rw(FLOAT, "gain", "1 - e^(-a * period), for a pole at a rad/s"),
], {"": <size_t>&lowpass})


cdef struct Ilowpass:
    hal_pin in_, out, scale, gain
    double value  # of the filter, in input counts
    double total  # of the input
    int32_t old_in

cdef void ilowpass(Ilowpass* s, long period) noexcept nogil:
    """The sum is kept in floating point; the output is its lowest 32 bits, so it wraps like a counter."""
    cdef int32_t count = at(s.in_).s
    s.total += <int32_t>(<uint32_t>count - <uint32_t>s.old_in)
    s.old_in = count
    s.value += (s.total - s.value) * at(s.gain).f
    at(s.out).s = <int32_t><uint32_t><int64_t>(s.value * at(s.scale).f + (0.5 if s.value >= 0.0 else -0.5))

declare("ilowpass", "Low-pass filter of a counter, scaled up for finer steps", sizeof(Ilowpass), [
    pin_in(S32, "in"), pin_out(S32, "out", "in * scale, smoothed; wraps at 32 bits"),
    param_rw(FLOAT, "scale", "", 1024.0), param_rw(FLOAT, "gain", "", 0.5),
], {"": <size_t>&ilowpass})


cdef struct SampleHold:
    hal_pin in_, out, hold

cdef void sample_hold(SampleHold* s, long period) noexcept nogil:
    if not at(s.hold).b:
        at(s.out).s = at(s.in_).s

declare("sample_hold", "Copy the input, or hold what it was", sizeof(SampleHold), [
    pin_in(S32, "in"), pin_out(S32, "out"), pin_in(BIT, "hold", "keep out as it is"),
], {"": <size_t>&sample_hold}, uses_fp=False)
