"""C face of the modal tables: see modal.pyx."""

from rs274ngc.block cimport Block, G_GROUPS, M_GROUPS, WORDS
from rs274ngc.state cimport State

ctypedef int (*Handler)(State s, Block* b, int code) except -1

ctypedef struct Code:
    Handler run             # what it does; NULL: nothing of its own
    Handler check           # what must hold on the line before anything runs; NULL: nothing
    unsigned int words      # the words that it may use, besides axes and F, S, T
    unsigned int flags
    unsigned long long step # its place in the order of execution, as a bit

cdef enum:
    # flags of a code
    NO_FLAGS = 0
    AXES_TAKEN = 1          # group 0: the axis words belong to it, not to the motion
    AXES_NEEDED = 2         # motion: must have an axis word
    NO_ROTARY = 4           # motion: must not have an A, B or C word

    # The order of execution: what comes first on a line happens first
    STEP_NONE = 0
    STEP_COMMENT = 1
    STEP_SPINDLE_MODE
    STEP_FEED_MODE
    STEP_FEED
    STEP_SPEED
    STEP_TOOL
    STEP_OUTPUTS
    STEP_CHANGE
    STEP_SPINDLE
    STEP_CONTEXT
    STEP_COOLANT
    STEP_OVERRIDES
    STEP_USER
    STEP_DWELL
    STEP_PLANE
    STEP_UNITS
    STEP_DIAMETER
    STEP_COMPENSATION
    STEP_TOOL_LENGTH
    STEP_ORIGIN
    STEP_CONTROL
    STEP_DISTANCE
    STEP_IJK_DISTANCE
    STEP_RETRACT
    STEP_SETTING
    STEP_G92
    STEP_MOTION
    STEP_STOP
    STEPS

    # Modal groups of the M codes
    M_OUTPUTS = 5
    M_CHANGE = 6
    M_SPINDLE = 7
    M_COOLANT = 8
    M_OVERRIDES = 9
    M_USER = 10
    M_STOP = 4
    M_CONTEXT = 3

    G_MOTION = 1
    LIMIT = 1000

cdef int[LIMIT] g_group             # modal group of a G code times 10; -1: no such code
cdef int[200] m_group
cdef unsigned long long[G_GROUPS] g_steps       # a group's bit in Block.steps
cdef unsigned long long[M_GROUPS] m_steps
cdef int[WORDS] word_step           # F, S, T: their step; others 0; -1: not a word
cdef Code[LIMIT] g_code
cdef Code[200] m_code
cdef int[STEPS] step_g              # the modal group that a step executes, -1: none
cdef int[STEPS] step_m
