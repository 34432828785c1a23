"""``raster``: laser power from a line of pixels that arrive through a port while the axis moves. See ``declare.py``.

A program is text: ``offset;bits per pixel;pixels per unit;number of pixels;`` and then the pixels in hexadecimal digits, the
first at `offset` from where the axis stands when `run` rises. Between two pixels the power is linear. The other end of
the port is mostly ``raster.RasterProgrammer``.
"""

from libc.math cimport fabs, floor
from libc.stdint cimport int32_t, uint8_t, uint32_t
from libc.stdlib cimport strtod, strtol

from hal.cell cimport hal_at as at, hal_pin
from hal.port cimport hal_port, port_clear, port_commit, port_of, port_peek, port_readable

from hal._shm import PORT
from hal.components.declare import BIT, FLOAT, S32, declare, pin_in, pin_out

cdef enum:
    FIELD = 32  # longest number of a program's head, with its semicolon
    HEAD = 4  # numbers
    DIGITS = 8  # of a pixel, at most
    # state
    IDLE = 0
    READING = 1  # the program's head
    RUNNING = 2
    FAILED = 3
    # fault-code
    NO_FAULT = 0
    INVALID_OFFSET = 1
    INVALID_BPP = 2
    INVALID_PPU = 3
    INVALID_COUNT = 4
    PROGRAM_UNDERRUN = 5
    WRONG_DIRECTION = 6
    BAD_PIXEL = 7

cdef double OFF = -1.0  # of output: no power asked for

cdef struct Raster:
    hal_pin position, reset, program, run
    hal_pin enabled, output, fault, fault_code, state, program_position, program_offset, bpp, ppu, count
    hal_pin bitmap_position, current_pixel_index, current_pixel_value, previous_pixel_value, fraction
    int field  # of the head, read so far
    double direction  # 1 or -1
    double farthest  # bitmap position


cdef void fail(Raster* s, int code) noexcept nogil:
    at(s.fault).b = 1
    at(s.fault_code).s = code
    at(s.state).s = FAILED
    at(s.enabled).b = 0
    at(s.output).f = OFF


cdef void stop(Raster* s) noexcept nogil:
    """Forget the program and what is left of it."""
    port_clear(port_of(s.program))
    at(s.fault).b = at(s.enabled).b = 0
    at(s.fault_code).s = NO_FAULT
    at(s.state).s = IDLE
    at(s.output).f = OFF
    s.field = 0


cdef bint take_field(Raster* s, char* text) noexcept nogil:
    """The next number of the head as text; False where it is not there yet."""
    cdef hal_port* port = port_of(s.program)
    cdef uint32_t waiting = min(port_readable(port), <uint32_t>FIELD)
    cdef uint32_t i
    if not port_peek(port, text, waiting):
        return False
    for i in range(waiting):
        if text[i] == b";":
            text[i] = 0
            port_commit(port, i + 1)
            return True
    if waiting == FIELD:
        fail(s, INVALID_OFFSET + s.field)
    return False


cdef void read_head(Raster* s) noexcept nogil:
    cdef char text[FIELD]
    cdef char* end
    cdef double value
    while s.field < HEAD and take_field(s, text):
        value = strtod(text, &end)
        if end == text or end[0] != 0 or not right(s, value):
            fail(s, INVALID_OFFSET + s.field)
            return
        s.field += 1
    if s.field == HEAD:
        begin(s)


cdef bint right(Raster* s, double value) noexcept nogil:
    """Store the head's next number; False where it is out of range."""
    if s.field == 0:
        at(s.program_offset).f = value
        return True
    if s.field == 1:
        at(s.bpp).s = <int32_t>value
        return value == at(s.bpp).s and 4 <= at(s.bpp).s <= 4 * DIGITS and at(s.bpp).s % 4 == 0
    if s.field == 2:
        at(s.ppu).f = value
        return value > 0.0
    at(s.count).s = <int32_t>value
    return value == at(s.count).s and at(s.count).s >= 2


cdef void begin(Raster* s) noexcept nogil:
    at(s.program_position).f = at(s.position).f
    s.direction = -1.0 if at(s.program_offset).f < 0.0 else 1.0
    s.farthest = -1e30
    at(s.current_pixel_index).s = -1
    at(s.current_pixel_value).f = at(s.previous_pixel_value).f = 0.0
    at(s.enabled).b = 1
    at(s.state).s = RUNNING


