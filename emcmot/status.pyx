"""EMCMOT_STATUS out of the state of motion: every servo period, and only what this machine has.

motmod has it written straight into the shared buffer: a cycle that begins with cold caches pays for each line of memory.
"""

from emcmot._messages cimport (
    EMCMOT_AXIS_STATUS,
    EMCMOT_JOINT_STATUS,
    EMCMOT_SPINDLE_STATUS,
    EMCMOT_STATUS,
    EMCMOT_STATUS_TYPE,
    EmcPose,
    JointFlag_ACTIVE,
    JointFlag_ENABLE,
    JointFlag_ERROR,
    JointFlag_FAULT,
    JointFlag_FERROR,
    JointFlag_INPOS,
    JointFlag_MAX_HARD_LIMIT,
    JointFlag_MIN_HARD_LIMIT,
    MAX_AXES,
    MotionFlag_COORD,
    MotionFlag_ENABLE,
    MotionFlag_ERROR,
    MotionFlag_INPOS,
    MotionFlag_TELEOP,
    MotionState_COORD,
    MotionState_DISABLED,
    MotionState_TELEOP,
)
from emcmot.state cimport Axis, Joint, Motion, Spindle

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))


cdef void fill_joint(EMCMOT_JOINT_STATUS* s, const Joint* joint) noexcept nogil:
    s.flag = (
        (JointFlag_ENABLE if joint.amp_enable else 0)
        | (JointFlag_ACTIVE if joint.active else 0)
        | (JointFlag_INPOS if joint.inpos else 0)
        | (JointFlag_ERROR if joint.error else 0)
        | (JointFlag_MAX_HARD_LIMIT if joint.on_pos_limit else 0)
        | (JointFlag_MIN_HARD_LIMIT if joint.on_neg_limit else 0)
        | (JointFlag_FERROR if joint.ferrored else 0)
        | (JointFlag_FAULT if joint.faulted else 0)
    )
    s.homed = joint.home.homed
    s.homing = joint.home.homing
    s.on_soft_limit_neg = joint.on_soft_neg
    s.on_soft_limit_pos = joint.on_soft_pos
    s.pos_cmd = joint.pos_cmd
    s.pos_fb = joint.pos_fb
    s.vel_cmd = joint.vel_cmd
    s.acc_cmd = joint.acc_cmd
    s.ferror = joint.ferror
    s.ferror_high_mark = joint.ferror_high_mark
    s.motor_pos_cmd = joint.motor_pos_cmd
    s.motor_pos_fb = joint.motor_pos_fb
    s.motor_offset = joint.motor_offset
    s.backlash = joint.backlash
    s.max_pos_limit = joint.max_limit
    s.min_pos_limit = joint.min_limit
    s.min_ferror = joint.min_ferror
    s.max_ferror = joint.max_ferror
    s.vel_limit = joint.vel_limit
    s.acc_limit = joint.acc_limit
    s.jerk_limit = joint.jerk_limit


cdef void fill_axis(EMCMOT_AXIS_STATUS* s, const Axis* axis, int teleop) noexcept nogil:
    s.teleop_vel_cmd = axis.teleop.vel if teleop else 0.0
    s.max_pos_limit = axis.max_limit
    s.min_pos_limit = axis.min_limit
    s.vel_limit = axis.vel_limit
    s.acc_limit = axis.acc_limit
    s.jerk_limit = axis.jerk_limit


cdef void fill_spindle(EMCMOT_SPINDLE_STATUS* s, const Spindle* spindle) noexcept nogil:
    s.speed = spindle.speed
    s.scale = spindle.scale
    s.net_scale = spindle.net_scale
    s.css_factor = spindle.css_factor
    s.css_maximum = spindle.css_maximum
    s.xoffset = spindle.xoffset
    s.state = spindle.state
    s.direction = spindle.direction
    s.brake = spindle.brake
    s.locked = spindle.locked
    s.orient_fault = spindle.orient_fault
    s.orient_state = spindle.orient_state
    s.index_enable = spindle.index_enable
    s.at_speed = spindle.at_speed
    s.fault = spindle.amp_fault_in
    s.increasing = spindle.increasing
    s.revs = spindle.revs
    s.speed_in = spindle.speed_in * 60.0


cdef void fill_pose(EmcPose* to, const double* values) noexcept nogil:
    cdef double* target = <double*>to
    cdef int n
    for n in range(MAX_AXES):
        target[n] = values[n]


