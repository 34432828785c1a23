"""The printing canon: every call as a line of text, in the format of LinuxCNC's stand-alone interpreter.

    <count> N<line number of the block, or dots> NAME(arguments)

Lines gather in a buffer in C and go out in large pieces; numbers have four decimals and are rounded exactly.
"""

import os

from libc.math cimport fabs, floor
from libc.stdio cimport snprintf
from libc.string cimport memcpy, strlen

from rs274ngc.canon import (
    CANON_CONTINUOUS, CANON_EXACT_PATH, CANON_PLANE_XY, CANON_PLANE_XZ, CANON_PLANE_YZ, CANON_SIDE_LEFT, CANON_UNITS_INCHES,
    CANON_UNITS_MM, CANON_XYZ,
)
from rs274ngc.offline cimport OfflineCanon
from rs274ngc.state cimport State

cdef enum:
    BUFFER_SIZE = 1 << 16
    LINE_MAX = 4096         # longest line of output besides texts

AXIS_NAMES = ("", "X", "Y", "Z", "A", "B", "C")


cdef class PrintCanon(OfflineCanon):
    """Writes canonical calls to a file descriptor."""

    cdef int fd
    cdef int used
    cdef char[BUFFER_SIZE] buffer
    cdef unsigned long count
    cdef public State state         # whose block is being executed, for the line number
    cdef public bint failed         # nobody reads the output any more

    def __init__(self, int fd=1, **machine):
        OfflineCanon.__init__(self, **machine)
        self.fd = fd
        self.count = 1

    cpdef flush(self):
        """Write what is still in the buffer."""
        cdef bytes data = self.buffer[:self.used]
        self.used = 0
        while data:
            data = data[os.write(self.fd, data):]

    # --- Pieces of a line

    cdef int begin(self, const char* name) except -1:
        """Count, line number, name and the opening bracket."""
        cdef char[24] digits
        cdef int k = 24, size
        cdef unsigned long n = self.count
        cdef char* out
        if self.used > BUFFER_SIZE - LINE_MAX:
            self.flush()
        out = self.buffer + self.used
        self.count += 1
        while n or k == 24:
            k -= 1
            digits[k] = <char>(c'0' + n % 10)
            n //= 10
        while k > 19:
            k -= 1
            digits[k] = c' '
        size = 24 - k
        memcpy(out, digits + k, size)
        out += size
        out[0] = c' '
        self.used += size + 1
        self.line_number()
        size = <int>strlen(name)
        memcpy(self.buffer + self.used, name, size)
        self.used += size
        self.buffer[self.used] = c'('
        self.used += 1
        return 0

    cdef void line_number(self) noexcept:
        """``N123`` as the block has it, else dots."""
        cdef const char* raw = NULL
        cdef int i = 0, n = 0
        cdef char* out = self.buffer + self.used
        if self.state is not None:
            raw = self.state.raw
            while raw[i] == c' ' or raw[i] == c'\t' or raw[i] == c'/':
                i += 1
        if raw == NULL or (raw[i] != c'N' and raw[i] != c'n'):
            memcpy(out, b"N..... ", 7)
            self.used += 7
            return
        out[0] = c'N'
        n = 1
        i += 1
        while c'0' <= raw[i] <= c'9':
            out[n] = raw[i]
            n += 1
            i += 1
        while n < 6:
            out[n] = c' '
            n += 1
        if n == 6:
            out[n] = c' '
            n += 1
        self.used += n

    cdef void end(self) noexcept:
        self.buffer[self.used] = c')'
        self.buffer[self.used + 1] = c'\n'
        self.used += 2

    cdef void separate(self, bint comma) noexcept:
        if comma:
            self.buffer[self.used] = c','
            self.used += 1
        self.buffer[self.used] = c' '
        self.used += 1

    cdef void real(self, double value) noexcept:
        """Four decimals, rounded as the exact binary value demands."""
        cdef double scaled = fabs(value) * 10000.0, rest
        cdef unsigned long long whole, fraction
        cdef char[24] digits
        cdef int k = 24, i
        if not scaled < 1.0e14:
            self.used += snprintf(self.buffer + self.used, 512, b"%.4f", value)
            return
        whole = <unsigned long long>scaled
        rest = scaled - whole
        if 0.49 < rest < 0.51:      # the product was rounded too: near a tie only the long way is sure
            self.used += snprintf(self.buffer + self.used, 512, b"%.4f", value)
            return
        if rest > 0.5:
            whole += 1
        for i in range(4):
            k -= 1
            digits[k] = <char>(c'0' + whole % 10)
            whole //= 10
        k -= 1
        digits[k] = c'.'
        while True:
            k -= 1
            digits[k] = <char>(c'0' + whole % 10)
            whole //= 10
            if whole == 0:
                break
        if value < 0.0 or (value == 0.0 and 1.0 / value < 0.0):
            k -= 1
            digits[k] = c'-'
        memcpy(self.buffer + self.used, digits + k, 24 - k)
        self.used += 24 - k

    cdef void integer(self, long value) noexcept:
        self.used += snprintf(self.buffer + self.used, 32, b"%ld", value)

    cdef void chars(self, const char* text) noexcept:
        cdef int size = <int>strlen(text)
        memcpy(self.buffer + self.used, text, size)
        self.used += size

    cdef int say(self, str name, str arguments="") except -1:
        """A line that is rare enough to be made by Python."""
        cdef bytes text = arguments.encode("utf-8", "surrogateescape")
        self.begin(name.encode("ascii"))
        if len(text) > LINE_MAX - 128:
            self.flush()
            os.write(self.fd, text)
        else:
            memcpy(self.buffer + self.used, <const char*>text, len(text))
            self.used += <int>len(text)
        self.end()
        return 0

    cdef void six(self, double x, double y, double z, double a, double b, double c) noexcept:
        self.real(x)
        self.separate(True)
        self.real(y)
        self.separate(True)
        self.real(z)
        self.separate(True)
        self.real(a)
        self.separate(True)
        self.real(b)
        self.separate(True)
        self.real(c)

    # --- Coordinates, units and modes

    cpdef void set_g5x_offset(self, int index, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        OfflineCanon.set_g5x_offset(self, index, x, y, z, a, b, c, u, v, w)
        self.begin(b"SET_G5X_OFFSET")
        self.integer(index)
        self.separate(True)
        self.six(x, y, z, a, b, c)
        self.end()

    cpdef void set_g92_offset(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        OfflineCanon.set_g92_offset(self, x, y, z, a, b, c, u, v, w)
        self.begin(b"SET_G92_OFFSET")
        self.six(x, y, z, a, b, c)
        self.end()

    cpdef void set_xy_rotation(self, double theta) except *:
        OfflineCanon.set_xy_rotation(self, theta)
        self.say("SET_XY_ROTATION", f"{theta:.4f}")

    cpdef void use_tool_length_offset(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        # As with LinuxCNC's, a tool offset does not change the position that the interpreter reads back after M6.
        self.say("USE_TOOL_LENGTH_OFFSET", f"{x:.4f} {y:.4f} {z:.4f}, {a:.4f} {b:.4f} {c:.4f}, {u:.4f} {v:.4f} {w:.4f}")

    cpdef void use_length_units(self, int units) except *:
        OfflineCanon.use_length_units(self, units)
        self.say("USE_LENGTH_UNITS", UNIT_NAMES.get(units, "UNKNOWN"))

    cpdef void select_plane(self, int plane) except *:
        OfflineCanon.select_plane(self, plane)
        self.say("SELECT_PLANE", "CANON_PLANE_" + PLANE_NAMES.get(plane, "UNKNOWN"))

    cpdef void set_feed_reference(self, int reference) except *:
        self.say("SET_FEED_REFERENCE", "CANON_XYZ" if reference == CANON_XYZ else "CANON_WORKPIECE")

    cpdef void set_feed_rate(self, double rate) except *:
        OfflineCanon.set_feed_rate(self, rate)
        self.begin(b"SET_FEED_RATE")
        self.real(rate)
        self.end()

    cpdef void set_feed_mode(self, int spindle, int mode) except *:
        self.say("SET_FEED_MODE", f"{spindle}, {mode}")

    cpdef void set_traverse_rate(self, double rate) except *:
        self.say("SET_TRAVERSE_RATE", f"{rate:.4f}")

    cpdef void set_motion_control_mode(self, int mode, double tolerance) except *:
        OfflineCanon.set_motion_control_mode(self, mode, tolerance)
        if mode == CANON_CONTINUOUS:
            self.say("SET_MOTION_CONTROL_MODE", f"CANON_CONTINUOUS, {tolerance:.6f}")
        else:
            self.say("SET_MOTION_CONTROL_MODE", "CANON_EXACT_PATH" if mode == CANON_EXACT_PATH else "CANON_EXACT_STOP")

    cpdef void set_naivecam_tolerance(self, double tolerance) except *:
        OfflineCanon.set_naivecam_tolerance(self, tolerance)
        self.say("SET_NAIVECAM_TOLERANCE", f"{tolerance:.4f}")

    # --- Motion

    cpdef void straight_traverse(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.move_to(x, y, z, a, b, c, u, v, w)
        self.begin(b"STRAIGHT_TRAVERSE")
        self.six(x, y, z, a, b, c)
        self.end()

    cpdef void straight_feed(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        self.move_to(x, y, z, a, b, c, u, v, w)
        self.begin(b"STRAIGHT_FEED")
        self.six(x, y, z, a, b, c)
        self.end()

    cpdef void straight_probe(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, int probe_type) except *:
        OfflineCanon.straight_probe(self, line, x, y, z, a, b, c, u, v, w, probe_type)
        self.begin(b"STRAIGHT_PROBE")
        self.six(x, y, z, a, b, c)
        self.end()

    cpdef void arc_feed(self, int line, double first_end, double second_end, double first_axis, double second_axis, int rotation, double axis_end, double a, double b, double c, double u, double v, double w) except *:
        OfflineCanon.arc_feed(self, line, first_end, second_end, first_axis, second_axis, rotation, axis_end, a, b, c, u, v, w)
        self.begin(b"ARC_FEED")
        self.real(first_end)
        self.separate(True)
        self.real(second_end)
        self.separate(True)
        self.real(first_axis)
        self.separate(True)
        self.real(second_axis)
        self.separate(True)
        self.integer(rotation)
        self.separate(True)
        self.real(axis_end)
        self.separate(True)
        self.real(a)
        self.separate(True)
        self.real(b)
        self.separate(True)
        self.real(c)
        self.end()

    cpdef void nurbs_feed(self, int line, list control_points, int order) except *:
        """LinuxCNC's printing canon then stands at X0 Y0, which shows when the program asks for its place: so does this one."""
        self.say("NURBS_FEED", f"{len(control_points)}, ...")
        self.pos[0] = self.pos[1] = 0.0

    cpdef void nurbs_knots_feed(self, int line, list control_points, list knots, int order) except *:
        self.nurbs_feed(line, control_points, order)

    cpdef void rigid_tap(self, int line, double x, double y, double z, double scale) except *:
        self.say("RIGID_TAP", f"{x:.4f}, {y:.4f}, {z:.4f}")

    cpdef void start_speed_feed_synch(self, int spindle, double feed_per_revolution, bint velocity_mode) except *:
        self.say("START_SPEED_FEED_SYNC", f"{feed_per_revolution:.6f},{velocity_mode:d}")

    cpdef void dwell(self, double seconds) except *:
        self.say("DWELL", f"{seconds:.4f}")

    cpdef void home_cycle(self) except *:
        self.say("HOME_CYCLE")

    cpdef void home_cycle_joint(self, int joint) except *:
        self.say("HOME_CYCLE_JOINT", str(joint))

    # --- Spindles and tools

    cpdef void set_spindle_mode(self, int spindle, double css_max) except *:
        self.say("SET_SPINDLE_MODE", f"{spindle} {css_max:.4f}")

    cpdef void set_spindle_speed(self, int spindle, double speed) except *:
        OfflineCanon.set_spindle_speed(self, spindle, speed)
        self.say("SET_SPINDLE_SPEED", f"{spindle}, {speed:.4f}")

    cpdef void start_spindle_clockwise(self, int spindle, bint wait_for_atspeed) except *:
        OfflineCanon.start_spindle_clockwise(self, spindle, wait_for_atspeed)
        self.say("START_SPINDLE_CLOCKWISE", str(spindle))

    cpdef void start_spindle_counterclockwise(self, int spindle, bint wait_for_atspeed) except *:
        OfflineCanon.start_spindle_counterclockwise(self, spindle, wait_for_atspeed)
        self.say("START_SPINDLE_COUNTERCLOCKWISE", str(spindle))

    cpdef void stop_spindle_turning(self, int spindle) except *:
        OfflineCanon.stop_spindle_turning(self, spindle)
        self.say("STOP_SPINDLE_TURNING", str(spindle))

    cpdef void orient_spindle(self, int spindle, double orientation, int mode) except *:
        self.say("ORIENT_SPINDLE", f"{spindle}, {orientation:.4f}, {mode}")

    cpdef void wait_spindle_orient_complete(self, int spindle, double timeout) except *:
        self.say(f"SPINDLE.{spindle}.WAIT_ORIENT_COMPLETE", f"{timeout:.4f}")

    cpdef void select_tool(self, int tool) except *:
        OfflineCanon.select_tool(self, tool)
        self.say("SELECT_TOOL", str(tool))

    cpdef void change_tool(self) except *:
        OfflineCanon.change_tool_number(self, self.selected if self.selected > 0 else 0)
        self.say("CHANGE_TOOL")

    cpdef void change_tool_number(self, int pocket) except *:
        self.say("CHANGE_TOOL_NUMBER", str(pocket))

    cpdef void set_tool_table_entry(self, int pocket, int tool, double x, double y, double z, double a, double b, double c, double u, double v, double w, double diameter, double frontangle, double backangle, int orientation) except *:
        OfflineCanon.set_tool_table_entry(self, pocket, tool, x, y, z, a, b, c, u, v, w, diameter, frontangle, backangle, orientation)
        offset = f"{x:.4f} {y:.4f} {z:.4f} {a:.4f} {b:.4f} {c:.4f} {u:.4f} {v:.4f} {w:.4f}"
        self.say("SET_TOOL_TABLE_ENTRY", f"{pocket}, {tool}, {offset}, {frontangle:.4f}, {backangle:.4f}, {orientation}")

    # --- Inputs and outputs

    cpdef void set_motion_output_bit(self, int index) except *:
        self.say("SET_MOTION_OUTPUT_BIT", str(index))

    cpdef void clear_motion_output_bit(self, int index) except *:
        self.say("CLEAR_MOTION_OUTPUT_BIT", str(index))

    cpdef void set_aux_output_bit(self, int index) except *:
        self.say("SET_AUX_OUTPUT_BIT", str(index))

    cpdef void clear_aux_output_bit(self, int index) except *:
        self.say("CLEAR_AUX_OUTPUT_BIT", str(index))

    cpdef void set_motion_output_value(self, int index, double value) except *:
        self.say("SET_MOTION_OUTPUT_VALUE", f"{index},{value:.6f}")

    cpdef void set_aux_output_value(self, int index, double value) except *:
        self.say("SET_AUX_OUTPUT_VALUE", f"{index},{value:.6f}")

    cpdef void enable_speed_override(self, int spindle) except *:
        self.say("ENABLE_SPEED_OVERRIDE", str(spindle))

    cpdef void disable_speed_override(self, int spindle) except *:
        self.say("DISABLE_SPEED_OVERRIDE", str(spindle))

    cpdef void clamp_axis(self, int axis) except *:
        self.say("CLAMP_AXIS", "CANON_AXIS_" + AXIS_NAMES[axis])

    cpdef void unclamp_axis(self, int axis) except *:
        self.say("UNCLAMP_AXIS", "CANON_AXIS_" + AXIS_NAMES[axis])

    # --- Program and messages

    cpdef void comment(self, str text) except *:
        self.say("COMMENT", '"' + text + '"')

    cpdef void message(self, str text) except *:
        self.say("MESSAGE", '"' + text + '"')

    cpdef void log(self, str text) except *:
        self.say("LOG", '"' + text + '"')

    cpdef void logopen(self, str name) except *:
        self.say("LOGOPEN", '"' + name + '"')

    cpdef void logappend(self, str name) except *:
        self.say("LOGAPPEND", '"' + name + '"')

    cpdef void print_text(self, str text) except *:
        self.flush()
        os.write(self.fd, (text + "\n").encode("utf-8", "surrogateescape"))

    cpdef void error(self, str text) except *:
        self.say("CANON_ERROR", text)

    cpdef void user_command(self, int number, double p, double q) except *:
        self.say(f"USER_DEFINED_FUNCTION_{number}", f"{p:.4f}, {q:.4f}")

    # --- Calls without arguments

    cpdef void stop_speed_feed_synch(self) except *:
        self.say("STOP_SPEED_FEED_SYNCH")

    cpdef void stop(self) except *:
        self.say("STOP")

    cpdef void spindle_retract(self) except *:
        self.say("SPINDLE_RETRACT")

    cpdef void spindle_retract_traverse(self) except *:
        self.say("SPINDLE_RETRACT_TRAVERSE")

    cpdef void lock_spindle_z(self) except *:
        self.say("LOCK_SPINDLE_Z")

    cpdef void use_spindle_force(self) except *:
        self.say("USE_SPINDLE_FORCE")

    cpdef void use_no_spindle_force(self) except *:
        self.say("USE_NO_SPINDLE_FORCE")

    cpdef void reload_tooldata(self) except *:
        self.say("RELOAD_TOOLDATA")

    cpdef void stop_cutter_radius_compensation(self) except *:
        self.say("STOP_CUTTER_RADIUS_COMPENSATION")

    cpdef void enable_feed_override(self) except *:
        self.say("ENABLE_FEED_OVERRIDE")

    cpdef void disable_feed_override(self) except *:
        self.say("DISABLE_FEED_OVERRIDE")

    cpdef void enable_adaptive_feed(self) except *:
        self.say("ENABLE_ADAPTIVE_FEED")

    cpdef void disable_adaptive_feed(self) except *:
        self.say("DISABLE_ADAPTIVE_FEED")

    cpdef void enable_feed_hold(self) except *:
        self.say("ENABLE_FEED_HOLD")

    cpdef void disable_feed_hold(self) except *:
        self.say("DISABLE_FEED_HOLD")

    cpdef void turn_probe_on(self) except *:
        self.say("TURN_PROBE_ON")

    cpdef void turn_probe_off(self) except *:
        self.say("TURN_PROBE_OFF")

    cpdef void logclose(self) except *:
        self.say("LOGCLOSE")

    cpdef void program_stop(self) except *:
        self.say("PROGRAM_STOP")

    cpdef void optional_program_stop(self) except *:
        self.say("OPTIONAL_PROGRAM_STOP")

    cpdef void pallet_shuttle(self) except *:
        self.say("PALLET_SHUTTLE")

    cpdef void program_end(self) except *:
        self.say("PROGRAM_END")

    cpdef void finish(self) except *:
        self.say("FINISH")

    cpdef void on_reset(self) except *:
        self.say("ON_RESET")

    cpdef void mist_on(self) except *:
        OfflineCanon.mist_on(self)
        self.say("MIST_ON")

    cpdef void mist_off(self) except *:
        OfflineCanon.mist_off(self)
        self.say("MIST_OFF")

    cpdef void flood_on(self) except *:
        OfflineCanon.flood_on(self)
        self.say("FLOOD_ON")

    cpdef void flood_off(self) except *:
        OfflineCanon.flood_off(self)
        self.say("FLOOD_OFF")


UNIT_NAMES = {CANON_UNITS_INCHES: "CANON_UNITS_INCHES", CANON_UNITS_MM: "CANON_UNITS_MM", 3: "CANON_UNITS_CM"}
PLANE_NAMES = {CANON_PLANE_XY: "XY", CANON_PLANE_YZ: "YZ", CANON_PLANE_XZ: "XZ"}