cdef bint next_pixel(Raster* s) noexcept nogil:
    """Take a pixel's digits from the port: its power is 0 to 100 percent for all but the largest value."""
    cdef char text[DIGITS + 1]
    cdef char* end
    cdef int digits = at(s.bpp).s // 4
    cdef double most = (<double>(1 << (at(s.bpp).s - 1)) * 2.0) - 2.0 if at(s.bpp).s < 32 else 4294967294.0
    cdef double value
    if not port_peek(port_of(s.program), text, digits):
        fail(s, PROGRAM_UNDERRUN)
        return False
    text[digits] = 0
    value = <double><uint32_t>strtol(text, &end, 16)
    if end[0] != 0:
        fail(s, BAD_PIXEL)
        return False
    port_commit(port_of(s.program), digits)
    at(s.previous_pixel_value).f = at(s.current_pixel_value).f
    at(s.current_pixel_value).f = OFF if value > most else 100.0 * value / most
    at(s.current_pixel_index).s += 1
    return True


cdef void follow(Raster* s) noexcept nogil:
    """Power at the place where the axis is; before the first pixel and behind the last there is none."""
    cdef double way = s.direction * (at(s.position).f - at(s.program_position).f - at(s.program_offset).f)
    cdef double place = way * at(s.ppu).f
    cdef double step = max(fabs(place) * 1e-9, 1e-9)
    at(s.bitmap_position).f = place
    if place < s.farthest - 1.0 or place < s.direction * -at(s.program_offset).f * at(s.ppu).f - 0.5:
        fail(s, WRONG_DIRECTION)
        return
    s.farthest = max(s.farthest, place)
    if place < -step or place > at(s.count).s - 1 + step:
        at(s.output).f = OFF
        return
    while at(s.current_pixel_index).s < 1 or (
        at(s.current_pixel_index).s < place - step and at(s.current_pixel_index).s < at(s.count).s - 1
    ):
        if not next_pixel(s):
            return
    at(s.fraction).f = min(max(place - (at(s.current_pixel_index).s - 1), 0.0), 1.0)
    if at(s.current_pixel_value).f < 0.0 or at(s.previous_pixel_value).f < 0.0:
        at(s.output).f = OFF
    else:
        at(s.output).f = (
            at(s.previous_pixel_value).f + (at(s.current_pixel_value).f - at(s.previous_pixel_value).f) * at(s.fraction).f
        )


cdef void raster(Raster* s, long period) noexcept nogil:
    if at(s.reset).b:
        stop(s)
    elif at(s.state).s == FAILED:
        return
    elif not at(s.run).b:
        if at(s.state).s != IDLE:
            stop(s)
    elif at(s.state).s == RUNNING:
        follow(s)
    else:
        at(s.state).s = READING
        read_head(s)


declare("raster", "Laser power by pixels along the way of an axis", sizeof(Raster), [
    pin_in(FLOAT, "position", "of the axis"), pin_in(BIT, "reset", "forget program and fault"),
    pin_in(PORT, "program", "offset;bits per pixel;pixels per unit;count;pixels in hexadecimal"),
    pin_in(BIT, "run", "read the program and follow the axis; false ends it"),
    pin_out(BIT, "enabled", "a valid program runs"), pin_out(FLOAT, "output", "power in percent; -1 is none", OFF),
    pin_out(BIT, "fault"), pin_out(S32, "fault-code", "see raster.FaultCodes"),
    pin_out(S32, "state", "0 idle, 1 reading, 2 running, 3 failed"),
    pin_out(FLOAT, "program-position", "position at the start"), pin_out(FLOAT, "program-offset", "from there to the first pixel"),
    pin_out(S32, "bpp", "bits per pixel"), pin_out(FLOAT, "ppu", "pixels per unit"), pin_out(S32, "count", "pixels"),
    pin_out(FLOAT, "bitmap-position", "in pixels"), pin_out(S32, "current-pixel-index"), pin_out(FLOAT, "current-pixel-value"),
    pin_out(FLOAT, "previous-pixel-value"), pin_out(FLOAT, "fraction", "between the two pixels"),
], {"": <size_t>&raster})
