"""Origins and offsets: G10, G28.1, G30.1, G43 to G49, G52, G54 to G59.3, G92 to G92.3.

The position of the tool in the world does not change with an offset, so its program coordinates do: every function here
takes the point to machine coordinates with the old offsets and back with the new ones. Offsets in parameters and in the
tool table are in machine units, in the state and in canon calls in program units.
"""

from libc.math cimport fabs, floor
from libc.string cimport memcpy, memset

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_SIDE_OFF, CANON_UNITS_INCHES

from rs274ngc.path cimport axis_words, machine_to_program
from rs274ngc.state cimport WAIT_TOOL, State, fail, fail_word, program_to_machine, remember_position, rotate
from rs274ngc.tools cimport find_tool, refresh_tool_parameters

cdef int SIDE_OFF = CANON_SIDE_OFF, INCHES = CANON_UNITS_INCHES
cdef double WHOLE_TOLERANCE = 0.0001       # of P, above a whole number only, and Q

cdef enum:
    G10_TABLE = 0       # modal group 0
    ORIGIN_FIRST = 5221 # X of G54; the next system 20 further on, R at +9
    ORIGIN_STEP = 20
    G92_FIRST = 5211
    G92_ACTIVE = 5210
    ORIGIN_ACTIVE = 5220


# --- Units and points

cdef double parameter_factor(State s, int axis) except? -1.0:
    """Program units in a unit of the var file and the tool table (machine units)."""
    if 3 <= axis <= 5:
        return 1.0 / s.canon.get_external_angle_units()
    return 1.0 / (s.canon.get_external_length_units() * (25.4 if s.units == INCHES else 1.0))


cdef void to_machine(State s, double* point) noexcept:
    """The position in machine coordinates, program units."""
    memcpy(point, s.pos, sizeof(s.pos))
    program_to_machine(s, point)


cdef void to_program(State s, double* point) noexcept:
    """``point``, a machine point, becomes the position under the offsets now in force."""
    machine_to_program(s, point)
    memcpy(s.pos, point, sizeof(s.pos))
    s.comp_x, s.comp_y, s.comp_z = point[0], point[1], point[2]


cdef int send_origin(State s) except -1:
    s.canon.set_g5x_offset(s.origin_index, s.origin[0], s.origin[1], s.origin[2], s.origin[3], s.origin[4], s.origin[5],
                           s.origin[6], s.origin[7], s.origin[8])
    return 0


cdef int send_g92(State s) except -1:
    s.canon.set_g92_offset(s.g92[0], s.g92[1], s.g92[2], s.g92[3], s.g92[4], s.g92[5], s.g92[6], s.g92[7], s.g92[8])
    return 0


cdef int send_tool_offset(State s) except -1:
    """Tell the canon the tool offset in force."""
    s.canon.use_tool_length_offset(s.tool[0], s.tool[1], s.tool[2], s.tool[3], s.tool[4], s.tool[5], s.tool[6], s.tool[7],
                                   s.tool[8])
    return 0


cdef int shift_tool_offset(State s, tuple offset) except -1:
    """Another tool offset, program units: the place stays, its coordinates do not."""
    cdef double[9] point
    cdef int k
    to_machine(s, point)
    for k in range(9):
        s.tool[k] = offset[k]
    to_program(s, point)
    return send_tool_offset(s)


# --- Coordinate systems

cdef int activate_origin(State s, int index) except -1:
    """Take the origin and the rotation of coordinate system ``index`` from the parameters."""
    cdef int k
    s.origin_index = index
    s.params[ORIGIN_ACTIVE] = index
    for k in range(9):
        s.origin[k] = s.params[ORIGIN_FIRST + (index - 1) * ORIGIN_STEP + k] * parameter_factor(s, k)
    s.rotation = s.params[ORIGIN_FIRST + (index - 1) * ORIGIN_STEP + 9]
    return 0


cdef int select_origin(State s, Block* b, int code) except -1:
    """G54 to G59.3"""
    cdef double[9] point
    cdef int index = (code - 540) // 10 + 1 if code <= 590 else code - 590 + 6
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot change coordinate systems with cutter radius compensation on", b.g_at[12])
    if index == s.origin_index:
        s.canon.comment("interpreter: continuing to use same coordinate system")
        return 0
    to_machine(s, point)
    activate_origin(s, index)
    to_program(s, point)
    send_origin(s)
    send_g92(s)
    s.canon.set_xy_rotation(s.rotation)
    return 0


