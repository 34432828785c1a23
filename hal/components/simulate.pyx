"""Stand-ins for hardware: a spindle, home switches, an encoder, signals to test with. See ``declare.py``."""

from libc.math cimport M_PI, cos, fabs, floor, sin
from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t

from hal.cell cimport hal_at as at, hal_pin

from hal.components.declare import BIT, FLOAT, S32, U32, declare, param_rw, pin_in, pin_io, pin_out


cdef struct SimSpindle:
    hal_pin velocity_cmd, position_fb, index_enable, scale
    double turned  # revolutions since the start
    double index  # where the position counts from

cdef void sim_spindle(SimSpindle* s, long period) noexcept nogil:
    cdef double before = s.turned
    s.turned += at(s.velocity_cmd).f * at(s.scale).f * period * 1e-9
    if at(s.index_enable).b and floor(s.turned) != floor(before):
        s.index = max(floor(s.turned), floor(before))
        at(s.index_enable).b = 0
    at(s.position_fb).f = s.turned - s.index

declare("sim_spindle", "Simulated spindle with index pulse", sizeof(SimSpindle), [
    pin_in(FLOAT, "velocity-cmd"), pin_out(FLOAT, "position-fb", "revolutions"),
    pin_io(BIT, "index-enable", "position-fb is 0 at the next full turn"),
    param_rw(FLOAT, "scale", "velocity-cmd * scale is in revolutions per s", 1.0),
], {"": <size_t>&sim_spindle})


cdef struct SimHomeSwitch:
    hal_pin cur_pos, home_pos, hysteresis, home_sw, index_enable, index_delay_ms
    double waited  # s since index-enable was set

cdef void sim_home_switch(SimHomeSwitch* s, long period) noexcept nogil:
    """Closed from the home position on, away from zero, until the joint is back by the hysteresis."""
    cdef double distance = at(s.cur_pos).f - at(s.home_pos).f
    if at(s.home_pos).f < 0.0:
        distance = -distance
    if distance >= 0.0:
        at(s.home_sw).b = 1
    elif distance < -at(s.hysteresis).f:
        at(s.home_sw).b = 0
    if at(s.index_enable).b:
        if s.waited >= at(s.index_delay_ms).f * 1e-3 - 1e-12:
            at(s.index_enable).b = 0
        s.waited += period * 1e-9
    if not at(s.index_enable).b:
        s.waited = 0.0

declare("sim_home_switch", "Home switch and index pulse for simulated joints", sizeof(SimHomeSwitch), [
    pin_in(FLOAT, "cur-pos", "position, mostly joint.N.motor-pos-fb"), pin_in(FLOAT, "home-pos", "", 1.0),
    pin_in(FLOAT, "hysteresis", "way back until the switch opens", 0.1), pin_out(BIT, "home-sw", "switch closed"),
    pin_io(BIT, "index-enable", "cleared after the delay; mostly joint.N.index-enable"),
    pin_in(FLOAT, "index-delay-ms", "ms", 10.0),
], {"": <size_t>&sim_home_switch})


cdef enum:
    KEYS = 64

cdef struct SimMatrixKb:
    hal_pin out
    hal_pin button_c00_r[8]
    hal_pin button_c01_r[8]
    hal_pin button_c02_r[8]
    hal_pin button_c03_r[8]
    hal_pin button_c04_r[8]
    hal_pin button_c05_r[8]
    hal_pin button_c06_r[8]
    hal_pin button_c07_r[8]
    uint8_t pressed[KEYS]

cdef void sim_matrix_kb(SimMatrixKb* s, long period) noexcept nogil:
    """One event a period: 0xC0 (pressed) or 0x80 (let go) + 8 row + column; between events 0x40 while a key is held."""
    cdef hal_pin* button = s.button_c00_r
    cdef uint32_t code = 0
    cdef int i
    for i in range(KEYS):
        if (at(button[i]).b != 0) != (s.pressed[i] != 0):
            s.pressed[i] = not s.pressed[i]
            at(s.out).u = (0xC0 if s.pressed[i] else 0x80) + 8 * (i % 8) + i // 8
            return
        if s.pressed[i]:
            code = 0x40
    at(s.out).u = code

declare("sim_matrix_kb", "Simulated matrix keyboard", sizeof(SimMatrixKb), [
    pin_out(U32, "out", "code of a key: 0xC0 pressed, 0x80 let go, + 8 row + column"),
    *(pin_in(BIT, f"button.c0{column}.r{{:02}}", count=8) for column in range(8)),
], {"": <size_t>&sim_matrix_kb})


