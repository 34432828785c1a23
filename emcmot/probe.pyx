"""Probing moves, and the alarm of a probe that trips when nothing probes.

Runs before the planner's step, so that a contact stops the move in the period that sees it.
"""

from libc.stdio cimport snprintf

from emcmot._messages cimport MAX_AXES, MotionState_COORD
from emcmot.jog cimport stop_jogs
from emcmot.report cimport TEXT_SIZE, report
from emcmot.state cimport Motion

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))

cdef int MOTION_TYPE_PROBING = 5


cdef void end_probe(Motion* m, const char* complaint) noexcept nogil:
    """Stop the probing move; with a complaint where the program cannot go on."""
    m.probing = PROBE_OFF
    m.stopping = 1
    m.planner.abort(m.tp)
    if complaint != NULL:
        m.coord_error = 1
        snprintf(report(m), TEXT_SIZE, b"%s", complaint)


cdef void touch(Motion* m) noexcept nogil:
    """Contact: keep the position of this period."""
    cdef int n
    for n in range(MAX_AXES):
        m.probed_pos[n] = m.pos_fb[n] if m.pos_fb_ok else m.pos_cmd[n]
    m.probe_tripped = 1


cdef void look(Motion* m) noexcept nogil:
    cdef int away = m.probe_type & PROBE_AWAY
    cdef int contact = (not m.probe_input) if away else m.probe_input
    if m.probing == PROBE_QUEUED and m.tp_status.motion_type == MOTION_TYPE_PROBING:
        if contact:
            end_probe(
                m,
                b"Probe is already clear when starting G38.4 or G38.5 move" if away
                else b"Probe is already tripped when starting G38.2 or G38.3 move",
            )
            return
        m.probing = PROBE_LOOKING
    if m.probing == PROBE_LOOKING and contact:
        touch(m)
        end_probe(m, NULL)
    elif m.tp_status.done:
        for_nothing(m, away)


cdef void for_nothing(Motion* m, int away) noexcept nogil:
    """The end of the move without the event: the end point is the result."""
    touch(m)
    m.probe_tripped = 0
    if m.probe_type & PROBE_NO_ERROR:
        m.probing = PROBE_OFF
    else:
        end_probe(
            m,
            b"G38.4 move finished without breaking contact." if away
            else b"G38.2 move finished without making contact.",
        )


cdef void alarm(Motion* m) noexcept nogil:
    """The probe was touched although nobody is probing."""
    if m.mode == MotionState_COORD:
        if not m.tp_status.done and not m.stopping:
            end_probe(m, b"Probe tripped during non-probe move.")
    elif m.homing.is_active(m):
        if not m.probe_home_inhibit:
            m.homing.cancel(m)
            snprintf(report(m), TEXT_SIZE, b"Probe tripped during homing motion.")
    elif m.jog_active and not m.probe_jog_inhibit:
        stop_jogs(m)
        m.stopping = 1
        snprintf(report(m), TEXT_SIZE, b"Probe tripped during a jog.")
