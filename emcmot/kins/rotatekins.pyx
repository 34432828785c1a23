"""x and y slides that stand on a rotary table: joints 0 and 1 turn with c (joint 5); the other joints are axes."""

from libc.math cimport M_PI, cos, sin

from emcmot.kins.kinematics cimport KINEMATICS_BOTH, Kinematics, KinematicsModule

from emcmot.kins.kinematics import provide, refuse_arguments

JOINTS = 9


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double angle = joints[5] * M_PI / 180.0
    cdef int i
    pose[0] = joints[0] * cos(angle) + joints[1] * sin(angle)
    pose[1] = joints[1] * cos(angle) - joints[0] * sin(angle)
    for i in range(2, kins.joints):
        pose[i] = joints[i]
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double angle = pose[5] * M_PI / 180.0
    cdef int i
    joints[0] = pose[0] * cos(angle) - pose[1] * sin(angle)
    joints[1] = pose[0] * sin(angle) + pose[1] * cos(angle)
    for i in range(2, kins.joints):
        joints[i] = pose[i]
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("rotatekins")
    module.kins.type = KINEMATICS_BOTH
    module.kins.joints = JOINTS
    for joint in range(2, JOINTS):
        module.kins.axis_of_joint[joint] = joint
    module.kins.forward = forward
    module.kins.inverse = inverse
    return module


def load(host, args: dict) -> None:
    refuse_arguments("rotatekins", args)
    provide(host, create())
