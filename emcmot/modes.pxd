"""Enabling, disabling, and the changes between free, teleop and coordinated mode."""

from libc.math cimport fabs

from emcmot._messages cimport MAX_AXES, MotionState_COORD, MotionState_FREE, MotionState_TELEOP
from emcmot.eoffset cimport eoffsets_still
from emcmot.homing cimport SEQUENCE_IDLE
from emcmot.probe cimport PROBE_OFF
from emcmot.state cimport Motion

cdef void switch_off(Motion* m) noexcept nogil
cdef void switch_on(Motion* m) noexcept nogil
cdef void enter_free(Motion* m) noexcept nogil
cdef void change_mode(Motion* m) noexcept nogil
cdef void stop_all(Motion* m) noexcept nogil
cdef void fall_to_free(Motion* m) noexcept nogil
cdef void switch_kinematics(Motion* m) noexcept nogil


cdef inline int joints_have_followed(Motion* m) noexcept nogil:
    """Whether all joints are where the Cartesian command is, and slow enough to stand in the next period."""
    cdef int n
    if m.chasing:
        return 0
    if not m.kins.linear:
        for n in range(m.kins.joints):
            if fabs(m.joint[n].vel_cmd) > m.joint[n].acc_limit * m.dt:
                return 0
    return 1


cdef inline int resting(Motion* m) noexcept nogil:
    """Whether nothing moves or is about to."""
    cdef int n
    if m.mode == MotionState_COORD:
        return m.tp_status.done and m.probing == PROBE_OFF and joints_have_followed(m)
    if m.mode == MotionState_TELEOP:
        for n in range(MAX_AXES):
            if m.axis[n].teleop.active:
                return 0
        return joints_have_followed(m)
    if m.tracking:
        return 1
    for n in range(m.num_joints):
        if m.joint[n].free.active or m.joint[n].home.homing:
            return 0
    return m.home_step == SEQUENCE_IDLE


cdef inline void set_mode(Motion* m) noexcept nogil:
    """Carry out what ENABLE, DISABLE, FREE, TELEOP, COORD and faults asked for, as far as the motion allows."""
    cdef int rest
    if m.enabled and not m.enable_wanted:
        switch_off(m)
    rest = resting(m)
    if m.enable_wanted and not m.enabled and rest and eoffsets_still(m):
        if m.mode != MotionState_FREE:
            enter_free(m)
        switch_on(m)
    if not m.enabled and rest and eoffsets_still(m):
        if m.mode != MotionState_FREE:
            enter_free(m)
        m.tracking = 1
    elif m.enabled and rest and m.mode != m.mode_wanted:
        change_mode(m)
