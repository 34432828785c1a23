"""Components that move one axis to and fro to tune it: steptest, axistest. See ``declare.py``."""

from libc.math cimport fabs
from libc.stdint cimport int32_t, uint8_t

from hal.cell cimport hal_at as at, hal_pin
from hal.components.profile cimport Profile, approach

from hal.components.declare import BIT, FLOAT, S32, declare, param_ro, param_rw, pin_in, pin_out

# The members of both, in the order of `COMMON`, with the acceleration last: axistest has none.
cdef struct Trial:
    hal_pin jog_minus, jog_plus, run, maxvel, amplitude, dir, position_cmd, position_fb, running
    hal_pin run_target, run_start, run_low, run_high, pause, epsilon, elapsed, maxaccel
    Profile way
    uint8_t upwards

cdef void begin_run(Trial* s) noexcept nogil:
    """Around the place where it stands, or to one side of it."""
    cdef double size = at(s.amplitude).f
    at(s.run_start).f = at(s.position_fb).f
    at(s.run_low).f = at(s.run_start).f - (0.0 if at(s.dir).s == 1 else size)
    at(s.run_high).f = at(s.run_start).f + (0.0 if at(s.dir).s == 2 else size)
    s.upwards = at(s.dir).s != 2
    at(s.elapsed).f = 0.0
    at(s.running).b = 1

cdef void next_end(Trial* s, double dt) noexcept nogil:
    """Wait out the pause at an end, then aim at the other."""
    if fabs(at(s.position_fb).f - at(s.run_target).f) > at(s.epsilon).f:
        at(s.elapsed).f = 0.0
        return
    at(s.elapsed).f += dt
    if at(s.elapsed).f >= at(s.pause).s:
        s.upwards = not s.upwards
        at(s.elapsed).f = 0.0

cdef void move(Trial* s, double maxaccel, double dt) noexcept nogil:
    cdef double far = 1e3 * at(s.maxvel).f  # a jog's target: it never arrives
    if at(s.run).b and not at(s.running).b:
        begin_run(s)
    if at(s.running).b:
        at(s.run_target).f = at(s.run_start).f
        if at(s.run).b:
            at(s.run_target).f = at(s.run_high).f if s.upwards else at(s.run_low).f
            next_end(s, dt)
        elif fabs(at(s.position_fb).f - at(s.run_start).f) <= at(s.epsilon).f:
            at(s.running).b = 0
        approach(&s.way, at(s.run_target).f, at(s.maxvel).f, maxaccel, dt)
    elif (at(s.jog_plus).b != 0) != (at(s.jog_minus).b != 0):
        approach(&s.way, s.way.pos + (far if at(s.jog_plus).b else -far), at(s.maxvel).f, maxaccel, dt)
    else:
        approach(&s.way, s.way.pos + 0.5 * s.way.vel * fabs(s.way.vel) / maxaccel, at(s.maxvel).f, maxaccel, dt)
    at(s.position_cmd).f = s.way.pos

cdef void steptest(Trial* s, long period) noexcept nogil:
    if at(s.maxaccel).f > 0.0:
        move(s, at(s.maxaccel).f, period * 1e-9)

cdef void axistest(Trial* s, long period) noexcept nogil:
    """Without a limit of acceleration: full velocity within a period."""
    cdef double dt = period * 1e-9
    move(s, max(at(s.maxvel).f, 1e-9) / dt, dt)

COMMON = [
    pin_in(BIT, "jog-minus"), pin_in(BIT, "jog-plus"), pin_in(BIT, "run", "to and fro around where it stands"),
    pin_in(FLOAT, "maxvel", "per s"), pin_in(FLOAT, "amplitude", "of run"),
    pin_in(S32, "dir", "of run: 0 both sides, 1 positive, 2 negative"), pin_out(FLOAT, "position-cmd"),
    pin_in(FLOAT, "position-fb"), pin_out(BIT, "running"), pin_out(FLOAT, "run-target"), pin_out(FLOAT, "run-start"),
    pin_out(FLOAT, "run-low"), pin_out(FLOAT, "run-high"), pin_in(S32, "pause", "at each end, s"),
    param_rw(FLOAT, "epsilon", "how close to an end is there", 0.001), param_ro(FLOAT, "elapsed", "of a pause, s"),
]
for name, entries, functions in (
    ("steptest", [*COMMON, pin_in(FLOAT, "maxaccel", "per s^2")], {"": <size_t>&steptest}),
    ("axistest", COMMON, {"update": <size_t>&axistest}),
):
    declare(name, "Moves an axis to and fro for tuning", sizeof(Trial), entries, functions)
