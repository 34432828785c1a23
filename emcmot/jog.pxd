"""Jogs of joints (free mode) and axes (teleop mode), by command and by wheel."""

from emcmot.state cimport Axis, Joint, Motion

cdef enum JogKind:
    JOG_CONTINUOUS = 0
    JOG_INCREMENT = 1
    JOG_ABSOLUTE = 2

cdef int jog_joint(Motion* m, int number, int kind, double vel, double offset) noexcept nogil   # 0, or -1 and a report
cdef int jog_axis(Motion* m, int number, int kind, double vel, double offset) noexcept nogil
cdef void stop_jogs(Motion* m) noexcept nogil
cdef void stop_joint_jog(Joint* joint) noexcept nogil
cdef void stop_axis_jog(Axis* axis) noexcept nogil
cdef void jog_cycle(Motion* m) noexcept nogil
cdef void end_jogs(Motion* m) noexcept nogil
