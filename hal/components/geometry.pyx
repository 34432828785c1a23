"""Coordinates of two and three dimensions, phases of motors, angles of spindles. See ``declare.py``."""

from libc.math cimport fabs, floor, cos, sin, sqrt, M_PI
from libc.stdint cimport int64_t, uint8_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, declare, pin_in, pin_out

cdef double ROOT3 = sqrt(3.0), ROOT2 = sqrt(2.0)


cdef struct Corexy:
    hal_pin alpha_fb, beta_fb, j0_motor_pos_cmd, j1_motor_pos_cmd, j0_motor_pos_fb, j1_motor_pos_fb, alpha_cmd, beta_cmd

cdef void corexy_by_hal(Corexy* s, long period) noexcept nogil:
    cdef double x = at(s.j0_motor_pos_cmd).f, y = at(s.j1_motor_pos_cmd).f
    cdef double alpha = at(s.alpha_fb).f, beta = at(s.beta_fb).f
    at(s.alpha_cmd).f = 0.5 * (x + y)
    at(s.beta_cmd).f = 0.5 * (x - y)
    at(s.j0_motor_pos_fb).f = alpha + beta
    at(s.j1_motor_pos_fb).f = alpha - beta

declare("corexy_by_hal", "Two motors that share one belt, for x and y; with trivkins", sizeof(Corexy), [
    pin_in(FLOAT, "alpha-fb", "of the first motor"), pin_in(FLOAT, "beta-fb", "of the second motor"),
    pin_in(FLOAT, "j0-motor-pos-cmd", "x"), pin_in(FLOAT, "j1-motor-pos-cmd", "y"), pin_out(FLOAT, "j0-motor-pos-fb", "x"),
    pin_out(FLOAT, "j1-motor-pos-fb", "y"), pin_out(FLOAT, "alpha-cmd", "to the first motor"),
    pin_out(FLOAT, "beta-cmd", "to the second motor"),
], {"": <size_t>&corexy_by_hal})


cdef struct Differential:
    hal_pin roll_cmd, pitch_cmd, roll_fb, pitch_fb, motor0_cmd, motor1_cmd, motor0_fb, motor1_fb

cdef void differential(Differential* s, long period) noexcept nogil:
    cdef double roll = at(s.roll_cmd).f, pitch = at(s.pitch_cmd).f
    cdef double motor0 = at(s.motor0_fb).f, motor1 = at(s.motor1_fb).f
    at(s.motor0_cmd).f = roll + pitch
    at(s.motor1_cmd).f = roll - pitch
    at(s.roll_fb).f = 0.5 * (motor0 + motor1)
    at(s.pitch_fb).f = 0.5 * (motor0 - motor1)

declare("differential", "Two motors of a differential transmission, for roll and pitch", sizeof(Differential), [
    pin_in(FLOAT, "roll-cmd", "degrees"), pin_in(FLOAT, "pitch-cmd", "degrees"), pin_out(FLOAT, "roll-fb", "degrees"),
    pin_out(FLOAT, "pitch-fb", "degrees"), pin_out(FLOAT, "motor0-cmd"), pin_out(FLOAT, "motor1-cmd"),
    pin_in(FLOAT, "motor0-fb"), pin_in(FLOAT, "motor1-fb"),
], {"": <size_t>&differential})


cdef struct Clarke2:
    hal_pin a, b, x, y

cdef void clarke2(Clarke2* s, long period) noexcept nogil:
    at(s.x).f = at(s.a).f
    at(s.y).f = (at(s.a).f + 2.0 * at(s.b).f) / ROOT3

declare("clarke2", "Clarke transform of three phases whose sum is 0", sizeof(Clarke2), [
    pin_in(FLOAT, "a", "first phase"), pin_in(FLOAT, "b", "second phase"), pin_out(FLOAT, "x"), pin_out(FLOAT, "y"),
], {"": <size_t>&clarke2})


cdef struct Clarke3:
    hal_pin a, b, c, x, y, h

cdef void clarke3(Clarke3* s, long period) noexcept nogil:
    cdef double a = at(s.a).f, b = at(s.b).f, c = at(s.c).f
    at(s.x).f = (2.0 * a - b - c) / 3.0
    at(s.y).f = (b - c) / ROOT3
    at(s.h).f = (a + b + c) * ROOT2 / 3.0

