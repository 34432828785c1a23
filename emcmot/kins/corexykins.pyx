"""CoreXY: two belts move x and y together. x = (joint 0 + joint 1) / 2, y = (joint 0 - joint 1) / 2; z a b c u v w
follow.
"""

from emcmot.kins.kinematics cimport KINEMATICS_BOTH, Kinematics, KinematicsModule

from emcmot.kins.kinematics import provide, refuse_arguments

JOINTS = 9


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef int i
    pose[0] = 0.5 * (joints[0] + joints[1])
    pose[1] = 0.5 * (joints[0] - joints[1])
    for i in range(2, kins.joints):
        pose[i] = joints[i]
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef int i
    joints[0] = pose[0] + pose[1]
    joints[1] = pose[0] - pose[1]
    for i in range(2, kins.joints):
        joints[i] = pose[i]
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("corexykins")
    module.flexible = True
    module.kins.linear = 1
    module.kins.type = KINEMATICS_BOTH
    module.kins.joints = JOINTS
    for joint in range(2, JOINTS):
        module.kins.axis_of_joint[joint] = joint
    module.kins.forward = forward
    module.kins.inverse = inverse
    return module


def load(host, args: dict) -> None:
    refuse_arguments("corexykins", args)
    provide(host, create())
