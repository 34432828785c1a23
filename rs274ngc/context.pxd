from rs274ngc.block cimport Block
from rs274ngc.state cimport State

cdef int context(State s, Block* b, int code) except -1
cdef int restore(State s, saved) except -1
cdef tuple active_g_codes(State s)
cdef tuple active_m_codes(State s)
cdef tuple active_settings(State s)
