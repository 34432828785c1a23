"""C face of the tools: see tools.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int find_tool(State s, int number, int at) except -1
cdef int refresh_tool_parameters(State s) except -1
cdef int select_tool(State s, Block* b) except -1
cdef int change_tool(State s, Block* b, int code) except -1
cdef int declare_tool(State s, Block* b, int code) except -1
