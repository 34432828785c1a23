"""The memory of motion: one C structure that every file of this package works on, and nothing of HAL or NML in it.

Pin values are plain members (bits and counts as int32_t, floats as double); ``pins.pyx`` names them, motmod copies them
from and to HAL cells, and the stepped simulator reads and writes them by name. Units: lu or degrees, seconds, as in the
messages. Bit-like members are 0 or 1.
"""

from libc.stdint cimport int8_t, int32_t, int64_t

from emcmot._messages cimport EMCMOT_ERROR, MAX_AIO, MAX_AXES, MAX_DIO, MAX_JOINTS, MAX_SPINDLES
from emcmot.free_planner cimport FreePlanner
from emcmot.kins.kinematics cimport Kinematics
from emcmot.tp.interface cimport TpInterface
from emcmot.tp.tp cimport Tp, TpIo, TpStatus

cdef enum:
    MISC_ERRORS = 64
    ERRORS = 32          # texts kept between two drains of the error ring
    LINES = 4096         # ids remembered with their program line; a power of two above the queue's size
    COMP_POINTS = 256    # triplets of a screw compensation table

cdef enum OrientState:
    ORIENT_NONE = 0
    ORIENT_COMPLETE = 1
    ORIENT_IN_PROGRESS = 2
    ORIENT_FAULTED = 3

ctypedef struct Compensation:
    int points
    double nominal[COMP_POINTS]      # rising
    double forward[COMP_POINTS]      # correction to add when moving up
    double reverse[COMP_POINTS]      # correction to add when moving down

ctypedef struct Homing:
    double offset            # HOME_OFFSET: joint position of the switch or index
    double home              # HOME: where the final move ends
    double final_vel         # <= 0: rapid
    double search_vel
    double latch_vel
    int flags
    int sequence
    int is_volatile
    int32_t state            # HomeState, also the pin home-state
    int32_t homed
    int32_t homing
    int pause_periods        # of HOME_DELAY still to wait
    int index_armed

ctypedef struct Joint:
    # configuration
    int32_t active
    double max_limit
    double min_limit
    double vel_limit
    double acc_limit
    double jerk_limit        # 0: none
    double jerk_net          # of jogs and homing: its own limit or the machine's; 0: none
    double min_ferror
    double max_ferror
    double backlash
    # inputs
    double motor_pos_fb
    double posthome_cmd
    int32_t home_sw
    int32_t pos_lim_sw
    int32_t neg_lim_sw
    int32_t amp_fault_in
    int32_t index_enable
    int32_t is_unlocked
    int32_t jog_counts
    int32_t jog_enable
    int32_t jog_vel_mode
    double jog_scale
    double jog_accel_fraction
    # positions and their derivatives
    FreePlanner free
    double coarse_pos
    double pos_cmd
    double vel_cmd
    double acc_cmd
    double jerk_cmd
    double backlash_corr     # correction wanted
    FreePlanner correction   # the correction applied, which follows it under limits
    double motor_offset
    double motor_pos_cmd
    double pos_fb
    double ferror
    double ferror_limit
    double ferror_high_mark
    # state
    int32_t amp_enable
    int32_t inpos
    int32_t error
    int32_t faulted
    int32_t ferrored
    int32_t on_pos_limit
    int32_t on_neg_limit
    int32_t kb_jog
    int32_t wheel_jog
    int32_t unlock
    int32_t on_soft_pos
    int32_t on_soft_neg
    int soft_limit_reported
    int wheel_counts         # jog_counts of the period before
    int wheel_refused        # it was said why the wheel does not move this joint
    double jog_vel           # speed that the running jog asks for
    Homing home
    Compensation comp        # last: the memory that every period touches lies together

ctypedef struct Axis:
    double max_limit
    double min_limit
    double vel_limit
    double acc_limit
    double jerk_limit        # 0: none
    int locking_joint
    # inputs
    int32_t jog_counts
    int32_t jog_enable
    int32_t jog_vel_mode
    double jog_scale
    double jog_accel_fraction
    int32_t eoffset_enable
    int32_t eoffset_clear
    int32_t eoffset_counts
    double eoffset_scale
    # state
    double vel_net           # vel_limit and acc_limit, or less where the axis is a joint that may less
    double acc_net
    double jerk_net          # of jogs; 0: none
    double eoffset_jerk_limit
    FreePlanner teleop
    double pos_cmd           # without external offset
    int32_t kb_jog
    int32_t wheel_jog
    int wheel_counts
    int wheel_refused
    double jog_vel
    FreePlanner eoffset
    double eoffset_request
    double eoffset_vel_limit
    double eoffset_acc_limit
    double eoffset_register  # counts taken while enabled
    int eoffset_last_counts

ctypedef struct Spindle:
    # commanded
    double speed             # rpm, signed
    double css_factor
    double css_maximum
    double xoffset
    double scale
    double net_scale
    double min_speed         # forward
    double min_reverse_speed # signed: nearest to 0 (0: none)
    double max_speed
    double max_reverse_speed # signed: the fastest
    int state
    int32_t direction
    int increasing
    int orient_state
    double tap_scale         # 0, or minus what a tap on its way out multiplies the speed by
    # inputs
    double revs
    double speed_in          # rev/s
    int32_t at_speed
    int32_t amp_fault_in
    int32_t is_oriented
    int32_t orient_fault
    int32_t inhibit
    int32_t index_enable
    # outputs
    int32_t on
    int32_t forward
    int32_t reverse
    int32_t brake
    int32_t locked
    int32_t orient
    int32_t orient_mode
    double orient_angle
    double speed_out         # rpm
    double speed_out_abs
    double speed_out_rps
    double speed_out_rps_abs
    double speed_cmd_rps

