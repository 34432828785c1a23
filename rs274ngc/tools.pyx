"""Tools: the T word, M6, M61, and what the interpreter knows of the tool table (which the canon keeps)."""

from libc.string cimport memcpy

from rs274ngc.block cimport *
from rs274ngc.canon import CANON_SIDE_OFF, CANON_STOPPED
from rs274ngc.path cimport machine_place, traverse
from rs274ngc.state cimport WAIT_TOOL, State, fail, fail_word, unit_factor

cdef int SIDE_OFF = CANON_SIDE_OFF, STOPPED = CANON_STOPPED


cdef int find_tool(State s, int number, int at) except -1:
    """Tool-table index of a tool number."""
    cdef int index = s.canon.get_external_tool_index(number)
    if index < 0:
        fail(s, f"Requested tool {number} not found in the tool table", at)
    return index


cdef int refresh_tool_parameters(State s) except -1:
    """#5400 to #5413 describe the tool in the spindle, in machine units."""
    cdef int k
    tool = s.canon.get_external_tool_table(0)
    s.current_tool = tool.toolno
    s.params[5400] = tool.toolno
    for k in range(9):
        s.params[5401 + k] = tool.offset[k]
    s.params[5410] = tool.diameter
    s.params[5411] = tool.frontangle
    s.params[5412] = tool.backangle
    s.params[5413] = tool.orientation
    return 0


cdef int select_tool(State s, Block* b) except -1:
    """T: prepare a tool"""
    cdef int number = <int>b.value[W_T]
    if number == 0 and not s.random_toolchanger:
        s.selected_index = 0
    else:
        s.selected_index = find_tool(s, number, b.at[W_T])
    s.selected_tool = number
    s.canon.select_tool(number)
    return 0


cdef int change_tool(State s, Block* b, int code) except -1:
    """M6: spindles stop, the quill goes up or the tool to the second reference point if the INI file says so, the tool comes"""
    cdef int spindle
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot change tools with cutter radius compensation on", b.m_at[6])
    if s.selected_index < 0 and s.random_toolchanger:
        return fail(s, "Need tool prepared -Txx- for toolchange", b.m_at[6])
    s.canon.start_change()
    if not s.change_with_spindle_on:
        for spindle in range(s.spindles):
            s.canon.stop_spindle_turning(spindle)
            s.turning[spindle] = STOPPED
    if s.change_with_quill_up:
        to_change_place(s, True)
    if s.change_at_g30:
        to_change_place(s, False)
    s.canon.change_tool()
    s.tool_index = max(s.selected_index, 0)
    s.waiting |= WAIT_TOOL
    return 0


cdef int to_change_place(State s, bint only_z) except -1:
    """Rapid to machine Z0, or to the point of G30.1; previews do not show it."""
    cdef double[9] end
    cdef double factor = s.canon.get_external_length_units() * unit_factor(s)
    cdef double height
    cdef int k
    for k in range(9):
        end[k] = s.params[5181 + k] / (factor if k < 3 or k > 5 else 1.0)
    if only_z:
        end[2] = 0.0
    machine_place(s, end)
    if only_z:
        height = end[2]
        memcpy(end, s.pos, sizeof(end))
        end[2] = height
    s.canon.comment("AXIS,hide")
    traverse(s, end)
    s.canon.comment("AXIS,show")
    return 0


cdef int declare_tool(State s, Block* b, int code) except -1:
    """M61 Q: this tool is in the spindle"""
    cdef double number = value_or(b, W_Q, -1.0)
    cdef int index
    if s.comp_side != SIDE_OFF:
        return fail(s, "Cannot change tools with cutter radius compensation on", b.m_at[6])
    if number < 0.0:
        return fail(s, "Need non-negative Q-word to specify tool number with M61", b.m_at[6])
    if number > 2.0e9:
        return fail_word(s, "Requested tool out of range with M61", W_Q)
    index = 0
    if number >= 1.0 or s.random_toolchanger:
        index = find_tool(s, <int>number, b.at[W_Q])
    s.canon.change_tool_number(index)
    s.tool_index = index
    s.waiting |= WAIT_TOOL
    return 0
