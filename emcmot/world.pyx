"""Between axes and joints: kinematics, soft limits in Cartesian space, and the planner's axis limits."""

from libc.math cimport fabs, fmin, sqrt
from libc.stdio cimport snprintf

from emcmot._messages cimport MAX_AXES, MAX_JOINTS
from emcmot.free_planner cimport fastest_stoppable
from emcmot.joint cimport command_joint, limit_own_moves
from emcmot.kins.kinematics cimport KINS_JOINTS, Kinematics
from emcmot.report cimport TEXT_SIZE, report
from emcmot.state cimport Axis, Joint, Motion
from emcmot.tp.tp cimport TpInverse

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))
same_size(__name__, "Kinematics", sizeof(Kinematics))

cdef const char* AXIS_NAMES = b"XYZABCUVW"
cdef double LIMIT_TOLERANCE = 1e-9   # lu or deg, relative to 1 + |limit|: rounding of unit conversions
cdef double ALIGN_SHARE = 0.1        # share of a joint's velocity for closing a gap between joints and kinematics
cdef double ROUNDING = 1.0 + 1e-9    # a joint may be this much over a limit that its command meets exactly
cdef double ALIGNED = 1e-8           # lu or deg: a smaller gap is none


cdef int inverse(Motion* m, double* joints, double* pose) noexcept nogil:
    """0 and the joints of this pose, or -1."""
    if m.kins.inverse(m.kins, joints, pose) != 0 or not all_finite(joints, m.kins.joints):
        return -1
    return 0


cdef int world_home_reached(Motion* m) noexcept nogil:
    """Without forward kinematics a pose is known in one place only: all joints at HOME is the world's home."""
    cdef int n
    for n in range(m.num_joints):
        if m.joint[n].pos_cmd != m.joint[n].home.home:
            return 0
    for n in range(MAX_AXES):
        m.pos_cmd[n] = m.world_home[n]
    return 1


cdef int align_joints(Motion* m) noexcept nogil:
    """Before a Cartesian mode begins, in free mode at rest: 0 where the joints stand as the kinematics have it.

    Where they do not (the two sides of a gantry stand a little apart when it is switched on), they go there slowly.
    """
    cdef double joints[MAX_JOINTS]
    cdef Joint* joint
    cdef int n
    cdef int moving = 0
    for n in range(m.num_joints):
        joints[n] = m.joint[n].pos_cmd
    if inverse(m, joints, m.pos_cmd) != 0:
        return -1
    for n in range(m.kins.joints):
        joint = &m.joint[n]
        if fabs(joint.pos_cmd - joints[n]) > ALIGNED:
            limit_own_moves(joint, 1.0)
            joint.free.target = joints[n]
            joint.free.enabled = 1
            joint.free.active = 1
            joint.jog_vel = ALIGN_SHARE * joint.vel_limit
            moving = 1
    return -1 if moving else 0


cdef double follow_limited(Joint* joint, double wanted, double dt) noexcept nogil:
    """Go to ``wanted`` in this period, or as near as the joint's limits allow; how far it stays behind.

    A joint that is behind keeps the command's velocity and closes the gap with half of its acceleration.
    """
    cdef double wanted_vel = (wanted - joint.coarse_pos) / dt
    cdef double gap = joint.coarse_pos - joint.pos_cmd
    cdef double step = joint.acc_limit * dt * ROUNDING
    cdef double limit = joint.vel_limit * ROUNDING
    cdef double vel = fastest_stoppable(fabs(gap), 0.5 * joint.acc_limit, dt)
    vel = wanted_vel + (vel if gap > 0.0 else -vel)
    vel = min(max(vel, joint.vel_cmd - step), joint.vel_cmd + step)
    vel = min(max(vel, -limit), limit)
    if fabs(joint.pos_cmd + vel * dt - wanted) <= LIMIT_TOLERANCE:
        command_joint(joint, wanted, dt)
        return 0.0
    command_joint(joint, joint.pos_cmd + vel * dt, dt)
    return fabs(wanted - joint.pos_cmd)


cdef int command_world(Motion* m, double* pose) noexcept nogil:
    """Make ``pose`` the command of this period, for all joints; -1, and nothing done, where it cannot be reached."""
    cdef double joints[MAX_JOINTS]
    cdef double way = 0.0
    cdef Joint* joint
    cdef int n
    cdef double lag
    cdef int chasing = 0
    for n in range(m.num_joints):
        joints[n] = m.joint[n].pos_cmd
    if not all_finite(pose, MAX_AXES) or inverse(m, joints, pose) != 0:
        return -1
    for n in range(3):
        way += (pose[n] - m.pos_cmd[n]) * (pose[n] - m.pos_cmd[n])
    m.distance_travelled += sqrt(way)
    for n in range(MAX_AXES):
        m.pos_cmd[n] = pose[n]
    for n in range(m.kins.joints):
        joint = &m.joint[n]
        if m.kins.linear:
            command_joint(joint, joints[n], m.dt)
        else:
            lag = follow_limited(joint, joints[n], m.dt)
            if lag > joint.min_ferror:
                chasing = CHASE_LOST
            elif lag > 0.0 and not chasing:
                chasing = CHASE_BEHIND
        joint.coarse_pos = joints[n]
    m.chasing = chasing
    m.pos_cmd_ok = 1
    return 0