cdef void fill_modes(EMCMOT_STATUS* s, const Motion* m) noexcept nogil:
    cdef int coord = m.mode == MotionState_COORD
    s.motion_state = m.mode if m.enabled else MotionState_DISABLED
    s.motionFlag = (
        (MotionFlag_ENABLE if m.enabled else 0)
        | (MotionFlag_INPOS if m.at_rest else 0)
        | (MotionFlag_COORD if coord else 0)
        | (MotionFlag_ERROR if m.coord_error else 0)
        | (MotionFlag_TELEOP if m.mode == MotionState_TELEOP else 0)
    )
    s.enables_new = m.enables
    s.enables_queued = m.tp_status.enables if m.tp_status.motion_type else m.enables
    s.jogging_active = m.jog_active
    s.on_soft_limit = m.on_soft_limit
    s.overrideLimitMask = m.override_limits
    s.task_lost = m.task_lost
    s.feed_scale = m.feed_scale
    s.rapid_scale = m.rapid_scale
    s.adaptive_scale = m.adaptive_scale
    s.net_feed_scale = m.net_feed_scale
    s.max_feed_scale = m.max_feed_scale


cdef void fill_trajectory(EMCMOT_STATUS* s, const Motion* m) noexcept nogil:
    s.id = m.tp_status.id
    s.depth = m.tp_status.depth
    s.activeDepth = m.tp_status.active_depth
    s.queueFree = m.tp_status.free
    s.queueFull = m.tp_status.free <= 0
    s.paused = m.tp_status.paused
    s.stepping = m.stepping
    s.reverse_run = m.tp_status.reversing
    s.motionType = m.motion_type_out
    s.probeVal = m.probe_input
    s.probeTripped = m.probe_tripped
    s.probing = m.probing != 0
    s.probe_type = m.probe_type
    s.atspeed_next_feed = m.wait_spindles
    s.spindleSync = m.sync_spindle
    s.vel = m.vel_limit
    s.acc = m.acc_limit
    s.jerk = m.jerk_limit
    s.planner_type = m.planner_type
    s.current_vel = m.current_vel
    s.requested_vel = m.requested_vel
    s.distance_to_go = m.distance_to_go
    s.distance_travelled = m.distance_travelled
    s.carte_pos_cmd_ok = m.pos_cmd_ok
    s.carte_pos_fb_ok = m.pos_fb_ok
    s.external_offsets_applied = m.eoffset_active
    fill_pose(&s.dtg, m.tp_status.dtg)
    fill_pose(&s.carte_pos_cmd, m.pos_cmd)
    fill_pose(&s.carte_pos_fb, m.pos_fb)
    fill_pose(&s.world_home, m.world_home)
    fill_pose(&s.probedPos, m.probed_pos)
    fill_pose(&s.tool_offset, m.tool_offset)
    fill_pose(&s.eoffset_pose, m.eoffset)


cdef void fill_machine(EMCMOT_STATUS* s, const Motion* m) noexcept nogil:
    cdef int n
    s.nml_type = EMCMOT_STATUS_TYPE
    s.nml_size = sizeof(EMCMOT_STATUS)
    s.commandEcho = m.command_echo
    s.commandNumEcho = m.command_num_echo
    s.commandStatus = m.command_status
    s.num_joints = m.num_joints
    s.num_spindles = m.num_spindles
    s.num_dio = m.num_dio
    s.num_aio = m.num_aio
    s.kinematics_type = m.kins.type
    s.kinematics_way = m.kins.way
    s.heartbeat = m.heartbeat
    s.config_num = m.config_num
    s.servo_period = m.dt
    s.servo_time = m.servo_time
    s.servo_time_max = m.servo_time_max
    for n in range(m.num_dio):
        s.synch_di[n] = m.digital_in[n]
        s.synch_do[n] = m.digital_out[n]
    for n in range(m.num_aio):
        s.analog_input[n] = m.analog_in[n]
        s.analog_output[n] = m.analog_out[n]


cdef void fill_status(EMCMOT_STATUS* s, const Motion* m) noexcept nogil:
    cdef int n
    fill_machine(s, m)
    fill_modes(s, m)
    fill_trajectory(s, m)
    for n in range(m.num_joints):
        fill_joint(&s.joint_status[n], &m.joint[n])
    for n in range(MAX_AXES):
        fill_axis(&s.axis_status[n], &m.axis[n], m.mode == MotionState_TELEOP)
    for n in range(m.num_spindles):
        fill_spindle(&s.spindle_status[n], &m.spindle[n])