declare("clarke3", "Clarke transform of three phases", sizeof(Clarke3), [
    pin_in(FLOAT, "a"), pin_in(FLOAT, "b"), pin_in(FLOAT, "c"), pin_out(FLOAT, "x"), pin_out(FLOAT, "y"),
    pin_out(FLOAT, "h", "what the phases have in common, times the root of 2"),
], {"": <size_t>&clarke3})


cdef struct Clarkeinv:
    hal_pin x, y, h, theta, a, b, c

cdef void clarkeinv(Clarkeinv* s, long period) noexcept nogil:
    cdef double angle = 2.0 * M_PI * at(s.theta).f
    cdef double x = at(s.x).f * cos(angle) - at(s.y).f * sin(angle)
    cdef double y = at(s.x).f * sin(angle) + at(s.y).f * cos(angle)
    cdef double common = at(s.h).f / ROOT2
    at(s.a).f = x + common
    at(s.b).f = 0.5 * (ROOT3 * y - x) + common
    at(s.c).f = -0.5 * (ROOT3 * y + x) + common

declare("clarkeinv", "Turn a vector and take it to three phases", sizeof(Clarkeinv), [
    pin_in(FLOAT, "x"), pin_in(FLOAT, "y"), pin_in(FLOAT, "h", "what the phases have in common, times the root of 2"),
    pin_in(FLOAT, "theta", "angle, in turns"), pin_out(FLOAT, "a"), pin_out(FLOAT, "b"), pin_out(FLOAT, "c"),
], {"": <size_t>&clarkeinv})


cdef struct Sphereprobe:
    hal_pin px, py, pz, cx, cy, cz, r, probe_out

cdef void sphereprobe(Sphereprobe* s, long period) noexcept nogil:
    cdef int64_t x = <int64_t>at(s.px).s - at(s.cx).s, y = <int64_t>at(s.py).s - at(s.cy).s
    cdef int64_t z = <int64_t>at(s.pz).s - at(s.cz).s, r = at(s.r).s
    cdef int64_t across = x * x + y * y
    at(s.probe_out).b = across + z * z <= r * r if across <= r * r else z < 0

declare("sphereprobe", "Simulated probe over a ball on a plane that goes through its centre", sizeof(Sphereprobe), [
    pin_in(S32, "px", "place of the probe, counts"), pin_in(S32, "py"), pin_in(S32, "pz"),
    pin_in(S32, "cx", "centre of the ball, counts"), pin_in(S32, "cy"), pin_in(S32, "cz"), pin_in(S32, "r", "its radius, counts"),
    pin_out(BIT, "probe-out", "in the ball; beside it, below the plane"),
], {"": <size_t>&sphereprobe}, uses_fp=False)


cdef struct Orient:
    hal_pin enable, mode, position, angle, command, poserr, is_oriented, tolerance
    uint8_t old_enable

cdef double turned(double position, double fraction, int mode) noexcept nogil:
    """The position with that fraction of a turn: the nearest (mode 0), the next one up (1) or down (2)."""
    cdef double up = floor(position) + fraction
    if up <= position:
        up += 1.0
    if mode == 1:
        return up
    if mode == 2:
        return up - 1.0
    return up if up - position < 0.5 else up - 1.0

cdef void orient(Orient* s, long period) noexcept nogil:
    if at(s.enable).b:
        if not s.old_enable:
            at(s.command).f = turned(at(s.position).f, at(s.angle).f / 360.0, at(s.mode).s)
        at(s.poserr).f = (at(s.position).f - at(s.command).f) * 360.0
        at(s.is_oriented).b = fabs(at(s.poserr).f) < at(s.tolerance).f
    else:
        at(s.is_oriented).b = 0
    s.old_enable = at(s.enable).b

declare("orient", "Position command that turns a spindle to an angle", sizeof(Orient), [
    pin_in(BIT, "enable", "its rising edge sets command"), pin_in(S32, "mode", "0 the shorter way, 1 clockwise, 2 counterclockwise"),
    pin_in(FLOAT, "position", "of the spindle, turns"), pin_in(FLOAT, "angle", "to turn to, degrees"),
    pin_out(FLOAT, "command", "turns"), pin_out(FLOAT, "poserr", "position - command, degrees"),
    pin_out(BIT, "is-oriented", "poserr is within tolerance"), pin_in(FLOAT, "tolerance", "degrees", 0.5),
], {"": <size_t>&orient})