cdef int change_origin(State s, int index) except -1:
    """At the end of a program: ``index`` becomes active and the canon hears of it, whether it was or not."""
    cdef double[9] point
    to_machine(s, point)
    activate_origin(s, index)
    to_program(s, point)
    send_origin(s)
    s.canon.set_xy_rotation(s.rotation)
    return 0


cdef int store_reference(State s, Block* b, int code) except -1:
    """G28.1, G30.1: here is the reference point"""
    cdef double[9] point
    cdef int k, first = 5161 if code == 281 else 5181
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot set reference point with cutter compensation in effect", b.g_at[0])
    to_machine(s, point)
    for k in range(9):
        s.params[first + k] = point[k] / parameter_factor(s, k)
    return 0


# --- G92 and G52

cdef int check_axis_offset(State s, Block* b, int code) except -1:
    if (code == 920 or code == 520) and not (b.words & M_AXES):
        return fail(s, "All axes missing with g52 or g92", b.g_at[0])
    return 0


cdef int axis_offset(State s, Block* b, int code) except -1:
    """G92, G92.1, G92.2, G92.3, G52"""
    cdef double[9] point
    cdef double value
    cdef int k
    if s.comp_side != SIDE_OFF and (code == 920 or code == 520):
        return fail(s, "Cannot change axis offsets with cutter radius comp", b.g_at[0])
    if s.comp_side != SIDE_OFF:
        return 0        # without a word, as in LinuxCNC
    if code == 920 or code == 520:
        to_machine(s, point)
        for k in range(9):
            if has(b, axis_words[k]):
                value = b.value[axis_words[k]]
                if k == 0 and s.diameter_mode:
                    value *= 0.5
                s.g92[k] = value if code == 520 else s.pos[k] + s.g92[k] - value
        s.params[G92_ACTIVE] = 1.0
        save_g92(s)
    elif code == 923:
        to_machine(s, point)
        s.params[G92_ACTIVE] = 1.0
        for k in range(9):
            s.g92[k] = s.params[G92_FIRST + k] * parameter_factor(s, k)
    else:
        to_machine(s, point)
        memset(s.g92, 0, sizeof(s.g92))
        s.params[G92_ACTIVE] = 0.0
        if code == 921:
            save_g92(s)
    s.g92_applied = s.params[G92_ACTIVE] != 0.0
    to_program(s, point)
    return send_g92(s)


cdef int save_g92(State s) except -1:
    cdef int k
    for k in range(9):
        s.params[G92_FIRST + k] = s.g92[k] / parameter_factor(s, k)
    return 0


# --- G10

cdef int whole_p(const Block* b) noexcept:
    """The number of a tool."""
    return <int>floor(b.value[W_P] + 0.5)


cdef int check_g10(State s, Block* b, int code) except -1:
    cdef int l = <int>value_or(b, W_L, -1.0)
    cdef double p = value_or(b, W_P, -1.0)
    if l not in (0, 1, 2, 10, 11, 20):
        return fail_word(s, "Line with G10 does not have L0, L1, L10, L11, L2, or L20", W_L)
    if l == 0:
        return 0
    if fabs(p) > 1.0e9 or p - floor(p + 0.5) > WHOLE_TOLERANCE:
        return fail_word(s, "P value not an integer with G10", W_P)
    if l == 2 or l == 20:
        if not 0 <= whole_p(b) <= 9 or not has(b, W_P):
            return fail_word(s, f"P value out of range (0-9) with G10 L{l}", W_P)
        if l == 2 and (has(b, W_I) or has(b, W_J)):
            return fail(s, "I J words not allowed with G10 L2", b.g_at[0])
        return 0
    if whole_p(b) < 1:
        return fail_word(s, f"P value out of range with G10 L{l}", W_P)
    return 0


cdef int set_data(State s, Block* b, int code) except -1:
    """G10 L0, L1, L2, L10, L11, L20"""
    cdef int l = <int>b.value[W_L]
    if l == 0:
        return reload_tools(s, b)
    if l == 20 and has(b, W_R):
        return fail_word(s, "R not allowed in G10 L20", W_R)
    if l == 2 or l == 20:
        return set_origin(s, b, l)
    return set_tool(s, b, l)


