"""M codes: spindles, coolant, overrides, inputs and outputs, stops, the end of a program, the user's M codes."""

from libc.math cimport fabs, floor

from rs274ngc.block cimport *
from rs274ngc.canon import (
    CANON_CLOCKWISE, CANON_CONTINUOUS, CANON_COUNTERCLOCKWISE, CANON_PLANE_XY, CANON_SIDE_OFF, CANON_STOPPED,
)
from rs274ngc.compensation cimport flush
from rs274ngc.modes cimport read_spindle, read_spindles
from rs274ngc.offsets cimport change_origin
from rs274ngc.state cimport EXIT, FINISH, WAIT_INPUT, State, fail, fail_word

cdef int SIDE_OFF = CANON_SIDE_OFF, STOPPED = CANON_STOPPED
cdef int CLOCKWISE = CANON_CLOCKWISE, COUNTERCLOCKWISE = CANON_COUNTERCLOCKWISE
cdef double INTEGER_TOLERANCE = 0.001     # of P of M19
cdef int OUTPUTS_MAX = 63       # highest number of a digital or analog input or output
cdef double NO_VALUE = -1.0     # what M67 and M68 without Q send, as LinuxCNC does


# --- Spindles and coolant

cdef int spindle(State s, Block* b, int code) except -1:
    """M3, M4, M5"""
    cdef int n, first, last
    read_spindles(s, b, f"Spindle ($) number out of range in M{code} Command", &first, &last)
    for n in range(first, last + 1):
        if code == 3:
            s.canon.start_spindle_clockwise(n, True)
            s.turning[n] = CLOCKWISE
        elif code == 4:
            s.canon.start_spindle_counterclockwise(n, True)
            s.turning[n] = COUNTERCLOCKWISE
        else:
            s.canon.stop_spindle_turning(n)
            s.turning[n] = STOPPED
    return 0


cdef int check_orient(State s, Block* b, int code) except -1:
    """What M19 may say."""
    if has(b, W_P) and fabs(b.value[W_P] - floor(b.value[W_P] + 0.5)) > INTEGER_TOLERANCE:
        return fail_word(s, "P value not an integer with M19 G2 or G3", W_P)
    if has(b, W_P) and not 0.0 <= floor(b.value[W_P] + 0.5) <= 2.0:
        return fail_word(s, "P value must be 0,1,or 2 with M19", W_P)
    if has(b, W_R) and not 0.0 <= b.value[W_R] <= 360.0:
        return fail_word(s, "R value must be within 0..360 with M19", W_R)
    return 0


cdef int orient(State s, Block* b, int code) except -1:
    """M19 R angle P direction Q timeout"""
    cdef int n = read_spindle(s, b, "Spindle ($) number out of range in M19 Command")
    cdef double angle
    if has(b, W_R) or has(b, W_P):
        angle = value_or(b, W_R, 0.0) + s.orient_offset
        s.canon.orient_spindle(n, angle - 360.0 * floor(angle / 360.0) if angle >= 360.0 else angle, <int>floor(value_or(b, W_P, 0.0) + 0.5))
    if has(b, W_Q):
        if b.value[W_Q] <= 0.0:
            return fail_word(s, "Q word with M19 requires a value > 0", W_Q)
        s.canon.wait_spindle_orient_complete(n, b.value[W_Q])
    s.turning[n] = STOPPED
    return 0


cdef int coolant(State s, Block* b, int code) except -1:
    """M7, M8, M9"""
    if code == 7:
        s.canon.mist_on()
        s.mist = True
    elif code == 8:
        s.canon.flood_on()
        s.flood = True
    else:
        s.canon.mist_off()
        s.canon.flood_off()
        s.mist = s.flood = False
    return 0


# --- Overrides

cdef int speed_override(State s, int n, bint on) except -1:
    if on:
        s.canon.enable_speed_override(n)
    else:
        s.canon.disable_speed_override(n)
    s.speed_override[n] = on
    return 0


cdef int feed_override(State s, bint on) except -1:
    if on:
        s.canon.enable_feed_override()
    else:
        s.canon.disable_feed_override()
    s.feed_override = on
    return 0


cdef int overrides(State s, Block* b, int code) except -1:
    """M48, M49 both overrides; M50 feed, M51 speed, M52 adaptive feed, M53 feed hold, with P0 off"""
    cdef int n, first, last
    cdef bint on = value_or(b, W_P, 1.0) != 0.0
    if s.comp_side != SIDE_OFF:
        what = "disable" if code == 49 or not on else "enable"
        return fail(s, f"Cannot {what} overrides with cutter radius compensation on", b.m_at[9])
    if code <= 49:
        feed_override(s, code == 48)
        for n in range(s.spindles):
            speed_override(s, n, code == 48)
    elif code == 50:
        feed_override(s, on)
    elif code == 51:
        first, last = 0, s.spindles - 1
        if has(b, W_DOLLAR):
            first = last = read_spindle(s, b, "Invalid spindle ($) number in M51 command")
        for n in range(first, last + 1):
            speed_override(s, n, on)
    elif code == 52:
        if on:
            s.canon.enable_adaptive_feed()
        else:
            s.canon.disable_adaptive_feed()
        s.adaptive_feed = on
    else:
        if on:
            s.canon.enable_feed_hold()
        else:
            s.canon.disable_feed_hold()
        s.feed_hold = on
    return 0


# --- Inputs and outputs

