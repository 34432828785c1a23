"""One servo period of motion: inputs, supervision, modes, planners, joints, outputs, in this order.

The command handler has run just before (``commands.run``). Pins are already copied into the state, and are copied
out of it afterwards by motmod or by the stepped simulator.
"""

from libc.math cimport fabs, isfinite, sqrt
from libc.stdio cimport snprintf

from emcmot._messages cimport (
    Enables_AF,
    Enables_FH,
    Enables_FS,
    MAX_AIO,
    MAX_AXES,
    MAX_DIO,
    MotionState_COORD,
    MotionState_FREE,
    MotionState_TELEOP,
)
from emcmot.eoffset cimport eoffset_cycle
from emcmot.free_planner cimport free_planner_step
from emcmot.jog cimport end_jogs, jog_cycle
from emcmot.joint cimport command_joint, read_joints, write_joints
from emcmot.modes cimport fall_to_free, resting, set_mode, stop_all, switch_kinematics
from emcmot.probe cimport probe_cycle
from emcmot.report cimport TEXT_SIZE, report
from emcmot.spindle cimport spindle_cycle
from emcmot.state cimport LINES, Axis, Joint, Motion
from emcmot.synchronised cimport synchronised_cycle
from emcmot.tp.tp cimport TP_OK, TpIo
from emcmot.world cimport CHASE_LOST, command_world, update_world_feedback, world_from_joints

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))

cdef double* MM_OF_UNITS = [1.0, 25.4, 1.0, 10.0]   # machine units (not used), inch, mm, cm

cdef int TYPE_TRAVERSE = 1
cdef int TYPE_FEED = 2
cdef int TYPE_ARC = 3

cdef int FEEDBACK_PERIODS = 1   # from a command to the read-back of the motor that has followed it
cdef double STILL = 1e-9        # lu or deg: a joint that moves less in a period stands (iterative kinematics)


cdef void watch_task(Motion* m) noexcept nogil:
    """Without a command or heartbeat for too long nobody is in charge: stop, and switch off at rest."""
    if m.heartbeat_timeout <= 0.0 or not m.enabled:
        return
    if not m.task_lost and m.host_now - m.last_command > m.heartbeat_timeout:
        m.task_lost = 1
        stop_all(m)
        snprintf(report(m), TEXT_SIZE, b"Task has not answered for %.3f s: motion stopped", m.heartbeat_timeout)
    if m.task_lost and resting(m):
        m.enable_wanted = 0


cdef void fault(Motion* m, int number, const char* what) noexcept nogil:
    m.enable_wanted = 0
    m.joint[number].error = 1
    snprintf(report(m, number), TEXT_SIZE, b"joint %d %s", number, what)


cdef void watch_joint(Motion* m, int n) noexcept nogil:
    cdef Joint* joint = &m.joint[n]
    if joint.on_pos_limit and not m.override_limits & 2 << 2 * n:
        fault(m, n, b"on limit switch error")
    elif joint.on_neg_limit and not m.override_limits & 1 << 2 * n:
        fault(m, n, b"on limit switch error")
    if joint.faulted:
        fault(m, n, b"amplifier fault")
    if joint.ferrored:
        m.enable_wanted = 0
        joint.error = 1
        snprintf(
            report(m, n), TEXT_SIZE, b"joint %d following error: %.4f, limit %.4f", n, joint.ferror, joint.ferror_limit
        )


cdef void watch_faults(Motion* m) noexcept nogil:
    """What switches the machine off, each with its message."""
    cdef int n
    if not m.enabled or not m.enable_wanted:
        return
    if not m.enable_in:
        m.enable_wanted = 0
        snprintf(report(m), TEXT_SIZE, b"motion stopped by enable input")
    for n in range(m.num_misc_error):
        if m.misc_error[n]:
            m.enable_wanted = 0
            snprintf(report(m), TEXT_SIZE, b"Motion Stopped by misc error %d", n)
    for n in range(m.num_spindles):
        if m.spindle[n].amp_fault_in:
            m.enable_wanted = 0
            snprintf(report(m), TEXT_SIZE, b"spindle %d amplifier fault", n)
    for n in range(m.num_joints):
        watch_joint(m, n)


