"""Enabling, disabling, and the changes between free, teleop and coordinated mode.

Commands only say what is wanted; ``set_mode`` carries it out at the first period in which the machine stands still.
So no change of mode ever makes a joint's command jump or break its limits: what moves is first brought to rest by
whoever moves it.
"""

from libc.math cimport fabs, isfinite
from libc.stdio cimport snprintf

from emcmot._messages cimport MAX_AXES, MotionState_COORD, MotionState_FREE, MotionState_TELEOP
from emcmot.eoffset cimport eoffsets_still, forget_eoffsets
from emcmot.free_planner cimport free_planner_rest_at
from emcmot.jog cimport stop_jogs
from emcmot.joint cimport limit_own_moves, set_joint_position
from emcmot.kins.kinematics cimport Kinematics, select_way
from emcmot.probe cimport PROBE_OFF
from emcmot.report cimport TEXT_SIZE, report
from emcmot.spindle cimport stop_spindles
from emcmot.state cimport Axis, Joint, Motion
from emcmot.tp.tp cimport TP_OK
from emcmot.world cimport align_joints, limit_axis_moves, refresh_planner_limits, update_world_feedback, world_from_joints

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))
same_size(__name__, "Kinematics", sizeof(Kinematics))


cdef void stop_all(Motion* m) noexcept nogil:
    """ABORT: whatever moves comes to rest under its limits, whatever waits is dropped."""
    m.homing.cancel(m)
    stop_jogs(m)
    if not m.tp_status.done or m.tp_status.depth > 0:
        m.planner.abort(m.tp)
    else:
        m.planner.resume(m.tp)
    m.probing = PROBE_OFF
    m.pending_io_set = 0
    m.pending_io.dout_mask = 0
    m.pending_io.aout_mask = 0
    m.paused = 0
    m.command_reverse = 0
    m.stepping = 0
    m.wait_spindles = 0
    m.stopping = 1


cdef void switch_off(Motion* m) noexcept nogil:
    cdef int n
    m.enabled = 0
    m.tracking = 0
    for n in range(m.num_joints):
        m.joint[n].amp_enable = 0
    stop_all(m)
    stop_spindles(m)


cdef void switch_on(Motion* m) noexcept nogil:
    """Take the joints where they are and enable their drives."""
    cdef int n
    cdef Joint* joint
    for n in range(m.num_joints):
        joint = &m.joint[n]
        if joint.active and not isfinite(joint.pos_fb):
            m.enable_wanted = 0
            snprintf(
                report(m, n), TEXT_SIZE, b"Can't enable motion: the position feedback of joint %d is not a number", n
            )
            return
    for n in range(m.num_joints):
        joint = &m.joint[n]
        if joint.active:
            set_joint_position(joint, joint.pos_fb)
        limit_own_moves(joint, 1.0)
        joint.amp_enable = joint.active
        joint.error = 0
        joint.jog_vel = 0.0
    m.enabled = 1
    m.tracking = 0
    m.coord_error = 0
    forget_eoffsets(m)
    world_from_joints(m)


cdef void enter_free(Motion* m) noexcept nogil:
    cdef int n
    cdef Joint* joint
    for n in range(m.num_joints):
        joint = &m.joint[n]
        free_planner_rest_at(&joint.free, joint.pos_cmd)
        limit_own_moves(joint, 1.0)
        joint.jog_vel = 0.0
    end_teleop(m)
    m.chasing = 0
    m.mode = MotionState_FREE


cdef void end_teleop(Motion* m) noexcept nogil:
    cdef int n
    for n in range(MAX_AXES):
        m.axis[n].teleop.enabled = 0


cdef void enter_teleop(Motion* m) noexcept nogil:
    cdef int n
    cdef Axis* axis
    for n in range(MAX_AXES):
        axis = &m.axis[n]
        free_planner_rest_at(&axis.teleop, m.pos_cmd[n] - m.eoffset[n])
        limit_axis_moves(axis, 1.0)
        axis.pos_cmd = axis.teleop.pos
        axis.jog_vel = 0.0
    m.mode = MotionState_TELEOP


cdef void enter_coord(Motion* m) noexcept nogil:
    """The planner begins where the machine is; it may need a period more to be done with what it had."""
    cdef double pos[MAX_AXES]
    cdef int n
    for n in range(MAX_AXES):
        pos[n] = m.pos_cmd[n] - m.eoffset[n]
    if m.planner.set_pos(m.tp, pos) == TP_OK:
        end_teleop(m)
        m.mode = MotionState_COORD
        m.coord_error = 0


cdef void change_mode(Motion* m) noexcept nogil:
    """At rest: let another planner make the commands."""
    if not eoffsets_still(m):
        return
    if m.mode_wanted == MotionState_FREE:
        enter_free(m)
        return
    if m.mode == MotionState_FREE:
        if world_from_joints(m) != 0:
            m.mode_wanted = MotionState_FREE
            snprintf(report(m), TEXT_SIZE, b"The position of the tool is not known: home the machine first")
            return
        if align_joints(m) != 0:
            return
    if m.mode_wanted == MotionState_TELEOP:
        enter_teleop(m)
    else:
        enter_coord(m)


cdef void fall_to_free(Motion* m) noexcept nogil:
    """The Cartesian command cannot be followed: each joint comes to rest by itself from the speed it has."""
    cdef int n
    cdef Joint* joint
    for n in range(m.num_joints):
        joint = &m.joint[n]
        free_planner_rest_at(&joint.free, joint.pos_cmd)
        limit_own_moves(joint, 1.0)
        joint.free.vel = joint.vel_cmd
        if joint.free.jerk_limit > 0.0:  # an S-curve goes on from the end of the period, not from its mean
            joint.free.acc = joint.acc_cmd
            joint.free.vel += 0.5 * joint.acc_cmd * m.dt
        joint.free.active = 1
    m.chasing = 0
    m.mode = MotionState_FREE
    m.mode_wanted = MotionState_FREE
    stop_all(m)
    m.coord_error = 1
    snprintf(report(m), TEXT_SIZE, b"The commanded position can't be reached by the joints: motion stopped")


cdef void switch_kinematics(Motion* m) noexcept nogil:
    """At the end of a period at rest: compute with the kinematics that motion.switchkins-type asks for.

    The joints stand where they are; the pose is another one from now on.
    """
    cdef int way = <int>m.switchkins_type if fabs(m.switchkins_type) < 100.0 else -1
    if way == m.kins.way or not resting(m):
        return
    if select_way(m.kins, way) != 0:
        if m.refused_way != way:
            snprintf(report(m), TEXT_SIZE, b"motion.switchkins-type: this kinematics has no type %d", way)
        m.refused_way = way
        return
    m.refused_way = 0
    refresh_planner_limits(m)
    update_world_feedback(m)
    if world_from_joints(m) != 0:
        m.mode_wanted = MotionState_FREE
    elif m.mode == MotionState_TELEOP:
        enter_teleop(m)
    elif m.mode == MotionState_COORD:
        enter_coord(m)
