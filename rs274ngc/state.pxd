"""C face of the interpreter's state: see state.pyx."""

from rs274ngc.block cimport Block, LINE_SIZE
from rs274ngc.canon cimport Canon

cdef enum:
    SPINDLES = 8
    PARAMETERS = 5603
    LOCALS = 30
    LEVELS = 10

    # Results of read and execute, LinuxCNC's numbers
    OK = 0
    EXIT = 1
    FINISH = 2
    ENDFILE = 3

    # Reasons to wait for the machine before the next read
    WAIT_PROBE = 1
    WAIT_TOOL = 2
    WAIT_INPUT = 4

    # [RS274NGC]FEATURES
    FEATURE_RETAIN_G43 = 1
    FEATURE_OWORD_N_ARGS = 2
    FEATURE_INI_VARS = 4
    FEATURE_HAL_PIN_VARS = 8
    FEATURE_NO_DOWNCASE_OWORD = 16
    FEATURE_OWORD_WARNONLY = 32


cdef class Frame:
    """One level of the program: the main program, or a subroutine that was called."""

    cdef public str sub             # name of the subroutine, empty for the main program
    cdef public str file
    cdef public object source
    cdef public long position       # where to go on after the call: offset of the next line in ``source``
    cdef public int line            # and the line of that offset
    cdef public dict named          # local named parameters
    cdef public dict labels         # O-labels of this level
    cdef public object saved        # modal state stored by M70, M73
    cdef public bint restore        # M73: restore at return
    cdef public bint fanuc          # called by M98: parameters are shared
    cdef public int repeats         # M98 L: calls still to do
    cdef public long body           # offset of the subroutine's first line
    cdef public int body_line
    cdef public object remap        # the Pending whose procedure this is
    cdef double locals[LOCALS + 1]


cdef class State:
    cdef public Canon canon
    cdef public object ini
    # Position: program units, program coordinates; rotary axes in degrees
    cdef double pos[9]
    cdef double origin[9]
    cdef double g92[9]
    cdef double tool[9]
    cdef double rotation            # degrees
    cdef public int origin_index
    # Modal groups
    cdef public int motion          # G code times 10, -1: none
    cdef public int plane           # CANON_PLANE_*
    cdef public int units           # CANON_UNITS_*
    cdef public bint incremental, ijk_absolute, diameter_mode, retract_old_z
    cdef public int feed_mode       # 930, 940, 950
    cdef public int control_mode    # CANON_EXACT_STOP ...
    cdef public double tolerance, naivecam_tolerance
    cdef public int comp_side       # CANON_SIDE_*
    cdef public bint g43_active
    cdef public bint g92_applied
    cdef public double feed
    cdef public int spindles
    cdef double speed[SPINDLES]
    cdef int turning[SPINDLES]      # CANON_STOPPED, _CLOCKWISE, _COUNTERCLOCKWISE
    cdef double css[SPINDLES]       # greatest speed with G96, 0: G97
    cdef public int active_spindle
    cdef public bint flood, mist, feed_override, adaptive_feed, feed_hold
    cdef bint speed_override[SPINDLES]
    # Sticky numbers of the canned cycles
    cdef double cycle_z, cycle_r, cycle_q, cycle_p, cycle_i, cycle_j, cycle_k
    cdef double cycle_level         # height before the first of the cycles that follow one another
    cdef bint in_cycles
    # Tools
    cdef public int selected_index, selected_tool, tool_index
    cdef public int current_tool
    cdef public bint random_toolchanger, change_with_spindle_on, change_with_quill_up, change_at_g30
    cdef public int waiting          # WAIT_*
    cdef int input_index
    cdef bint input_digital
    # Cutter compensation
    cdef public double comp_radius
    cdef public int comp_orientation
    cdef public bint comp_first, arc_not_allowed
    cdef double comp_x, comp_y, comp_z      # programmed point while the tool is elsewhere
    cdef public object comp_queue
    # Splines
    cdef public list nurbs_points, nurbs_knots
    cdef public double nurbs_order
    cdef double last_i, last_j
    cdef public bint nurbs_active
    # Parameters
    cdef double params[PARAMETERS]
    cdef public dict globals
    cdef public list frames
    cdef public Frame frame
    cdef public dict subs
    cdef public double return_value
    cdef public bint value_returned
    cdef public set persistent
    # Settings of the INI file
    cdef public int features, wrapped_rotary
    cdef public double arc_tolerance_inch, arc_tolerance_mm, orient_offset
    cdef public bint g92_persistent, fanuc_subs, no_probe_home_error, lathe_retract
    cdef public int axis_mask
    cdef int indexer[3]             # joint of a locking indexer A, B, C; -1: none
    cdef public list subroutine_path
    cdef public str program_prefix
    # Remapped codes
    cdef public dict remaps         # Remap by key
    cdef public list remap_stack    # Pendings, the innermost last
    cdef public object resume       # the Pending whose steps are to go on
    cdef public object plugin       # the Python plug-in; None: there is none
    # The line in work
    cdef Block block
    cdef char raw[LINE_SIZE]
    cdef int raw_size
    cdef char text[LINE_SIZE]       # stripped and in lower case
    cdef int size
    cdef public str file
    cdef public int line
    cdef public int error_at
    cdef public int modal_version
    cdef public int last_setting, last_change   # G code of group 0 times 10 and M6 or M61 of the last line, -1: none
    cdef public bint percent, ended, must_finish
    cdef public bint profile        # a lathe profile is read: its A, C, U, W are no axes
    cdef object named_lookup
    cdef public long blocks
    cdef public object interp


cdef int fail(State s, str message, int at=*) except -1
cdef int fail_word(State s, str message, int word) except -1
cdef void remember_position(State s) noexcept
cdef double unit_factor(State s) noexcept
cdef void rotate(double* xy, double degrees) noexcept
cdef void program_to_machine(State s, double* point) noexcept