cdef void watch_soft_limits(Motion* m) noexcept nogil:
    """A joint that leaves its limits in a Cartesian mode stops the machine; outside already, it may come back."""
    cdef int n
    cdef Joint* joint
    m.on_soft_limit = 0
    for n in range(m.num_joints):
        joint = &m.joint[n]
        if not joint.active or not (joint.on_soft_pos or joint.on_soft_neg):
            joint.soft_limit_reported = 0
            continue
        m.on_soft_limit = 1
        if m.enabled and m.mode != MotionState_FREE and not joint.soft_limit_reported and not m.stopping:
            stop_all(m)
            m.coord_error = 1
            snprintf(
                report(m, n), TEXT_SIZE,
                b"Exceeded %s soft limit (%.5f) on joint %d: it is at %.5f. Jog it back in joint mode.",
                b"POSITIVE" if joint.on_soft_pos else b"NEGATIVE",
                joint.max_limit if joint.on_soft_pos else joint.min_limit, n, joint.pos_cmd,
            )
        joint.soft_limit_reported = 1


cdef double adaptive_scale(Motion* m, int enables) noexcept nogil:
    """motion.adaptive-feed without its sign, which is the direction on the path; 0 until the planner has turned."""
    cdef int wanted
    if not isfinite(m.adaptive_feed):
        return 0.0
    if m.tp_status.done or not enables & Enables_AF:
        m.adaptive_reverse = 0
    else:
        m.adaptive_reverse = m.adaptive_feed < 0.0
    wanted = m.command_reverse != m.adaptive_reverse
    if wanted != m.tp_status.reversing and not m.tp_status.done:
        if m.planner.set_reverse(m.tp, wanted) != TP_OK:
            return 0.0
        m.planner.get_status(m.tp, &m.tp_status)
    return min(fabs(m.adaptive_feed), 1.0)


cdef void set_overrides(Motion* m) noexcept nogil:
    """Hand the planner this period's overrides, and work out the product that acts on the running move."""
    cdef int enables = m.tp_status.enables if m.tp_status.motion_type else m.enables
    m.adaptive_scale = adaptive_scale(m, enables)
    cdef double feed_scale = min(m.feed_scale, m.max_feed_scale)
    m.planner.set_feed_scale(m.tp, feed_scale)
    m.planner.set_rapid_scale(m.tp, m.rapid_scale)
    m.planner.set_adaptive_scale(m.tp, m.adaptive_scale)
    m.planner.set_feed_hold(m.tp, m.feed_hold)
    m.net_feed_scale = 1.0
    if enables & Enables_FS:
        m.net_feed_scale *= m.rapid_scale if m.tp_status.motion_type == TYPE_TRAVERSE else feed_scale
    if enables & Enables_AF:
        m.net_feed_scale *= m.adaptive_scale
    if (enables & Enables_FH and m.feed_hold) or m.feed_inhibit:
        m.net_feed_scale = 0.0


cdef void move_free(Motion* m) noexcept nogil:
    cdef int n
    cdef double speed2 = 0.0
    cdef Joint* joint
    for n in range(m.num_joints):
        joint = &m.joint[n]
        if m.tracking and joint.active:
            joint.free.target = joint.pos_fb
            joint.free.vel_limit = joint.vel_limit
            joint.free.acc_limit = joint.acc_limit
            joint.free.jerk_limit = 0.0
            joint.free.enabled = 1
        free_planner_step(&joint.free, m.dt)
        joint.coarse_pos = joint.free.pos
        command_joint(joint, joint.free.pos, m.dt)
        speed2 += joint.vel_cmd * joint.vel_cmd
    m.current_vel = sqrt(speed2)
    m.requested_vel = 0.0
    m.distance_to_go = 0.0
    if world_from_joints(m) == 0:
        for n in range(MAX_AXES):
            m.axis[n].pos_cmd = m.pos_cmd[n] - m.eoffset[n]
    if m.tracking:
        for n in range(m.num_joints):
            m.joint[n].free.enabled = 0


cdef void move_teleop(Motion* m) noexcept nogil:
    cdef double pose[MAX_AXES]
    cdef double speed2 = 0.0
    cdef int n
    cdef Axis* axis
    for n in range(MAX_AXES):
        axis = &m.axis[n]
        if axis.teleop.active:
            free_planner_step(&axis.teleop, m.dt)
        axis.pos_cmd = axis.teleop.pos
        pose[n] = axis.teleop.pos + m.eoffset[n]
        speed2 += axis.teleop.vel * axis.teleop.vel
    m.current_vel = sqrt(speed2)
    m.requested_vel = 0.0
    m.distance_to_go = 0.0
    if command_world(m, pose) != 0:
        fall_to_free(m)
        move_free(m)