cdef int output(State s, Block* b, int code) except -1:
    """M62 to M65 P: a digital output on or off, with motion or at once"""
    cdef int index
    if s.comp_side != SIDE_OFF and code <= 63:
        what = "output" if code == 62 else "digital output"
        return fail(s, f"Cannot set motion {what} with cutter radius compensation on", b.m_at[5])
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot set auxiliary digital output with cutter radius compensation on", b.m_at[5])
    if not has(b, W_P) or not 0.0 <= b.value[W_P] < 2.0e9:
        return fail(s, f"No valid P word with M{code}", b.m_at[5])
    index = <int>floor(b.value[W_P] + 0.5)
    if code == 62:
        s.canon.set_motion_output_bit(index)
    elif code == 63:
        s.canon.clear_motion_output_bit(index)
    elif code == 64:
        s.canon.set_aux_output_bit(index)
    else:
        s.canon.clear_aux_output_bit(index)
    return 0


cdef int analog_output(State s, Block* b, int code) except -1:
    """M67, M68 E Q: an analog output, with motion or at once"""
    cdef int index
    if s.comp_side != SIDE_OFF:
        kind = "motion" if code == 67 else "auxiliary"
        return fail(s, f"Cannot set {kind} analog output with cutter radius compensation on", b.m_at[5])
    if not has(b, W_E) or not 0.0 <= b.value[W_E] < 2.0e9:
        return fail(s, f"Invalid analog index with M{code}", b.m_at[5])
    index = <int>floor(b.value[W_E] + 0.5)
    if code == 67:
        s.canon.set_motion_output_value(index, value_or(b, W_Q, NO_VALUE))
    else:
        s.canon.set_aux_output_value(index, value_or(b, W_Q, NO_VALUE))
    return 0


cdef int wait_input(State s, Block* b, int code) except -1:
    """M66 P or E, L how, Q timeout: the result is in #5399 for the next line"""
    cdef int how = <int>value_or(b, W_L, 0.0), index
    cdef double timeout = value_or(b, W_Q, 0.0)
    cdef bint digital = has(b, W_P)
    if digital and has(b, W_E):
        return fail_word(s, "Invalid to select both a digital and an analog input with M66", W_E)
    if s.comp_side != SIDE_OFF:
        return fail(s, f"Cannot wait for {'digital' if digital else 'analog'} input with cutter radius compensation on",
                    b.m_at[5])
    if value_or(b, W_P if digital else W_E, MISSING) == MISSING:
        return fail(s, "Need to have either a valid P or a valid E word with M66", b.m_at[5])
    if timeout <= 0.0 and how != 0:
        return fail(s, "Zero timeout with wait type != immediate return", b.m_at[5])
    if not digital and how != 0:
        return fail_word(s, "Can't select analog input with wait type != immediate return", W_L)
    if how > 4:
        return fail_word(s, "L word out of range with M66", W_L)
    if not 0.0 <= b.value[W_P if digital else W_E] <= OUTPUTS_MAX:
        return fail_word(s, f"{'Digital' if digital else 'Analog'} input selected out of bounds", W_P if digital else W_E)
    index = <int>floor(b.value[W_P if digital else W_E] + 0.5)
    s.canon.wait(index, 1 if digital else 0, how, timeout)
    s.input_index = index
    s.input_digital = digital
    s.waiting |= WAIT_INPUT
    return 0


# --- Stops and the end

cdef int program_stop(State s, Block* b, int code) except -1:
    """M0, M1, M60"""
    if code == 60:
        s.canon.pallet_shuttle()
    if code == 1:
        s.canon.optional_program_stop()
    else:
        s.canon.program_stop()
    return 0


cdef int program_end(State s, Block* b, int code) except -1:
    """M2, M30: back to the modes that every program may count on"""
    cdef int n
    flush(s)
    if s.comp_side != SIDE_OFF:
        s.comp_side = SIDE_OFF
        s.pos[0], s.pos[1], s.pos[2] = s.comp_x, s.comp_y, s.comp_z
    s.arc_not_allowed = False
    change_origin(s, 1)
    if s.plane != CANON_PLANE_XY:
        s.plane = CANON_PLANE_XY
        s.canon.select_plane(s.plane)
    s.incremental = False
    s.feed_mode = 940
    s.canon.set_feed_mode(0, 0)
    s.feed = 0.0
    s.canon.set_feed_rate(0.0)
    if not s.feed_override:
        feed_override(s, True)
    for n in range(s.spindles):
        s.canon.stop_spindle_turning(n)
        s.turning[n] = STOPPED
        s.css[n] = 0.0
        s.canon.set_spindle_mode(n, 0.0)
    s.motion = 10
    if s.mist:
        s.canon.mist_off()
        s.mist = False
    if s.flood:
        s.canon.flood_off()
        s.flood = False
    if code == 30:
        s.canon.pallet_shuttle()
    s.canon.program_end()
    s.ended = True
    return 0


cdef int user_code(State s, Block* b, int code) except -1:
    """M100 to M199 P Q: a program of the user's"""
    if not s.canon.user_command_exists(code):
        return fail(s, f"Unknown m code used: M{code}", b.m_at[10])
    s.canon.user_command(code, value_or(b, W_P, -1.0), value_or(b, W_Q, -1.0))
    s.must_finish = True
    return 0


cdef int subprogram_end(State s, Block* b, int code) except -1:
    """M99; where programs are not repeated, the end of the main program"""
    if not s.interp.end_subprogram():
        program_end(s, b, 2)
    return 0
