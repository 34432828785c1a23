"""Probing moves, and the alarm of a probe that trips when nothing probes."""

from emcmot.state cimport Motion

cdef enum ProbePhase:
    PROBE_OFF = 0
    PROBE_QUEUED = 1     # the move waits in the planner
    PROBE_LOOKING = 2    # it is being made

cdef enum ProbeType:     # bits of EMCMOT_COMMAND.probe_type
    PROBE_NO_ERROR = 1   # G38.3, G38.5: finding nothing is no error
    PROBE_AWAY = 2       # G38.4, G38.5: contact is to be lost


cdef void look(Motion* m) noexcept nogil
cdef void alarm(Motion* m) noexcept nogil


cdef inline void probe_cycle(Motion* m) noexcept nogil:
    cdef int rising = m.probe_input and not m.probe_last
    m.probe_last = m.probe_input
    if m.probing != PROBE_OFF:
        look(m)
    elif rising:
        alarm(m)