cdef void move_coord(Motion* m) noexcept nogil:
    cdef double pose[MAX_AXES]
    cdef int n
    m.planner.run_cycle(m.tp)
    m.planner.get_status(m.tp, &m.tp_status)
    for n in range(MAX_AXES):
        m.axis[n].pos_cmd = m.tp_status.pos[n]
        pose[n] = m.tp_status.pos[n] + m.eoffset[n]
    m.current_vel = m.tp_status.current_vel
    m.requested_vel = m.tp_status.requested_vel
    m.distance_to_go = m.tp_status.distance_to_go
    if command_world(m, pose) != 0:
        fall_to_free(m)
        move_free(m)
    elif m.chasing == CHASE_LOST and not m.stopping and m.current_vel > 0.0:
        stop_all(m)
        m.coord_error = 1
        snprintf(
            report(m), TEXT_SIZE,
            b"A joint can't follow the path within its velocity and acceleration limits: motion stopped",
        )


cdef void move(Motion* m) noexcept nogil:
    """Let the planner in charge make the commands of this period."""
    if m.mode == MotionState_COORD:
        move_coord(m)
        return
    if not m.tp_status.done:  # what fall_to_free left to the planner ends out of sight
        m.planner.run_cycle(m.tp)
        m.planner.get_status(m.tp, &m.tp_status)
    if m.mode == MotionState_TELEOP:
        move_teleop(m)
    else:
        move_free(m)


cdef void write_queued_outputs(Motion* m) noexcept nogil:
    """Digital and analog outputs that belong to a move that starts now."""
    cdef TpIo io
    cdef int n
    while m.planner.take_io(m.tp, &io):
        for n in range(MAX_DIO):
            if io.dout_mask >> n & 1:
                m.digital_out[n] = io.dout_value >> n & 1
        for n in range(MAX_AIO):
            if io.aout_mask >> n & 1:
                m.analog_out[n] = io.aout_value[n]


cdef double mm_per_program_unit(Motion* m) noexcept nogil:
    """Of the running move: F words of its program are these units a minute."""
    cdef int units = m.units_of_id[m.tp_status.id & (LINES - 1)]
    return m.mm_per_unit if units == 0 else MM_OF_UNITS[units]


cdef void write_pins(Motion* m) noexcept nogil:
    """The machine's output pins that are not written where they are worked out."""
    m.motion_enabled_out = m.enabled
    m.coord_mode_out = m.enabled and m.mode == MotionState_COORD
    m.teleop_mode_out = (m.mode if m.enabled else m.mode_wanted) == MotionState_TELEOP
    m.in_position = m.at_rest
    m.coord_error_out = m.coord_error
    m.motion_type_out = m.tp_status.motion_type if m.mode == MotionState_COORD else 0
    m.program_line = m.line_of_id[m.tp_status.id & (LINES - 1)] if m.tp_status.id else 0
    m.tp_reverse_out = m.tp_status.reversing
    m.paused = m.tp_status.paused
    m.feed_mmpm = 0.0
    if m.motion_type_out == TYPE_FEED or m.motion_type_out == TYPE_ARC:
        m.feed_mmpm = m.requested_vel * m.net_feed_scale * 60.0 * m.mm_per_unit
    m.feed_upm = m.feed_mmpm / mm_per_program_unit(m)
    m.feed_mmps = m.feed_mmpm / 60.0
    m.feed_ipm = m.feed_mmpm / 25.4
    m.feed_ips = m.feed_ipm / 60.0


cdef int has_moved(const Motion* m) noexcept nogil:
    """Whether a motor that is on got another command than in the period before."""
    cdef int n
    for n in range(m.num_joints):
        if fabs(m.joint[n].vel_cmd) * m.dt > STILL or m.joint[n].correction.active:
            return 1
    return 0


cdef void judge_rest(Motion* m) noexcept nogil:
    """In position is who stands, and has stood for so long that the feedback of this period is that of the end."""
    cdef int rest = resting(m)
    if rest:
        m.stopping = 0
    if not rest or (has_moved(m) and not m.tracking):
        m.settling = max(m.settling, FEEDBACK_PERIODS)
        m.at_rest = 0
        return
    m.at_rest = m.settling == 0
    m.settling -= m.settling > 0


cdef void controller(Motion* m) noexcept nogil:
    m.heartbeat += 1
    m.planner.get_status(m.tp, &m.tp_status)
    read_joints(m)
    update_world_feedback(m)
    watch_task(m)
    watch_faults(m)
    watch_soft_limits(m)
    set_mode(m)
    set_overrides(m)
    synchronised_cycle(m)
    probe_cycle(m)
    m.homing.cycle(m)
    jog_cycle(m)
    eoffset_cycle(m)
    spindle_cycle(m)
    move(m)
    write_queued_outputs(m)
    if m.kins.ways > 1:
        switch_kinematics(m)
    judge_rest(m)
    end_jogs(m)
    write_joints(m)
    write_pins(m)
