"""The canonical machining functions: everything that the interpreter can ask of a machine, or of whatever stands for one.

The interpreter calls a Canon and knows nothing else of the world. Subclass it (in Cython or in Python) and override what
concerns you: task makes messages of the calls, ``rs274`` prints them, previews and forecasts collect geometry.

Names are LinuxCNC's canonical functions in lower case. Unless a method says otherwise, lengths are in program units
(``use_length_units``), angles in degrees, points in program coordinates; ``rs274ngc.coords`` turns them into machine
coordinates. The ``get_external_*`` methods answer questions; the defaults are a machine with XYZABC that stands at zero.
"""

from dataclasses import dataclass

CANON_PLANE_XY, CANON_PLANE_YZ, CANON_PLANE_XZ, CANON_PLANE_UV, CANON_PLANE_VW, CANON_PLANE_UW = range(1, 7)
CANON_UNITS_INCHES, CANON_UNITS_MM, CANON_UNITS_CM = range(1, 4)
CANON_EXACT_STOP, CANON_EXACT_PATH, CANON_CONTINUOUS = range(1, 4)
CANON_STOPPED, CANON_CLOCKWISE, CANON_COUNTERCLOCKWISE = range(1, 4)
CANON_WORKPIECE, CANON_XYZ = range(1, 3)
CANON_SIDE_RIGHT, CANON_SIDE_LEFT, CANON_SIDE_OFF = range(1, 4)
CANON_AXIS_X, CANON_AXIS_Y, CANON_AXIS_Z, CANON_AXIS_A, CANON_AXIS_B, CANON_AXIS_C = range(1, 7)

AXES = "XYZABCUVW"
"""Order of the nine coordinates everywhere."""


@dataclass(slots=True)
class Tool:
    """One entry of the tool table: lengths in machine units, angles in degrees."""

    toolno: int = 0
    pocketno: int = 0
    offset: tuple[float, ...] = (0.0,) * 9
    diameter: float = 0.0
    frontangle: float = 0.0
    backangle: float = 0.0
    orientation: int = 0


