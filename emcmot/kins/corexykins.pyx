"""CoreXY: two belts move x and y together. x = (joint 0 + joint 1) / 2, y = (joint 0 - joint 1) / 2; z a b c u v w
follow.
"""

from emcmot.kins.kinematics cimport Kinematics, KinematicsModule

from emcmot.kins.kinematics import check_arguments, provide

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
    cdef KinematicsModule module = KinematicsModule("corexykins", JOINTS)
    module.fewest_joints = 3
    module.offer(forward, inverse, {joint: joint for joint in range(2, JOINTS)}, linear=True)
    return module


def load(host, args: dict) -> None:
    check_arguments("corexykins", args)
    provide(host, create())