cdef int reload_tools(State s, Block* b) except -1:
    if s.current_tool > 0:
        return fail(s, f"G10 L0 not allowed with loaded tool <{s.current_tool}>\n", b.g_at[0])
    s.canon.reload_tooldata()
    s.waiting |= WAIT_TOOL
    return 0


cdef int set_origin(State s, Block* b, int l) except -1:
    """L2: the origin itself; L20: the origin that gives the present position these coordinates"""
    cdef double[9] point
    cdef double[9] wanted
    cdef double[9] old
    cdef double value, rotation
    cdef double* stored
    cdef int k, index = <int>b.value[W_P]
    if index == 0:
        index = s.origin_index
    if s.comp_side != SIDE_OFF and index == s.origin_index:
        return fail(s, "Cannot change the active coordinate system with cutter radius compensation on", b.g_at[0])
    to_machine(s, point)
    stored = &s.params[ORIGIN_FIRST + (index - 1) * ORIGIN_STEP]
    if has(b, W_R):
        stored[9] = b.value[W_R]
    rotation = stored[9]
    if l == 20:
        # The origin is where the present point, moved back by the wanted coordinates turned into the system, would be.
        for k in range(9):
            wanted[k] = point[k] - s.tool[k] - stored[k] * parameter_factor(s, k)
        rotate(wanted, -rotation)
        for k in range(9):
            if has(b, axis_words[k]):
                value = b.value[axis_words[k]]
                wanted[k] = (value * 0.5 if k == 0 and s.diameter_mode else value) + s.g92[k]
        rotate(wanted, rotation)
        for k in range(9):
            stored[k] = (point[k] - s.tool[k] - wanted[k]) / parameter_factor(s, k)
    else:
        for k in range(9):
            if has(b, axis_words[k]):
                value = b.value[axis_words[k]]
                if k == 0 and s.diameter_mode:
                    value *= 0.5
                stored[k] = value / parameter_factor(s, k)
    if index != s.origin_index:
        s.canon.comment("interpreter: setting coordinate system origin")
        return 0
    memcpy(old, s.origin, sizeof(old))
    rotation = s.rotation
    activate_origin(s, index)
    turn_position(s, old, rotation)
    send_origin(s)
    s.canon.set_xy_rotation(s.rotation)
    return 0


cdef void turn_position(State s, const double* origin, double rotation) noexcept:
    """After G10 on the active system, until now with ``origin`` and ``rotation``: G92 does not turn, as in LinuxCNC."""
    cdef double[9] point
    cdef int k
    memcpy(point, s.pos, sizeof(point))
    rotate(point, rotation)
    for k in range(9):
        point[k] += origin[k] - s.origin[k]
    rotate(point, -s.rotation)
    memcpy(s.pos, point, sizeof(s.pos))
    s.comp_x, s.comp_y, s.comp_z = point[0], point[1], point[2]


cdef int set_tool(State s, Block* b, int l) except -1:
    """L1: offsets as given; L10, L11: offsets that give the present position these coordinates"""
    cdef double[9] point
    cdef double value, diameter, front, back
    cdef int k, number = whole_p(b), index, orientation
    index = find_tool(s, number, b.at[W_P])
    entry = s.canon.get_external_tool_table(index)
    offset = list(entry.offset)
    diameter = entry.diameter
    front, back, orientation = entry.frontangle, entry.backangle, entry.orientation
    if not (b.words & (M_AXES | (1 << W_R) | (1 << W_I) | (1 << W_J) | (1 << W_Q))):
        return fail(s, "G10 L1 without offsets has no effect", b.g_at[0])
    if l == 1:
        for k in range(9):
            if has(b, axis_words[k]):
                value = b.value[axis_words[k]]
                offset[k] = (value * 0.5 if k == 0 and s.diameter_mode else value) / parameter_factor(s, k)
    else:
        to_machine(s, point)
        shift_to_here(s, b, l, point, offset)
    if has(b, W_R):
        diameter = b.value[W_R] * 2.0 / parameter_factor(s, 0)
    front, back = value_or(b, W_I, front), value_or(b, W_J, back)
    value = value_or(b, W_Q, MISSING)
    if value != MISSING:
        if value > 9.5:
            return fail_word(s, "Invalid tool orientation", W_Q)
        if value < 0.0 or fabs(value - floor(value + 0.5)) > WHOLE_TOLERANCE:
            return fail_word(s, "Q number in G10 is not an integer", W_Q)
        orientation = <int>floor(value + 0.5)
    write_tool(s, index, number, offset, diameter, front, back, orientation)
    if index == s.tool_index and index != 0 and not s.random_toolchanger:
        write_tool(s, 0, number, offset, diameter, front, back, orientation)
    return refresh_tool_parameters(s)