cdef class Canon:
    """A machine that does nothing and stands at zero."""

    # --- Coordinates, units and modes

    cpdef void init_canon(self) except *:
        """A program or a session begins: forget everything that earlier calls set."""

    cpdef void set_g5x_offset(self, int index, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        """Origin of coordinate system ``index`` (1: G54 .. 9: G59.3), which becomes the active one; program units, degrees."""

    cpdef void set_g92_offset(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        """The G92/G52 offset, zero when it is not in force; program units, degrees."""

    cpdef void set_xy_rotation(self, double theta) except *:
        """Rotation of the coordinate system about Z, degrees, counter-clockwise."""

    cpdef void use_tool_length_offset(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        """The tool offset that is in force from now on; program units, degrees."""

    cpdef void use_length_units(self, int units) except *:
        """Unit of every length that follows: CANON_UNITS_INCHES, CANON_UNITS_MM or CANON_UNITS_CM."""

    cpdef void select_plane(self, int plane) except *:
        """Plane of the arcs that follow: CANON_PLANE_XY and so on."""

    cpdef void set_feed_reference(self, int reference) except *:
        """CANON_XYZ or CANON_WORKPIECE; the interpreter only uses CANON_XYZ."""

    cpdef void set_feed_rate(self, double rate) except *:
        """Feed in program units a minute (degrees where nothing linear moves); with a feed mode of 1: units a revolution."""

    cpdef void set_feed_mode(self, int spindle, int mode) except *:
        """``mode`` 1: feed per revolution of ``spindle`` (G95); 0: feed per minute or inverse time."""

    cpdef void set_traverse_rate(self, double rate) except *:
        """Rapid speed, program units a minute; the interpreter leaves it to the machine."""

    cpdef void set_motion_control_mode(self, int mode, double tolerance) except *:
        """CANON_EXACT_STOP, CANON_EXACT_PATH or CANON_CONTINUOUS, the last with its tolerance (program units, 0: none)."""

    cpdef void set_naivecam_tolerance(self, double tolerance) except *:
        """Lines that deviate from one line by less than this may be joined (program units, 0: never)."""

    cpdef void update_end_point(self, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        """The machine is at this place (program units and coordinates) without a move having been programmed."""

    # --- Motion: program units, program coordinates, degrees; ``line`` is the line of the file

    cpdef void straight_traverse(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        """Rapid to this point (G0)."""

    cpdef void straight_feed(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w) except *:
        """Straight line at the feed rate (G1)."""

    cpdef void arc_feed(self, int line, double first_end, double second_end, double first_axis, double second_axis, int rotation, double axis_end, double a, double b, double c, double u, double v, double w) except *:
        """Arc or helix in the selected plane; ends and centre in the order of the plane (XY, ZX, YZ). ``rotation``: turns begun, positive counter-clockwise."""

    cpdef void nurbs_feed(self, int line, list control_points, int order) except *:
        """A NURBS of control points (first axis, second axis, weight) in the selected plane, of ``order`` k, with a uniform clamped knot vector."""

    cpdef void nurbs_knots_feed(self, int line, list control_points, list knots, int order) except *:
        """The same with the program's own knots."""

    cpdef void straight_probe(self, int line, double x, double y, double z, double a, double b, double c, double u, double v, double w, int probe_type) except *:
        """Move until the probe changes (G38.n); ``probe_type`` bit 0: failing is no error (G38.3, .5), bit 1: until it opens (G38.4, .5)."""

    cpdef void rigid_tap(self, int line, double x, double y, double z, double scale) except *:
        """Synchronised move to the point and, after reversing the spindle, back (G33.1)."""

    cpdef void start_speed_feed_synch(self, int spindle, double feed_per_revolution, bint velocity_mode) except *:
        """The moves that follow keep step with ``spindle`` (G33, G76; G95 has velocity_mode)."""

    cpdef void stop_speed_feed_synch(self) except *:
        """Back to feed per minute."""

    cpdef void dwell(self, double seconds) except *:
        """Do nothing for a while (G4)."""

    cpdef void stop(self) except *:
        """Motion comes to a stop here."""

    cpdef void home_cycle(self) except *:
        """Home all joints in their sequence (G28.2 P-1); the machine may stand elsewhere afterwards."""

    cpdef void home_cycle_joint(self, int joint) except *:
        """Home one joint, or the group that homes with it (G28.2 P)."""

    # --- Spindles

    cpdef void set_spindle_mode(self, int spindle, double css_max) except *:
        """0: constant speed (G97); else constant surface speed up to this many turns a minute (G96)."""

    cpdef void set_spindle_speed(self, int spindle, double speed) except *:
        """Turns a minute, or surface speed with constant surface speed."""

    cpdef void start_spindle_clockwise(self, int spindle, bint wait_for_atspeed) except *:
        """M3."""

    cpdef void start_spindle_counterclockwise(self, int spindle, bint wait_for_atspeed) except *:
        """M4."""

    cpdef void stop_spindle_turning(self, int spindle) except *:
        """M5."""

    cpdef void orient_spindle(self, int spindle, double orientation, int mode) except *:
        """Turn to ``orientation`` degrees; mode 0: shortest way, 1: clockwise, 2: counter-clockwise (M19)."""

    cpdef void wait_spindle_orient_complete(self, int spindle, double timeout) except *:
        """Wait for the orientation, at most so many seconds (M19 Q)."""

    cpdef void lock_spindle_z(self) except *:
        """Hold the spindle's Z."""

    cpdef void use_spindle_force(self) except *:
        """Feed with a limited force."""

    cpdef void use_no_spindle_force(self) except *:
        """Feed without a limit on the force."""

    cpdef void spindle_retract(self) except *:
        """Retract the spindle at feed."""

    cpdef void spindle_retract_traverse(self) except *:
        """Retract the spindle at rapid."""

    # --- Tools

    cpdef void select_tool(self, int tool) except *:
        """Prepare tool number ``tool`` (T word); 0: none."""

    cpdef void start_change(self) except *:
        """A tool change begins."""

    cpdef void change_tool(self) except *:
        """Put the selected tool into the spindle (M6)."""

    cpdef void change_tool_number(self, int pocket) except *:
        """Declare the tool of tool-table index ``pocket`` to be in the spindle, without moving anything (M61)."""

    cpdef void set_tool_table_entry(self, int pocket, int tool, double x, double y, double z, double a, double b, double c, double u, double v, double w, double diameter, double frontangle, double backangle, int orientation) except *:
        """Write a tool-table entry (G10 L1, L10, L11); lengths in machine units."""

    cpdef void reload_tooldata(self) except *:
        """Read the tool table anew (G10 L0)."""

    cpdef void set_cutter_radius_compensation(self, double radius) except *:
        """Radius of the compensation that follows; the interpreter compensates itself."""

    cpdef void start_cutter_radius_compensation(self, int side) except *:
        """CANON_SIDE_LEFT or CANON_SIDE_RIGHT."""

    cpdef void stop_cutter_radius_compensation(self) except *:
        """Compensation ends."""

    # --- Coolant, overrides, inputs and outputs

    cpdef void flood_on(self) except *:
        """M8."""

    cpdef void flood_off(self) except *:
        """M9."""

    cpdef void mist_on(self) except *:
        """M7."""

    cpdef void mist_off(self) except *:
        """M9."""

    cpdef void enable_feed_override(self) except *:
        """M48, M50 P1."""

    cpdef void disable_feed_override(self) except *:
        """M49, M50 P0."""

    cpdef void enable_speed_override(self, int spindle) except *:
        """M48, M51 P1."""

    cpdef void disable_speed_override(self, int spindle) except *:
        """M49, M51 P0."""

    cpdef void enable_adaptive_feed(self) except *:
        """M52 P1."""

    cpdef void disable_adaptive_feed(self) except *:
        """M52 P0."""

    cpdef void enable_feed_hold(self) except *:
        """M53 P1."""

    cpdef void disable_feed_hold(self) except *:
        """M53 P0."""

    cpdef void set_motion_output_bit(self, int index) except *:
        """Digital output on, in step with motion (M62)."""

    cpdef void clear_motion_output_bit(self, int index) except *:
        """Digital output off, in step with motion (M63)."""

    cpdef void set_aux_output_bit(self, int index) except *:
        """Digital output on, at once (M64)."""

    cpdef void clear_aux_output_bit(self, int index) except *:
        """Digital output off, at once (M65)."""

    cpdef void set_motion_output_value(self, int index, double value) except *:
        """Analog output in step with motion (M67)."""

    cpdef void set_aux_output_value(self, int index, double value) except *:
        """Analog output at once (M68)."""

    cpdef void lock_rotary(self, int line, int joint) except *:
        """Clamp an indexer."""

    cpdef void unlock_rotary(self, int line, int joint) except *:
        """Release an indexer before it moves."""

    cpdef void turn_probe_on(self) except *:
        """The probe is looked at."""

    cpdef void turn_probe_off(self) except *:
        """The probe is no longer looked at."""

    cpdef void clamp_axis(self, int axis) except *:
        """CANON_AXIS_X and so on."""

    cpdef void unclamp_axis(self, int axis) except *:
        """CANON_AXIS_X and so on."""

    # --- Program and messages

    cpdef void comment(self, str text) except *:
        """A comment, or a remark of the interpreter."""

    cpdef void message(self, str text) except *:
        """A text for the operator (MSG, DEBUG)."""

    cpdef void print_text(self, str text) except *:
        """A text for the standard output (PRINT)."""

    cpdef void log(self, str text) except *:
        """A line for the open log file (LOG)."""

    cpdef void logopen(self, str name) except *:
        """Begin a log file."""

    cpdef void logappend(self, str name) except *:
        """Go on with a log file."""

    cpdef void logclose(self) except *:
        """End the log file."""

    cpdef void probeopen(self, str name) except *:
        """Begin a file of probe results."""

    cpdef void probeclose(self) except *:
        """End the file of probe results."""

    cpdef void error(self, str text) except *:
        """A complaint that does not end the program."""

    cpdef void program_stop(self) except *:
        """Wait for the operator (M0)."""

    cpdef void optional_program_stop(self) except *:
        """Wait for the operator if the optional stop is on (M1)."""

    cpdef void pallet_shuttle(self) except *:
        """Exchange pallets (M60, M30)."""

    cpdef void program_end(self) except *:
        """The program is over (M2, M30, closing percent sign)."""

    cpdef void finish(self) except *:
        """Send on whatever the canon still holds back: the interpreter wants the machine to stand still."""

    cpdef void on_reset(self) except *:
        """The interpreter was reset: after a program, an abort."""

    cpdef void user_command(self, int number, double p, double q) except *:
        """Run the user's program Mnnn, 100 to 199; -1 stands for a word that is missing."""

    cpdef void update_tag(self, object tag) except *:
        """Modal state of the moves that follow, when a canon asks for it."""

    # --- What the interpreter asks of the world

    cpdef tuple get_external_position(self):
        """Where the machine is: X to W, program units and coordinates."""
        return (0.0,) * 9

    cpdef tuple get_external_probe_position(self):
        """Where the probe tripped: X to W, program units and coordinates."""
        return (0.0,) * 9

    cpdef int get_external_probe_tripped_value(self) except? -1:
        """1 when the last probing found something."""
        return 0

    cpdef double get_external_probe_value(self) except? -1:
        """Value of the probe input."""
        return 0.0

    cpdef double get_external_feed_rate(self) except? -1:
        """Feed in program units a minute."""
        return 0.0

    cpdef double get_external_traverse_rate(self) except? -1:
        """Rapid speed in program units a minute."""
        return 0.0

    cpdef double get_external_length_units(self) except? -1:
        """Machine length units in a millimetre."""
        return 1.0

    cpdef double get_external_angle_units(self) except? -1:
        """Machine angle units in a degree."""
        return 1.0

    cpdef int get_external_length_unit_type(self) except? -1:
        """Unit of the program lengths: CANON_UNITS_*."""
        return CANON_UNITS_MM

    cpdef int get_external_motion_control_mode(self) except? -1:
        """CANON_EXACT_STOP, CANON_EXACT_PATH or CANON_CONTINUOUS."""
        return CANON_CONTINUOUS

    cpdef double get_external_motion_control_tolerance(self) except? -1:
        """Blending tolerance in program units."""
        return 0.0

    cpdef double get_external_motion_control_naivecam_tolerance(self) except? -1:
        """Tolerance of the naive CAM detector in program units."""
        return 0.0

    cpdef int get_external_plane(self) except? -1:
        """CANON_PLANE_*."""
        return CANON_PLANE_XY

    cpdef int get_external_axis_mask(self) except? -1:
        """Which axes the machine has: bit 0 X to bit 8 W."""
        return 0x3F

    cpdef int get_external_spindle(self, int spindle) except? -1:
        """CANON_STOPPED, CANON_CLOCKWISE or CANON_COUNTERCLOCKWISE."""
        return CANON_STOPPED

    cpdef double get_external_speed(self, int spindle) except? -1:
        """Speed asked of the spindle."""
        return 0.0

    cpdef int get_external_flood(self) except? -1:
        """1: flood is on."""
        return 0

    cpdef int get_external_mist(self) except? -1:
        """1: mist is on."""
        return 0

    cpdef int get_external_queue_empty(self) except? -1:
        """1: motion stands still and nothing is on the way to it."""
        return 1

    cpdef tuple get_external_tool_offset(self):
        """Tool offset in force: X to W, program units."""
        return (0.0,) * 9

    cpdef int get_external_tool_slot(self) except? -1:
        """Tool-table index of the tool in the spindle (0: none, or a tool that came from no pocket)."""
        return 0

    cpdef int get_external_selected_tool_slot(self) except? -1:
        """Tool-table index of the prepared tool; -1: none."""
        return -1

    cpdef object get_external_tool_table(self, int index):
        """Entry ``index`` of the tool table (a Tool, lengths in machine units); 0 is the spindle."""
        return Tool()

    cpdef int get_external_tool_index(self, int tool) except? -1:
        """Tool-table index of tool number ``tool``; -1: there is none."""
        return 0 if tool == 0 else -1

    cpdef int get_external_pockets_max(self) except? -1:
        """Entries of the tool table, the spindle included."""
        return 0

    cpdef int get_external_tc_fault(self) except? -1:
        """1: the tool changer failed."""
        return 0

    cpdef int get_external_tc_reason(self) except? -1:
        """Its reason."""
        return 0

    cpdef int get_external_feed_override_enable(self) except? -1:
        """1: the feed override works."""
        return 1

    cpdef int get_external_spindle_override_enable(self, int spindle) except? -1:
        """1: the spindle override works."""
        return 1

    cpdef int get_external_adaptive_feed_enable(self) except? -1:
        """1: adaptive feed works."""
        return 0

    cpdef int get_external_feed_hold_enable(self) except? -1:
        """1: feed hold works."""
        return 1

    cpdef int get_external_digital_input(self, int index, int default) except? -1:
        """A digital input, ``default`` where there is none to be read."""
        return default

    cpdef double get_external_analog_input(self, int index, double default) except? -1:
        """An analog input, ``default`` where there is none to be read."""
        return default

    cpdef int get_external_offset_applied(self) except? -1:
        """1: external offsets are in force."""
        return 0

    cpdef tuple get_external_offsets(self):
        """The external offsets in force: X to W, program units."""
        return (0.0,) * 9

    cpdef object get_external_parameter(self, str name):
        """Value of ``#<_hal[pin]>`` and other named parameters that the interpreter does not know; None: unknown."""
        return None

    cpdef bint get_block_delete(self) except *:
        """Skip lines that begin with a slash."""
        return self.block_delete

    cpdef bint get_optional_program_stop(self) except *:
        """Stop at M1."""
        return self.optional_stop

    cpdef int wait(self, int index, int input_type, int wait_type, double timeout) except? -1:
        """Wait for an input (M66): type 1 digital, 0 analog; wait 0 at once, 1 rise, 2 fall, 3 high, 4 low; seconds. 0: fine."""
        return -1

    cpdef bint user_command_exists(self, int number) except *:
        """Is there a program for Mnnn?"""
        return False
