"""What the commands do that are no moves and no parameters; the table is in ``commands.pyx``."""

from emcmot._messages cimport EMCMOT_COMMAND
from emcmot.state cimport Motion

ctypedef int (*Handler)(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil

cdef int nothing(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int abort(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int enable(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int disable(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int free_mode(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int teleop_mode(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int coord_mode(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int pause(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int resume(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int step(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int reverse(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int forward(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int feed_scale(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int rapid_scale(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int spindle_scale(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int enable_override(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int override_limits(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int jog(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int jog_abort(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int teleop_vector(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int home(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int unhome(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int activate_joint(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int deactivate_joint(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int enable_amplifier(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int disable_amplifier(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int set_num_joints(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int set_num_spindles(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int set_motor_offset(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int set_joint_comp(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int set_probe_err_inhibit(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int spindle_on(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int spindle_off(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int spindle_increase(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int spindle_decrease(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int spindle_brake_engage(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int spindle_brake_release(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
cdef int spindle_orient(Motion* m, const EMCMOT_COMMAND* c) noexcept nogil
