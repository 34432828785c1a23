"""The table of G and M codes, and the executor that works by it.

To add a code: write its handler in the module that it belongs to and add one row here. A row names the code, its modal
group, the words that it may use besides the axes, its handler, what it checks before anything runs, and what it does.
"""

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_SIDE_OFF
from rs274ngc.comments cimport act_on_comment
from rs274ngc.compensation cimport set_compensation
from rs274ngc.context cimport context
from rs274ngc.cycles cimport canned_cycle
from rs274ngc.lathe cimport lathe_cycle
from rs274ngc.machine cimport (
    analog_output, check_orient, coolant, orient, output, overrides, program_end, program_stop, spindle, user_code,
    wait_input, subprogram_end,
)
from rs274ngc.modal cimport *
from rs274ngc.modes cimport (
    check_spindle_mode, set_control, set_diameter_mode, set_distance, set_feed, set_feed_mode, set_ijk_distance, set_plane,
    set_retract, set_speed, set_spindle_mode, set_units,
)
from rs274ngc.motion cimport (
    arc, cancel_motion, check_dwell, check_home, check_machine_coordinates, check_turns, dwell, home, probe, reference_move,
    straight,
)
from rs274ngc.offsets cimport (
    axis_offset, check_axis_offset, check_g10, select_origin, set_data, store_reference, tool_length,
)
from rs274ngc.path cimport check_polar, polar_to_xy
from rs274ngc.remapping cimport take_over
from rs274ngc.splines cimport cubic_spline, nurbs_end, nurbs_knot, nurbs_point, quadratic_spline
from rs274ngc.state cimport State, fail, fail_word
from rs274ngc.threads cimport check_g76, check_threading, rigid_tap, spindle_feed, threading_cycle
from rs274ngc.tools cimport change_tool, declare_tool, select_tool

TABLE = []
"""The rows for people and for ``docs/gcode.md``: (code, modal group, words, summary)."""

cdef int LETTERS = 27


cdef unsigned int mask_of(str letters) except? 0:
    cdef unsigned int mask = 0
    for letter in letters:
        mask |= 1 << (W_DOLLAR if letter == "$" else ord(letter) - ord("A"))
    return mask


cdef void g(double code, int group, str words, Handler handler, str summary, Handler check=NULL, int flags=NO_FLAGS,
            int step=STEP_NONE) except *:
    cdef int number = <int>(code * 10.0 + 0.5)
    g_group[number] = group
    g_code[number] = Code(handler, check, mask_of(words), flags, g_steps[group] if step == STEP_NONE else 1ULL << step)
    TABLE.append((f"G{number // 10}" + (f".{number % 10}" if number % 10 else ""), group, words, summary))


cdef void m(int code, int group, str words, Handler handler, str summary, Handler check=NULL, int flags=NO_FLAGS) except *:
    m_group[code] = group
    m_code[code] = Code(handler, check, mask_of(words), flags, m_steps[group])
    TABLE.append((f"M{code}", group, words, summary))


