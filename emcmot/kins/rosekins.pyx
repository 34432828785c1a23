"""A rose engine: joint 0 is the distance from the spindle's axis, joint 1 is z, joint 2 turns the work (degrees).

The work turns on without end: of all turns that reach a pose, joint 2 takes the nearest one. Pins show where it is:
``theta_degrees`` within a turn, ``bigtheta_degrees`` altogether, and the whole ``revolutions``.
"""

from libc.math cimport atan2, cos, floor, hypot, sin

from emcmot.kins.frames cimport DEGREE, nearest_turn
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule

from emcmot.kins.kinematics import check_arguments, provide

cdef enum:               # outputs
    REVOLUTIONS = 0
    THETA = 1
    BIG_THETA = 2

JOINTS = 3
OUTPUTS = tuple((name, 0.0, "float", "OUT") for name in ("revolutions", "theta_degrees", "bigtheta_degrees"))


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    pose[0] = joints[0] * cos(joints[2] * DEGREE)
    pose[1] = joints[0] * sin(joints[2] * DEGREE)
    pose[2] = joints[1]
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double theta = atan2(pose[1], pose[0]) / DEGREE
    joints[0] = hypot(pose[0], pose[1])
    joints[1] = pose[2]
    joints[2] = nearest_turn(theta, joints[2])
    kins.output[REVOLUTIONS] = floor((joints[2] - theta) / 360.0 + 0.5)
    kins.output[THETA] = theta
    kins.output[BIG_THETA] = joints[2]
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("rosekins", JOINTS, (), OUTPUTS)
    module.offer(forward, inverse, {1: 2})
    return module


def load(host, args: dict) -> None:
    check_arguments("rosekins", args)
    provide(host, create())
