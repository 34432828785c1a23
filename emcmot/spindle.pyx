"""Spindles: what was commanded becomes speed, direction, brake and orientation pins, once a period.

Nothing here starts a spindle: only SPINDLE_ON sets ``state``. Speeds are rpm unless the name ends in ``_rps``.
"""

from libc.stdio cimport snprintf

from emcmot.report cimport TEXT_SIZE, report
from emcmot.state cimport ORIENT_COMPLETE, ORIENT_FAULTED, ORIENT_IN_PROGRESS, ORIENT_NONE, Motion, Spindle

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))


cdef void stop_spindle(Spindle* s) noexcept nogil:
    s.state = 0
    s.speed = 0.0
    s.direction = 0
    s.css_factor = 0.0
    s.css_maximum = 0.0
    s.increasing = 0
    s.locked = 0
    s.orient = 0
    s.orient_state = ORIENT_NONE
    s.tap_scale = 0.0
    s.brake = 1


cdef void stop_spindles(Motion* m) noexcept nogil:
    cdef int n
    for n in range(m.num_spindles):
        stop_spindle(&m.spindle[n])


cdef void orient_spindle(Spindle* s, double angle, int mode) noexcept nogil:
    """Begin an M19: the drive turns the spindle to the angle and answers on is-oriented or orient-fault."""
    stop_spindle(s)
    s.brake = 0
    s.orient = 1
    s.orient_angle = angle
    s.orient_mode = mode
    s.orient_state = ORIENT_IN_PROGRESS


cdef void orient_cycle(Motion* m, Spindle* s, int number) noexcept nogil:
    if s.orient_fault != 0:
        s.orient = 0
        s.orient_state = ORIENT_FAULTED
        snprintf(report(m), TEXT_SIZE, b"Spindle %d: fault %d during orient", number, s.orient_fault)
    elif s.is_oriented:
        s.orient = 0
        s.locked = 1
        s.brake = 1
        s.orient_state = ORIENT_COMPLETE