# --- Group 0: for one line only
g(4, 0, "P", dwell, "Dwell P seconds", check_dwell, NO_FLAGS, STEP_DWELL)
g(10, 0, "LPRIJQ", set_data, "Set tool table (L0, L1, L10, L11) or coordinate system (L2, L20)", check_g10, AXES_TAKEN)
g(28, 0, "", reference_move, "Go to the first reference point", NULL, AXES_TAKEN)
g(28.1, 0, "", store_reference, "Store the first reference point")
g(28.2, 0, "P", home, "Home joint P, or with P-1 all joints in their sequence", check_home)
g(30, 0, "", reference_move, "Go to the second reference point", NULL, AXES_TAKEN)
g(30.1, 0, "", store_reference, "Store the second reference point")
g(52, 0, "", axis_offset, "Local offset", check_axis_offset, AXES_TAKEN)
g(53, 0, "", NULL, "The move of this line is in machine coordinates", check_machine_coordinates)
g(92, 0, "", axis_offset, "Offset that makes here the named point", check_axis_offset, AXES_TAKEN)
g(92.1, 11, "", axis_offset, "Cancel the G92 offset and forget it")
g(92.2, 11, "", axis_offset, "Cancel the G92 offset and keep it")
g(92.3, 11, "", axis_offset, "Use the kept G92 offset again")
# --- Group 1: motion
g(0, 1, "", straight, "Rapid move")
g(1, 1, "", straight, "Straight feed")
g(2, 1, "IJKRP", arc, "Arc or helix, clockwise", check_turns)
g(3, 1, "IJKRP", arc, "Arc or helix, counter-clockwise", check_turns)
g(5, 1, "IJPQ", cubic_spline, "Cubic spline", NULL, AXES_NEEDED)
g(5.1, 1, "IJ", quadratic_spline, "Quadratic spline", NULL, AXES_NEEDED)
g(5.2, 1, "PL", nurbs_point, "NURBS: control point")
g(5.3, 1, "", nurbs_end, "NURBS: end")
g(6.2, 1, "KPQR", nurbs_knot, "NURBS with knots: control point with weight R and knot K, order P")
g(33, 1, "EK$", spindle_feed, "Spindle-synchronised move; E is ignored", check_threading, AXES_NEEDED)
g(33.1, 1, "EK$I", rigid_tap, "Rigid tapping; E is ignored", check_threading, AXES_NEEDED)
g(38.2, 1, "", probe, "Probe towards, error if nothing was found", NULL, AXES_NEEDED)
g(38.3, 1, "", probe, "Probe towards", NULL, AXES_NEEDED)
g(38.4, 1, "", probe, "Probe away, error if contact was not lost", NULL, AXES_NEEDED)
g(38.5, 1, "", probe, "Probe away", NULL, AXES_NEEDED)
g(70, 1, "DEPQ", lathe_cycle, "Lathe finishing cycle")
g(71, 1, "DIQR", lathe_cycle, "Lathe roughing cycle along Z")
g(71.1, 1, "DIQR", lathe_cycle, "Lathe roughing cycle along Z, without pockets")
g(71.2, 1, "DIQR", lathe_cycle, "Lathe roughing cycle along Z, after the first pocket")
g(72, 1, "DIQR", lathe_cycle, "Lathe roughing cycle along X")
g(72.1, 1, "DIQR", lathe_cycle, "Lathe roughing cycle along X, without pockets")
g(72.2, 1, "DIQR", lathe_cycle, "Lathe roughing cycle along X, after the first pocket")
g(73, 1, "LQR", canned_cycle, "Drilling cycle with chip breaking", NULL, AXES_NEEDED | NO_ROTARY)
g(74, 1, "LPR$", canned_cycle, "Left-hand tapping cycle", NULL, AXES_NEEDED | NO_ROTARY)
g(76, 1, "EHIJKLPQR$", threading_cycle, "Threading cycle", check_g76, AXES_NEEDED)
g(80, 1, "", cancel_motion, "Cancel the motion mode")
g(81, 1, "LR", canned_cycle, "Drilling cycle", NULL, AXES_NEEDED | NO_ROTARY)
g(82, 1, "LPR", canned_cycle, "Drilling cycle with dwell", NULL, AXES_NEEDED | NO_ROTARY)
g(83, 1, "LQR", canned_cycle, "Peck drilling cycle", NULL, AXES_NEEDED | NO_ROTARY)
g(84, 1, "LPR$", canned_cycle, "Right-hand tapping cycle", NULL, AXES_NEEDED | NO_ROTARY)
g(85, 1, "LR", canned_cycle, "Boring cycle, feed out", NULL, AXES_NEEDED | NO_ROTARY)
g(86, 1, "LPR", canned_cycle, "Boring cycle, spindle stop, rapid out", NULL, AXES_NEEDED | NO_ROTARY)
g(87, 1, "IJKLR", canned_cycle, "Back-boring cycle", NULL, AXES_NEEDED | NO_ROTARY)
g(88, 1, "LPR", canned_cycle, "Boring cycle, spindle stop, out by hand", NULL, AXES_NEEDED | NO_ROTARY)
g(89, 1, "LPR", canned_cycle, "Boring cycle, dwell, feed out", NULL, AXES_NEEDED | NO_ROTARY)
# --- The other modal groups
g(17, 2, "", set_plane, "XY plane")
g(18, 2, "", set_plane, "XZ plane")
g(19, 2, "", set_plane, "YZ plane")
g(17.1, 2, "", set_plane, "UV plane")
g(18.1, 2, "", set_plane, "UW plane")
g(19.1, 2, "", set_plane, "VW plane")
g(90, 3, "", set_distance, "Absolute distances")
g(91, 3, "", set_distance, "Incremental distances")
g(90.1, 4, "", set_ijk_distance, "Absolute arc centres")
g(91.1, 4, "", set_ijk_distance, "Incremental arc centres")
g(93, 5, "", set_feed_mode, "Inverse time feed")
g(94, 5, "", set_feed_mode, "Feed per minute")
g(95, 5, "$", set_feed_mode, "Feed per revolution")
g(20, 6, "", set_units, "Inches")
g(21, 6, "", set_units, "Millimetres")
g(40, 7, "", set_compensation, "Cutter compensation off")
g(41, 7, "D", set_compensation, "Cutter compensation left")
g(42, 7, "D", set_compensation, "Cutter compensation right")
g(41.1, 7, "DLR", set_compensation, "Cutter compensation left with diameter D; R is ignored")
g(42.1, 7, "DLR", set_compensation, "Cutter compensation right with diameter D; R is ignored")
g(43, 8, "H", tool_length, "Tool length offset of a tool")
g(43.1, 8, "", tool_length, "Tool length offset of the axis words", NULL, AXES_TAKEN)
g(43.2, 8, "H", tool_length, "Additional tool length offset", NULL, AXES_TAKEN)
g(49, 8, "", tool_length, "Tool length offset off")
g(98, 10, "", set_retract, "Cycles retract to the old Z")
g(99, 10, "", set_retract, "Cycles retract to R")
for index, name in enumerate((54.0, 55.0, 56.0, 57.0, 58.0, 59.0, 59.1, 59.2, 59.3)):
    g(name, 12, "", select_origin, f"Coordinate system {index + 1}")
