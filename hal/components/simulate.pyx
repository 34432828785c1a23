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
