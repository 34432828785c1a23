"""x and y slides that stand on a rotary table: joints 0 and 1 turn with c (joint 5); the other joints are axes."""

from emcmot.kins.frames cimport turn_plane
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule

from emcmot.kins.kinematics import check_arguments, provide

JOINTS = 9


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef int i
    for i in range(kins.joints):
        pose[i] = joints[i]
    turn_plane(&pose[0], &pose[1], -joints[5])
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef int i
    for i in range(kins.joints):
        joints[i] = pose[i]
    turn_plane(&joints[0], &joints[1], pose[5])
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("rotatekins", JOINTS)
    module.offer(forward, inverse, {joint: joint for joint in range(2, JOINTS)})
    return module


def load(host, args: dict) -> None:
    check_arguments("rotatekins", args)
    provide(host, create())