g(61, 13, "", set_control, "Exact path")
g(61.1, 13, "", set_control, "Exact stop")
g(64, 13, "PQ", set_control, "Path blending with tolerance P, naive CAM tolerance Q")
g(96, 14, "D$", set_spindle_mode, "Constant surface speed, at most D turns a minute", check_spindle_mode)
g(97, 14, "$", set_spindle_mode, "Constant spindle speed")
g(7, 15, "", set_diameter_mode, "X in diameters")
g(8, 15, "", set_diameter_mode, "X in radii")
# --- M codes
m(0, M_STOP, "", program_stop, "Program stop")
m(1, M_STOP, "", program_stop, "Optional program stop")
m(2, M_STOP, "", program_end, "Program end")
m(30, M_STOP, "", program_end, "Program end, pallet exchange")
m(60, M_STOP, "", program_stop, "Pallet exchange and program stop")
m(99, M_STOP, "", subprogram_end, "Return from a subprogram; in the main program: begin again (a machine), or end (rs274, previews)")
m(3, M_SPINDLE, "$", spindle, "Spindle clockwise")
m(4, M_SPINDLE, "$", spindle, "Spindle counter-clockwise")
m(5, M_SPINDLE, "$", spindle, "Spindle stop")
m(19, M_SPINDLE, "PQR$", orient, "Orient the spindle", check_orient)
m(6, M_CHANGE, "", change_tool, "Tool change")
m(61, M_CHANGE, "Q", declare_tool, "Set the current tool")
m(7, M_COOLANT, "", coolant, "Mist on")
m(8, M_COOLANT, "", coolant, "Flood on")
m(9, M_COOLANT, "", coolant, "Coolant off")
m(48, M_OVERRIDES, "", overrides, "Overrides on")
m(49, M_OVERRIDES, "", overrides, "Overrides off")
m(50, M_OVERRIDES, "P", overrides, "Feed override on or off")
m(51, M_OVERRIDES, "P$", overrides, "Speed override on or off")
m(52, M_OVERRIDES, "P", overrides, "Adaptive feed on or off")
m(53, M_OVERRIDES, "P", overrides, "Feed hold on or off")
m(62, M_OUTPUTS, "P", output, "Digital output on with motion")
m(63, M_OUTPUTS, "P", output, "Digital output off with motion")
m(64, M_OUTPUTS, "P", output, "Digital output on")
m(65, M_OUTPUTS, "P", output, "Digital output off")
m(66, M_OUTPUTS, "ELPQ", wait_input, "Wait for an input")
m(67, M_OUTPUTS, "EQ", analog_output, "Analog output with motion")
m(68, M_OUTPUTS, "EQ", analog_output, "Analog output")
m(70, M_SPINDLE, "", context, "Save modal state")
m(71, M_SPINDLE, "", context, "Invalidate saved modal state")
m(72, M_SPINDLE, "", context, "Restore modal state")
m(73, M_SPINDLE, "", context, "Save modal state, restore it at return")
for index in range(100, 200):
    m(index, M_USER, "PQ", user_code, "The user's own program")