cdef int shift_to_here(State s, Block* b, int l, const double* point, list offset) except -1:
    """L10, L11: the tool offset that gives ``point`` the named coordinates in the active system (L10) or in G59.3 (L11).

    Named and unnamed axes meet along the axes of that system, so with a rotation X changes the table's Y too.
    """
    cdef double[9] shift
    cdef double[9] place
    cdef double* fixture = &s.params[ORIGIN_FIRST + 8 * ORIGIN_STEP]
    cdef double rotation = fixture[9] if l == 11 else s.rotation, value
    cdef int k
    for k in range(9):
        shift[k] = <double>offset[k] * parameter_factor(s, k)
        place[k] = point[k] - (fixture[k] * parameter_factor(s, k) if l == 11 else s.origin[k])
    rotate(shift, -rotation)
    rotate(place, -rotation)
    for k in range(9):
        if has(b, axis_words[k]):
            value = b.value[axis_words[k]]
            shift[k] = place[k] - (value * 0.5 if k == 0 and s.diameter_mode else value) - (s.g92[k] if l == 10 else 0.0)
    rotate(shift, rotation)
    for k in range(9):
        offset[k] = shift[k] / parameter_factor(s, k)
    return 0


cdef int write_tool(State s, int index, int number, list offset, double diameter, double front, double back, int orientation) except -1:
    x, y, z, a, b, c, u, v, w = offset
    cdef int k
    s.canon.set_tool_table_entry(index, number, x, y, z, a, b, c, u, v, w, diameter, front, back, orientation)
    if number == s.current_tool and number > 0:
        for k in range(9):
            s.params[5401 + k] = offset[k]
        s.params[5410], s.params[5411], s.params[5412], s.params[5413] = diameter, front, back, orientation
    return 0


# --- Tool length

cdef int tool_length(State s, Block* b, int code) except -1:
    """G43, G43.1, G43.2, G49"""
    cdef double[9] point
    cdef double value
    cdef int k, index
    cdef bint axes = (b.words & M_AXES) != 0
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot change tool offset with cutter radius compensation on", b.g_at[8])
    to_machine(s, point)
    if code == 490:
        memset(s.tool, 0, sizeof(s.tool))
    elif code == 431:
        for k in range(9):
            if has(b, axis_words[k]):
                value = b.value[axis_words[k]]
                s.tool[k] = value * 0.5 if k == 0 and s.diameter_mode else value
    elif code == 430:
        index = s.tool_index if s.waiting & WAIT_TOOL else 0      # M6 or M61 on this line: not in the spindle's entry yet
        if has(b, W_H) and b.value[W_H] < 0.0:
            return fail_word(s, "Negative h word used", W_H)
        if has(b, W_H) and (b.value[W_H] != 0.0 or s.random_toolchanger):
            index = find_tool(s, <int>b.value[W_H], b.at[W_H])
        entry = s.canon.get_external_tool_table(index)
        for k in range(9):
            s.tool[k] = <double>entry.offset[k] * parameter_factor(s, k)
    else:
        if has(b, W_H) and axes:
            return fail_word(s, "G43.2: Can not have both H and axis words", W_H)
        if not has(b, W_H) and not axes:
            return fail(s, "G43.2: No axes specified and H word missing", b.g_at[8])
        if axes:
            for k in range(9):
                if has(b, axis_words[k]):
                    value = b.value[axis_words[k]]
                    s.tool[k] += value * 0.5 if k == 0 and s.diameter_mode else value
        else:
            entry = s.canon.get_external_tool_table(find_tool(s, <int>b.value[W_H], b.at[W_H]))
            for k in range(9):
                s.tool[k] += <double>entry.offset[k] * parameter_factor(s, k)
    s.g43_active = code != 490
    to_program(s, point)
    return send_tool_offset(s)