# ---- sim_axis_hardware ----

cdef enum:
    AXES = 8

AXIS_NAMES = ("X", "X2", "Y", "Y2", "Z", "A", "U", "V")

cdef struct SimAxisHardware:
    hal_pin current_pos[AXES]
    hal_pin homesw_pos[AXES]
    hal_pin maxsw_upper[AXES]
    hal_pin maxsw_lower[AXES]
    hal_pin minsw_upper[AXES]
    hal_pin minsw_lower[AXES]
    hal_pin homesw_hyst[AXES]
    hal_pin homing[AXES]
    hal_pin homesw_out[AXES]
    hal_pin maxsw_out[AXES]
    hal_pin minsw_out[AXES]
    hal_pin bothsw_out[AXES]
    hal_pin maxsw_homesw_out[AXES]
    hal_pin minsw_homesw_out[AXES]
    hal_pin bothsw_homesw_out[AXES]
    hal_pin homesw_all, limitsw_all, limitsw_homesw_all, limit_offset

cdef void sim_axis_hardware(SimAxisHardware* s, long period) noexcept nogil:
    """While an axis homes, the switches that it shares with its limits are its home switch."""
    cdef double pos, offset = at(s.limit_offset).f
    cdef bint home, high, low, limit, homing, any_home = False, any_limit = False
    cdef int i
    for i in range(AXES):
        pos = at(s.current_pos[i]).f
        homing = at(s.homing[i]).b != 0
        home = fabs(pos - at(s.homesw_pos[i]).f) <= 0.5 * at(s.homesw_hyst[i]).f
        high = at(s.maxsw_lower[i]).f + offset < pos < at(s.maxsw_upper[i]).f
        low = at(s.minsw_lower[i]).f <= pos < at(s.minsw_upper[i]).f - offset
        limit = (high or low) and not homing
        at(s.homesw_out[i]).b = home
        at(s.maxsw_out[i]).b = high
        at(s.minsw_out[i]).b = low
        at(s.bothsw_out[i]).b = limit
        at(s.maxsw_homesw_out[i]).b = high or home
        at(s.minsw_homesw_out[i]).b = low or home
        at(s.bothsw_homesw_out[i]).b = limit or home
        any_home = any_home or (home and homing)
        any_limit = any_limit or limit
    at(s.homesw_all).b = any_home
    at(s.limitsw_all).b = any_limit
    at(s.limitsw_homesw_all).b = any_limit or any_home

def axis_in(int type_, str name, str doc = "", default = 0):
    return pin_in(type_, "{word}" + name, doc, default, count=AXES, words=AXIS_NAMES)

def axis_out(str name, str doc = ""):
    return pin_out(BIT, "{word}" + name, doc, count=AXES, words=AXIS_NAMES)

declare("sim_axis_hardware", "Simulated home and limit switches of the axes X, X2, Y, Y2, Z, A, U, V", sizeof(SimAxisHardware), [
    axis_in(FLOAT, "current-pos", "mostly joint.N.motor-pos-fb"), axis_in(FLOAT, "homesw-pos", "middle of the home switch", 1.0),
    axis_in(FLOAT, "maxsw-upper", "end of the upper limit switch"), axis_in(FLOAT, "maxsw-lower", "and its beginning"),
    axis_in(FLOAT, "minsw-upper", "beginning of the lower limit switch"), axis_in(FLOAT, "minsw-lower", "and its end"),
    axis_in(FLOAT, "homesw-hyst", "whole width of the home switch", 0.025), axis_in(BIT, "homing", "homing is in progress"),
    axis_out("homesw-out", "home switch"), axis_out("maxsw-out", "upper limit switch"), axis_out("minsw-out", "lower limit switch"),
    axis_out("bothsw-out", "a limit switch, unless homing"), axis_out("maxsw-homesw-out", "upper limit or home"),
    axis_out("minsw-homesw-out", "lower limit or home"), axis_out("bothsw-homesw-out", "any of them; while homing, home only"),
    pin_out(BIT, "homesw-all", "home switch of an axis that is homing"), pin_out(BIT, "limitsw-all", "a limit switch of any axis"),
    pin_out(BIT, "limitsw-homesw-all", "one of these two"),
    pin_in(FLOAT, "limit-offset", "how far behind the given position the limit switches begin", 0.01),
], {"update": <size_t>&sim_axis_hardware})