TABLE[:] = [row for row in TABLE if len(row[0]) < 4 or "." in row[0]]
TABLE.append(("M100-M199", M_USER, "PQ", "The user's own program"))

UNUSED = (
    (W_D, "D word with no G41, G41.1, G42, G42.1, G71, G71.1, G71.2 or G96 to use it"),
    (W_DOLLAR, "$ (spindle selection) word with no M3, M4, M5, M19, M51, G33, G33.1, G76, G95, G96 or G97 to use it"),
    (W_E, "E word with no G70, G76, M66, M67 or M68 to use it"),
    (W_H, "H word with no G43 or G76 to use it"),
    (W_I, "I word with no G2, G3, G5, G5.1, G10, G33.1, G76, or G87 to use it"),
    (W_J, "J word with no G2, G3, G5, G5.1, G10, G76 or G87 to use it"),
    (W_K, "K word with no G2, G3, G33, G33.1, G76, or G87 to use it"),
    (W_L, "L word with no G10, cutter compensation, canned cycle, digital/analog input, M98 or NURBS code"),
    (W_P, "P word with no G2 G3 G4 G10 G64 G5 G5.2 G76 G82 G86 G88 G89"
          " or M50 M51 M52 M53 M62 M63 M64 M65 M66 M98 or user M code to use it"),
    (W_Q, "Q word with no G5, G10, G64, G73, G76, G83, M19, M66, M67, M68 or user M code that uses it"),
    (W_R, "R word with no g code that uses it"),
)
"""What is said of a word that no code of the line uses, in the order in which the words are looked at."""

cdef unsigned int CHECKED = mask_of("DEHIJKLPQR$")
cdef int SIDE_OFF = CANON_SIDE_OFF
cdef str IDLE_AXES = "Cannot use axis values without a g code that uses them"


# --- What a line means as a whole

cdef bint axes_taken(const Block* b) noexcept:
    """Whether a code other than the motion uses the axis words."""
    return (b.g[0] >= 0 and g_code[b.g[0]].flags & AXES_TAKEN) or (b.g[8] >= 0 and g_code[b.g[8]].flags & AXES_TAKEN)


cdef int enhance(State s, Block* b) except -1:
    """Find the motion of a line: its own, or the modal one if there is something to move."""
    cdef bint axes = (b.words & (M_AXES | M_POLAR)) != 0
    cdef bint taken_by_0 = b.g[0] >= 0 and g_code[b.g[0]].flags & AXES_TAKEN
    cdef bint taken = axes_taken(b)
    b.motion = -1
    if b.words & M_POLAR:
        check_polar(s, b)
    if b.g[1] >= 0:
        if b.g[1] == 53 and b.g[0] >= 0:
            return fail(s, "Two g codes used from same modal group", b.g_at[1])
        if b.g[1] == 53 and axes and s.motion == 800:
            return fail(s, IDLE_AXES)
        if b.g[1] == 800:
            if axes and not taken_by_0:
                return fail(s, "Cannot use axis values with g80", b.g_at[1])
        else:
            if taken_by_0:
                return fail(s, "Cannot use two g codes that both use axis values", b.g_at[1])
            if not axes and g_code[b.g[1]].flags & AXES_NEEDED and f"G{b.g[1]}" not in s.remaps:
                return fail(s, "All axes missing with motion code", b.g_at[1])
        b.motion = b.g[1]
    elif taken:
        pass
    elif axes:
        if s.motion == 800:
            return fail(s, IDLE_AXES)
        b.motion = s.motion
    elif b.words & M_IJK and (s.motion == 20 or s.motion == 30):
        b.motion = s.motion
    if b.words & M_POLAR and b.motion < 0:
        return fail(s, "Polar coordinates can only be used for motion")
    if b.motion >= 0:
        b.steps |= 1ULL << STEP_MOTION
    return 0


