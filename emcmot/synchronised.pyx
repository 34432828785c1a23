"""What the planner waits for, or is led by: spindles at speed, spindle positions, and the locks of indexers."""

from emcmot.spindle cimport spindles_at_speed
from emcmot.state cimport Motion
from emcmot.tp.tp cimport tp_set_at_speed, tp_set_feed_inhibit, tp_spindle, tp_unlocked


cdef void synchronised_cycle(Motion* m) noexcept nogil:
    """Hand the planner this period's spindles and locks, and ask for the lock it wants open."""
    cdef int n
    cdef int wanted = m.tp_status.wants_unlock
    for n in range(m.num_spindles):
        tp_spindle(m.tp, n, m.spindle[n].revs, m.spindle[n].speed_in)
    tp_set_at_speed(m.tp, spindles_at_speed(m))
    tp_set_feed_inhibit(m.tp, m.feed_inhibit)
    for n in range(m.num_joints):
        if not m.joint[n].home.homing:
            m.joint[n].unlock = n == wanted
    if 0 <= wanted < m.num_joints:
        tp_unlocked(m.tp, m.joint[wanted].is_unlocked)
