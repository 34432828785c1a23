"""What the planner waits for, or is led by: spindles at speed and their positions, index pulses, locks of indexers."""

from emcmot.spindle cimport spindles_at_speed
from emcmot.state cimport Motion


cdef inline void watch_index(Motion* m) noexcept nogil:
    """Where the planner wants an index pulse, arm the encoder's index-enable, which resets itself at the pulse."""
    cdef int wanted = m.tp_status.wants_index
    if wanted >= m.num_spindles:
        wanted = -1
    if m.index_spindle >= 0 and wanted != m.index_spindle:
        m.spindle[m.index_spindle].index_enable = 0
        m.index_spindle = -1
    elif m.index_spindle >= 0 and not m.spindle[wanted].index_enable:
        m.planner.index_seen(m.tp)
        m.index_spindle = -1
    elif wanted >= 0:
        m.spindle[wanted].index_enable = 1
        m.index_spindle = wanted


cdef inline void turn_back(Motion* m) noexcept nogil:
    """Turn the spindle of a tap backwards while the tap is on its way out."""
    cdef int n
    for n in range(m.num_spindles):
        m.spindle[n].tap_scale = -m.tp_status.retract_scale if n == m.tp_status.wants_reverse else 0.0


cdef inline void synchronised_cycle(Motion* m) noexcept nogil:
    """Hand the planner this period's spindles and locks, and do what it asks of them."""
    cdef int n
    cdef int wanted = m.tp_status.wants_unlock
    for n in range(m.num_spindles):
        m.planner.spindle(m.tp, n, m.spindle[n].revs, m.spindle[n].speed_in)
    watch_index(m)
    turn_back(m)
    m.planner.set_at_speed(m.tp, spindles_at_speed(m))
    # joints that another geometry has moved away from their pose catch up before the next move begins
    m.planner.set_feed_inhibit(m.tp, m.feed_inhibit or (m.chasing and m.tp_status.current_vel == 0.0))
    for n in range(m.num_joints):
        if not m.joint[n].home.homing:
            m.joint[n].unlock = n == wanted
    if 0 <= wanted < m.num_joints:
        m.planner.unlocked(m.tp, m.joint[wanted].is_unlocked)