cdef int refuse_rotary(State s, const Block* b) except -1:
    for axis, article in ((W_A, "an a"), (W_B, "a b"), (W_C, "a c")):
        if has(b, axis):
            return fail_word(s, f"Cannot put {article} in canned cycle", axis)
    return 0


cdef bint any_remapped(State s, const Block* b):
    """Whether a G or M code of the line is remapped."""
    cdef int group
    if b.motion >= 0 and f"G{b.motion}" in s.remaps:
        return True
    for group in range(M_GROUPS):
        if b.m[group] >= 0 and f"M{b.m[group]}" in s.remaps:
            return True
    return False


cdef int check(State s, Block* b) except -1:
    """Everything that must hold before the first thing of a line is done."""
    cdef int group, code
    cdef unsigned int allowed = 0
    if s.remaps and any_remapped(s, b):
        return 0        # the words of the line are for the procedure, which does its own checks
    if b.g[0] >= 0 and g_code[b.g[0]].check != NULL:
        g_code[b.g[0]].check(s, b, b.g[0])
    if b.m_count > 4:
        return fail(s, "Too many m codes on line")
    for group in range(G_GROUPS):
        if b.g[group] >= 0:
            allowed |= g_code[b.g[group]].words
    if b.motion >= 0:
        allowed |= g_code[b.motion].words
    if has(b, W_S):
        allowed |= 1 << W_DOLLAR
    if b.m_count:
        for group in range(M_GROUPS):
            if b.m[group] >= 0:
                allowed |= m_code[b.m[group]].words
    if b.motion >= 0 and b.words & M_ABC and g_code[b.motion].flags & NO_ROTARY:
        return refuse_rotary(s, b)
    if b.words & CHECKED & ~allowed:
        for word, message in UNUSED:
            if has(b, word) and not (allowed >> <int>word) & 1:
                return fail_word(s, message, word)
    for group in range(2, G_GROUPS):
        if b.g[group] >= 0 and g_code[b.g[group]].check != NULL:
            g_code[b.g[group]].check(s, b, b.g[group])
    if b.motion >= 0 and g_code[b.motion].check != NULL:
        g_code[b.motion].check(s, b, b.motion)
    if b.m_count:
        for group in range(M_GROUPS):
            if b.m[group] >= 0 and m_code[b.m[group]].check != NULL:
                m_code[b.m[group]].check(s, b, b.m[group])
    if b.motion < 0 and s.motion < 0 and b.g[1] < 0 and b.words & M_AXES and not axes_taken(b):
        return fail(s, IDLE_AXES)
    return 0


# --- Execution

cdef int run(State s, Block* b) except -1:
    """Do what a line says, in the order of execution."""
    cdef unsigned long long steps = b.steps
    cdef int step = 0, code
    while steps:
        while not steps & 1:
            steps >>= 1
            step += 1
        if s.remaps and take_over(s, b, step):
            return 0
        if step == STEP_MOTION:
            if g_code[b.motion].run != canned_cycle:
                s.in_cycles = False
            if b.words & M_POLAR:
                polar_to_xy(s, b)
            g_code[b.motion].run(s, b, b.motion)
        elif step_g[step] >= 0:
            code = b.g[step_g[step]]
            if g_code[code].run != NULL:
                g_code[code].run(s, b, code)
        elif step_m[step] >= 0:
            code = b.m[step_m[step]]
            m_code[code].run(s, b, code)
        elif step == STEP_FEED:
            set_feed(s, b)
        elif step == STEP_SPEED:
            set_speed(s, b)
        elif step == STEP_TOOL:
            select_tool(s, b)
        else:
            act_on_comment(s, b)
        steps >>= 1
        step += 1
    return 0
