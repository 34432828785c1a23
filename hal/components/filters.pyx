"""Components that limit or smooth a value over time. See ``declare.py``."""

from libc.math cimport fabs, floor
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
    double old_in
    uint32_t ending  # halving periods that are left

# A way with bounded acceleration, in periods: velocities differ by `step`, the most that one period allows.
cdef struct Way:
    double v  # per s, of the last period
    double rest  # way to the goal, per s: what one period would need
    double step  # per s
    double fastest  # per s, towards the goal

cdef bint can_brake(double v, double rest, double step) noexcept nogil:
    """Whether a period at `v`, then slower by `step` each period, ends before the goal."""
    cdef double n
    if v <= 0.0:
        return True
    n = floor(v / step * (1.0 + 1e-12))
    return v + n * v - step * 0.5 * n * (n + 1.0) <= rest + 1e-9 * fabs(rest)

cdef double next_velocity(Way way) noexcept nogil:
    """Full acceleration as long as braking still ends at the goal, then full braking; the last period lands on it."""
    cdef double faster
    if way.rest < 0.0:
        return -next_velocity(Way(-way.v, -way.rest, way.step, way.fastest))
    if fabs(way.rest - way.v) <= way.step and way.rest <= way.step:
        return way.rest
    faster = min(way.v + way.step, max(way.fastest, way.v - way.step))
    return faster if can_brake(faster, way.rest, way.step) else way.v - way.step

cdef double ending_velocity(Limit3* s, Way way) noexcept nogil:
    """As `next_velocity`, but the last of more than two smooth steps halve the velocity each, where that arrives."""
    cdef double v, shares
    if s.ending == 0 and at(s.smooth_steps).u > 2:
        v = fabs(way.rest) / (2.0 - 0.125)
        if way.v * way.rest > 0.0 and fabs(v - fabs(way.v)) <= way.step and way.step < v <= 2.0 * way.step:
            s.ending = 4
    if s.ending > 0:
        s.ending -= 1
        shares = 2.0 - 1.0 / (1 << s.ending)
        v = way.rest / shares
        if fabs(v - way.v) <= way.step * (1.0 + 1e-9):
            return v
        s.ending = 0
    return next_velocity(way)

cdef double limited_velocity(Limit3* s, double target, double dt) noexcept nogil:
    """Velocity of this period: catch the target, moving or not, and be able to stop at min and max."""
    cdef double out = at(s.out).f, maxv = at(s.maxv).f, step = at(s.maxa).f * dt
    cdef double target_v = (target - s.old_in) / dt
    cdef double rest = (s.old_in - out) / dt
    cdef double v, lowest, highest
    if fabs(target_v) > maxv:  # a jump: come to rest there
        target_v = 0.0
        rest = (target - out) / dt
    v = target_v + ending_velocity(s, Way(s.v - target_v, rest, step, maxv - target_v if rest > 0.0 else maxv + target_v))
    highest = next_velocity(Way(s.v, (at(s.max_).f - out) / dt, step, maxv))
    lowest = next_velocity(Way(s.v, (at(s.min_).f - out) / dt, step, maxv))
    return clamped(clamped(v, lowest, highest), s.v - step, s.v + step)

cdef void limit3(Limit3* s, long period) noexcept nogil:
    cdef double dt = period * 1e-9
    cdef double target = at(s.in_).f if at(s.enable).b else 0.0
    cdef double out
    if at(s.load).b:
        s.v = 0.0
        at(s.out).f = clamped(target, at(s.min_).f, at(s.max_).f)
    else:
        s.v = limited_velocity(s, target, dt)
        out = at(s.out).f + s.v * dt
        at(s.out).f = target if fabs(out - target) < 1e-12 * fabs(target) else out
    s.old_in = target

declare("limit3", "Limit a value, its velocity and its acceleration", sizeof(Limit3), [
    pin_in(FLOAT, "in"), pin_in(BIT, "enable", "false: go to 0, within the limits", True), pin_out(FLOAT, "out"),
    pin_in(BIT, "load", "set out to in at once"), pin_in(FLOAT, "min", "", -1e20), pin_in(FLOAT, "max", "", 1e20),
    pin_in(FLOAT, "maxv", "per s", 1e20), pin_in(FLOAT, "maxa", "per s^2", 1e20),
    pin_in(U32, "smooth-steps", "more than 2: the last periods before the target halve the velocity", 2),
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