cdef double slack(double limit) noexcept nogil:
    return LIMIT_TOLERANCE * (1.0 + fabs(limit))


cdef int refuse(
    Motion* m, const char* what, long move_id, const char* place, const char* side, double value, double limit
) noexcept nogil:
    snprintf(
        report(m, -1, move_id), TEXT_SIZE, b"%s move on line %ld would exceed %s's %s limit: %.4f, limit %.4f",
        what, move_id, place, side, value, limit,
    )
    return -1


cdef int check_end_point(Motion* m, const char* what, long move_id, double* pose) noexcept nogil:
    """0 where the machine may stand at ``pose``; else -1, with a report that says why not."""
    cdef double joints[MAX_JOINTS]
    cdef char place[16]
    cdef Axis* axis
    cdef Joint* joint
    cdef double value
    cdef int n
    for n in range(MAX_AXES):
        axis = &m.axis[n]
        value = pose[n] + m.eoffset[n]
        snprintf(place, sizeof(place), b"%c", AXIS_NAMES[n])
        if value > axis.max_limit + slack(axis.max_limit):
            return refuse(m, what, move_id, place, b"positive", value, axis.max_limit)
        if value < axis.min_limit - slack(axis.min_limit):
            return refuse(m, what, move_id, place, b"negative", value, axis.min_limit)
    for n in range(m.num_joints):
        joints[n] = m.joint[n].pos_cmd
    if inverse(m, joints, pose) != 0:
        snprintf(
            report(m, -1, move_id), TEXT_SIZE, b"%s move on line %ld ends where the machine cannot reach", what, move_id
        )
        return -1
    for n in range(m.kins.joints):
        joint = &m.joint[n]
        snprintf(place, sizeof(place), b"joint %d", n)
        if not joint.active:
            continue
        if joints[n] > joint.max_limit + slack(joint.max_limit):
            return refuse(m, what, move_id, place, b"positive", joints[n], joint.max_limit)
        if joints[n] < joint.min_limit - slack(joint.min_limit):
            return refuse(m, what, move_id, place, b"negative", joints[n], joint.min_limit)
    return 0


cdef int check_box(Motion* m, const char* what, long move_id, const double* low, const double* high) noexcept nogil:
    """0 where x, y and z may be anywhere from ``low`` to ``high``; joints are looked at where a joint is an axis."""
    cdef char place[16]
    cdef Axis* axis
    cdef Joint* joint
    cdef int n, i
    for i in range(3):
        axis = &m.axis[i]
        snprintf(place, sizeof(place), b"%c", AXIS_NAMES[i])
        if high[i] + m.eoffset[i] > axis.max_limit + slack(axis.max_limit):
            return refuse(m, what, move_id, place, b"positive", high[i] + m.eoffset[i], axis.max_limit)
        if low[i] + m.eoffset[i] < axis.min_limit - slack(axis.min_limit):
            return refuse(m, what, move_id, place, b"negative", low[i] + m.eoffset[i], axis.min_limit)
    for n in range(m.kins.joints):
        joint = &m.joint[n]
        i = m.kins.axis_of_joint[n]
        if not joint.active or not 0 <= i < 3:
            continue
        snprintf(place, sizeof(place), b"joint %d", n)
        if high[i] > joint.max_limit + slack(joint.max_limit):
            return refuse(m, what, move_id, place, b"positive", high[i], joint.max_limit)
        if low[i] < joint.min_limit - slack(joint.min_limit):
            return refuse(m, what, move_id, place, b"negative", low[i], joint.min_limit)
    return 0


cdef void joint_of_axes(Motion* m, int joint, double* row) noexcept nogil:
    """How this joint's position changes with each axis; 0 for all where that is not fixed."""
    cdef double joints[MAX_JOINTS]
    cdef double pose[MAX_AXES]
    cdef double at_zero
    cdef int i
    for i in range(MAX_AXES):
        row[i] = 0.0
        pose[i] = 0.0
    if not m.kins.linear:
        if m.kins.axis_of_joint[joint] >= 0:
            row[m.kins.axis_of_joint[joint]] = 1.0
        return
    m.kins.inverse(m.kins, joints, pose)
    at_zero = joints[joint]
    for i in range(MAX_AXES):
        pose[i] = 1.0
        m.kins.inverse(m.kins, joints, pose)
        pose[i] = 0.0
        row[i] = joints[joint] - at_zero


cdef void lower(double* axis_limits, const double* row, double joint_limit) noexcept nogil:
    """Lower the limits of the axes that move a joint until all of them together cannot overtax it."""
    cdef double total = 0.0
    cdef int i
    for i in range(MAX_AXES):
        total += fabs(row[i]) * axis_limits[i]
    if total <= joint_limit:
        return
    for i in range(MAX_AXES):
        if row[i] != 0.0:
            axis_limits[i] *= joint_limit / total