ctypedef struct Motion
ctypedef struct HomingInterface:   # what motion asks of a homing module, in the servo thread
    void (*cycle)(Motion* m) noexcept nogil                    # one period of all joints and of the home sequence
    int (*home_joint)(Motion* m, int number) noexcept nogil    # begin; 0, or -1 refused with a report
    void (*home_all)(Motion* m) noexcept nogil                 # begin with the first step of the sequence
    int (*is_active)(Motion* m) noexcept nogil                 # is a joint homing, or the sequence between two of them?
    void (*cancel)(Motion* m) noexcept nogil                   # stop; joints that were at it are not homed
    void (*update_homed)(Motion* m) noexcept nogil             # Motion.all_homed, from the joints

ctypedef struct Motion:
    double dt                # servo period, s
    double host_now          # host time, s; set by the owner before the command handler runs
    int num_joints
    int max_joints           # what motmod was loaded for; num_joints may be less
    int num_extra_joints
    int num_spindles
    int max_spindles
    int num_dio
    int num_aio
    int num_misc_error
    Kinematics* kins
    const HomingInterface* homing
    const TpInterface* planner
    Tp* tp               # the planner's own memory
    TpStatus tp_status
    Joint joint[MAX_JOINTS]
    Axis axis[MAX_AXES]
    Spindle spindle[MAX_SPINDLES]
    # inputs of the machine
    int32_t enable_in
    int32_t feed_hold
    int32_t feed_inhibit
    int32_t homing_inhibit
    int32_t jog_inhibit
    int32_t jog_stop
    int32_t jog_stop_immediate
    int32_t probe_input
    double adaptive_feed
    double switchkins_type
    int32_t misc_error[MISC_ERRORS]
    int32_t digital_in[MAX_DIO]
    int32_t digital_out[MAX_DIO]
    double analog_in[MAX_AIO]
    double analog_out[MAX_AIO]
    # modes
    int enable_wanted
    int enabled
    int mode_wanted          # MotionState FREE, TELEOP or COORD
    int mode                 # who makes the joint commands now: MotionState FREE, TELEOP or COORD
    int stopping             # an abort is slowing the machine down
    int at_rest
    int tracking             # disabled and at rest: the joint commands follow the feedback
    int chasing              # a joint of other than linear kinematics is behind its Cartesian command
    int coord_error
    int refused_way          # the kinematics type asked for last that there is none of
    int settling             # periods of standstill until the feedback, or a switch of the kinematics, has come in
    # pins that tell of it
    int32_t motion_enabled_out
    int32_t coord_mode_out
    int32_t teleop_mode_out
    int32_t in_position
    int32_t all_homed
    int32_t jog_active
    int32_t on_soft_limit
    int32_t motion_type_out
    int32_t program_line
    int32_t coord_error_out
    int32_t tp_reverse_out
    int32_t eoffset_active
    int32_t eoffset_limited
    double current_vel
    double requested_vel
    double distance_to_go
    double distance_travelled
    double mm_per_unit
    double feed_upm
    double feed_ipm
    double feed_ips
    double feed_mmpm
    double feed_mmps
    # trajectory
    double pos_cmd[MAX_AXES]        # Cartesian, with external offsets
    double pos_fb[MAX_AXES]
    int pos_cmd_ok
    int pos_fb_ok
    double eoffset[MAX_AXES]
    double tool_offset[MAX_AXES]
    double world_home[MAX_AXES]
    double vel_limit
    double acc_limit
    double jerk_limit        # of the path; 0: none
    int planner_type         # 0 trapezoidal, 1 with limited jerk
    double feed_scale
    double rapid_scale
    double max_feed_scale
    double adaptive_scale
    int adaptive_reverse     # motion.adaptive-feed is negative: the path is to be run backwards
    int command_reverse      # REVERSE is in force
    double net_feed_scale
    int enables
    int term_cond
    double term_tolerance
    double next_vel          # SET_VEL
    double next_vel_max
    int paused
    int stepping
    TpIo pending_io
    int pending_io_set
    int sync_spindle         # -1: moves to come are not synchronised
    double sync_revs
    int sync_velocity
    int index_spindle        # whose index pulse was asked for, -1: none
    int wait_spindles        # mask for the next feed move
    int32_t line_of_id[LINES]
    int8_t units_of_id[LINES]   # of the program: EMCMOT_COMMAND.mode of a move
    double queue_end[MAX_AXES]  # end point of the move queued last
    int last_move_type       # motion type of the move queued last
    int last_move_synchronised
    int override_limits      # mask: 1 << 2n negative, 2 << 2n positive limit of joint n
    int overriding_jog       # the jog that ends the override has begun
    # probing
    int probing              # 0 no, 1 queued, 2 looking
    int probe_type
    int probe_tripped
    int probe_last
    double probed_pos[MAX_AXES]
    int probe_jog_inhibit
    int probe_home_inhibit
    # home sequence of the machine
    int home_step            # HomeStep
    int home_sequence
    int home_all
    # supervision of task
    double heartbeat_timeout # s; 0: off
    double last_command
    int task_lost
    # reports
    int64_t heartbeat
    int config_num
    int command_echo
    int command_num_echo
    int command_status
    int32_t last_period      # ns between the last two calls of the controller
    double servo_time
    double servo_time_max
    EMCMOT_ERROR errors[ERRORS]
    int error_count
