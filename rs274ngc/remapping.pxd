"""C face of the remapped codes: see remapping.pyx."""

from rs274ngc.block cimport Block
from rs274ngc.state cimport Frame, State


cdef class Pending:
    """A line that waits while its remapped code is done."""

    cdef Block block
    cdef bytes raw
    cdef int line
    cdef readonly object remap              # None: a Python O-word subroutine
    cdef readonly dict words
    cdef public object steps                # generator: FINISH to let the machine come to rest, BODY to run the procedure
    cdef public bint builtin_used
    cdef readonly str sub                   # name of a Python O-word subroutine, empty for a remapped code
    cdef readonly list arguments            # what it was called with
    cdef Frame scope                        # the level that its code runs on

cdef int take_over(State s, Block* b, int step) except -1
cdef object open_pending(State s, Block* b, remap, dict words)
cdef object block_view(State s, Pending pending)
