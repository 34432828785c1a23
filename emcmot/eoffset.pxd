"""External offsets: a shift of each axis by HAL, on top of whatever the planners command."""

from libc.math cimport fabs

from emcmot._messages cimport MAX_AXES, MotionState_FREE
from emcmot.state cimport Axis, Motion

cdef void follow(Motion* m, Axis* axis, int allowed) noexcept nogil
cdef void forget_eoffsets(Motion* m) noexcept nogil


cdef inline void eoffset_cycle(Motion* m) noexcept nogil:
    cdef int n
    cdef int allowed = m.enabled and m.all_homed and m.mode != MotionState_FREE and m.mode == m.mode_wanted
    cdef Axis* axis
    cdef double none = 1e-6  # lu or deg: a smaller offset
    m.eoffset_limited = 0
    m.eoffset_active = 0
    for n in range(MAX_AXES):
        axis = &m.axis[n]
        if axis.eoffset_vel_limit <= 0.0 or axis.eoffset_acc_limit <= 0.0:
            continue
        follow(m, axis, allowed)
        m.eoffset[n] = axis.eoffset.pos
        if fabs(axis.eoffset.pos) > none:
            m.eoffset_active = 1


cdef inline int eoffsets_still(Motion* m) noexcept nogil:
    cdef int n
    for n in range(MAX_AXES):
        if m.axis[n].eoffset.vel != 0.0:
            return 0
    return 1