cdef void lower_jerk(double* axis_limits, const double* row, double joint_limit) noexcept nogil:
    """As ``lower``, where 0 is no limit."""
    cdef int i
    if joint_limit <= 0.0:
        return
    for i in range(MAX_AXES):
        if row[i] != 0.0:
            axis_limits[i] = tighter(axis_limits[i], joint_limit / fabs(row[i]))
    lower(axis_limits, row, joint_limit)


cdef double offset_share(const Axis* axis) noexcept nogil:
    """The part of the axis that its external offset has for itself."""
    return axis.eoffset_acc_limit / (axis.acc_limit + axis.eoffset_acc_limit) if axis.eoffset_acc_limit > 0.0 else 0.0


cdef void limit_axis_moves(Axis* axis, double share) noexcept nogil:
    """The acceleration (a share of what the axis may) and the jerk of jogs."""
    axis.teleop.acc_limit = share * axis.acc_net
    axis.teleop.jerk_limit = axis.jerk_net


cdef double tighter(double one, double other) noexcept nogil:
    """The smaller of two limits, of which 0 is none."""
    if one <= 0.0 or 0.0 < other < one:
        return other
    return one


cdef void refresh_planner_limits(Motion* m) noexcept nogil:
    """What each axis may do: what its INI section says, for jogs no more than its joints can follow.

    An axis without limits of its own takes those of the joint that it is. The planner looks after joints by itself.
    """
    cdef double vel[MAX_AXES]
    cdef double acc[MAX_AXES]
    cdef double jerk[MAX_AXES]
    cdef double row[MAX_AXES]
    cdef double share
    cdef int n, i
    for i in range(MAX_AXES):
        vel[i] = m.axis[i].vel_limit
        acc[i] = m.axis[i].acc_limit
        jerk[i] = tighter(m.axis[i].jerk_limit, m.jerk_limit)
    for n in range(m.kins.joints):
        i = m.kins.axis_of_joint[n]
        if i >= 0 and vel[i] <= 0.0:
            vel[i] = m.joint[n].vel_limit
        if i >= 0 and acc[i] <= 0.0:
            acc[i] = m.joint[n].acc_limit
        if i >= 0:
            jerk[i] = tighter(jerk[i], m.joint[n].jerk_limit)
    for i in range(MAX_AXES):
        share = offset_share(&m.axis[i])
        m.axis[i].eoffset_jerk_limit = share * jerk[i] if m.planner_type else 0.0
        jerk[i] *= 1.0 - share
    tell_planner(m, vel, acc, jerk)
    for n in range(m.kins.joints):
        joint_of_axes(m, n, row)
        lower(vel, row, m.joint[n].vel_limit)
        lower(acc, row, m.joint[n].acc_limit)
        lower_jerk(jerk, row, tighter(m.joint[n].jerk_limit, m.jerk_limit))
    for i in range(MAX_AXES):
        m.axis[i].vel_net = vel[i]
        m.axis[i].acc_net = acc[i]
        m.axis[i].jerk_net = jerk[i] if m.planner_type else 0.0
    for n in range(m.num_joints):
        m.joint[n].jerk_net = tighter(m.joint[n].jerk_limit, m.jerk_limit) if m.planner_type else 0.0


cdef void tell_planner(Motion* m, const double* vel, const double* acc, const double* jerk) noexcept nogil:
    """Limits of axes and joints; a joint that is one axis lowers that axis, others are looked after by themselves."""
    cdef double joint_vel[KINS_JOINTS]
    cdef double joint_acc[KINS_JOINTS]
    cdef double joint_jerk[KINS_JOINTS]
    cdef double axis_vel[MAX_AXES]
    cdef double axis_acc[MAX_AXES]
    cdef int all_axes = 1, n, i
    for i in range(MAX_AXES):
        axis_vel[i] = vel[i]
        axis_acc[i] = acc[i]
    for n in range(m.kins.joints):
        joint_vel[n] = m.joint[n].vel_limit
        joint_acc[n] = m.joint[n].acc_limit
        joint_jerk[n] = m.joint[n].jerk_limit
        i = m.kins.axis_of_joint[n]
        if i < 0:
            all_axes = 0
            continue
        axis_vel[i] = fmin(axis_vel[i], joint_vel[n]) if joint_vel[n] > 0.0 else axis_vel[i]
        axis_acc[i] = fmin(axis_acc[i], joint_acc[n]) if joint_acc[n] > 0.0 else axis_acc[i]
    m.planner.set_joints(
        m.tp, NULL if all_axes else <TpInverse>m.kins.inverse, m.kins, m.kins.joints, joint_vel, joint_acc, joint_jerk
    )
    for i in range(MAX_AXES):
        if axis_vel[i] > 0.0 and axis_acc[i] > 0.0:
            m.planner.set_axis_limits(m.tp, i, axis_vel[i], axis_acc[i], jerk[i])
