"""The memory of one motion controller, set up with its defaults; motmod and the stepped simulator both hold one."""

from libc.stdlib cimport calloc, free

from emcmot._messages cimport (
    Enables_FH,
    Enables_FS,
    Enables_SS,
    MAX_AXES,
    MAX_SPINDLES,
    MotionState_FREE,
    TermCond_BLEND,
)
from emcmot.kins.kinematics cimport KinematicsModule
from emcmot.modules cimport HomingModule, PlannerModule
from emcmot.pins cimport pins_of
from emcmot.state cimport Joint, Motion
from emcmot.world cimport refresh_planner_limits

from emcmot.layout import same_size
from emcmot.modules import HOMING, PLANNER
from nml.errors import HalError

same_size(__name__, "Motion", sizeof(Motion))

QUEUE_SIZE = 4000          # moves; short ones, under a low limit of jerk, need as much path as planning and braking take
NO_LIMIT = 1e99
UNLIMITED_SPINDLE = 1e99   # rpm
NO_SEQUENCE = 999          # HOME_SEQUENCE of a joint that "home all" leaves alone

# argument of motmod: default, smallest, largest
LIMITS = {
    "num_joints": (3, 1, 16),
    "num_extrajoints": (0, 0, 16),
    "num_spindles": (1, 0, 8),
    "num_dio": (4, 0, 64),
    "num_aio": (4, 0, 64),
    "num_misc_error": (0, 0, 64),
    "unlock_joints_mask": (0, 0, 0xFFFF),
}


cdef class Core:
    """One motion controller; HalError where the numbers do not fit each other."""

    def __init__(
        self, KinematicsModule kinematics, double servo_period=0.001, PlannerModule planner=None,
        HomingModule homing=None, **numbers,
    ):
        settings = {name: default for name, (default, _, _) in LIMITS.items()}
        settings.update(numbers)
        for name, (_, low, high) in LIMITS.items():
            if not low <= settings[name] <= high:
                raise HalError(f"motmod: {name}={settings[name]}: {low} to {high} are allowed")
        kinematics.fit(settings["num_joints"] - settings["num_extrajoints"])
        if settings["num_joints"] < kinematics.kins.joints + settings["num_extrajoints"]:
            raise HalError(
                f"motmod: num_joints={settings['num_joints']}: {kinematics.name} has {kinematics.kins.joints} joints, "
                f"and num_extrajoints={settings['num_extrajoints']}"
            )
        self.kinematics = kinematics
        self.m = <Motion*>calloc(1, sizeof(Motion))
        if self.m == NULL:
            raise MemoryError
        self.planner, self.homing = planner or PLANNER, homing or HOMING
        self.m.planner, self.m.homing = &self.planner.table, &self.homing.table
        self.m.tp = self.m.planner.create(QUEUE_SIZE)
        if self.m.tp == NULL:
            raise MemoryError
        self._set_defaults(servo_period, settings)
        self.pins = pins_of(self.m, settings["unlock_joints_mask"])

    def __dealloc__(self):
        if self.m != NULL:
            if self.m.tp != NULL:
                self.m.planner.free(self.m.tp)
            free(self.m)

    def _set_defaults(self, double servo_period, dict settings):
        cdef Motion* m = self.m
        cdef Joint* joint
        m.dt = servo_period
        m.kins = &self.kinematics.kins
        m.num_joints = m.max_joints = settings["num_joints"]
        m.num_extra_joints = settings["num_extrajoints"]
        m.num_spindles = m.max_spindles = settings["num_spindles"]
        m.num_dio = settings["num_dio"]
        m.num_aio = settings["num_aio"]
        m.num_misc_error = settings["num_misc_error"]
        m.mode = m.mode_wanted = MotionState_FREE
        m.at_rest = m.tracking = 1
        m.enable_in = 1
        m.adaptive_feed = m.feed_scale = m.rapid_scale = m.max_feed_scale = m.mm_per_unit = 1.0
        m.enables = Enables_SS | Enables_FS | Enables_FH
        m.sync_spindle = m.index_spindle = -1
        m.term_cond = TermCond_BLEND
        m.planner.set_cycle_time(m.tp, servo_period)
        for n in range(m.max_joints):
            joint = &m.joint[n]
            joint.min_limit, joint.max_limit = -NO_LIMIT, NO_LIMIT
            joint.vel_limit = joint.acc_limit = 1.0
            joint.min_ferror = joint.max_ferror = 1.0
            joint.jog_accel_fraction = 1.0
            joint.home.sequence = NO_SEQUENCE
        for n in range(MAX_AXES):
            m.axis[n].min_limit, m.axis[n].max_limit = -NO_LIMIT, NO_LIMIT
            m.axis[n].jog_accel_fraction = 1.0
            m.axis[n].locking_joint = -1
        for n in range(MAX_SPINDLES):
            m.spindle[n].scale = m.spindle[n].net_scale = 1.0
            m.spindle[n].at_speed = 1
            m.spindle[n].max_speed, m.spindle[n].max_reverse_speed = UNLIMITED_SPINDLE, -UNLIMITED_SPINDLE
        refresh_planner_limits(m)
        m.homing.update_homed(m)
        m.planner.get_status(m.tp, &m.tp_status)
