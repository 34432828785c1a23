"""A linear delta robot: three carriages (joints 0 to 2) on columns, and arms from them to the tool.

The columns stand around the origin at the effective radius R, the first at (0, R), the others a third of a turn on
each, counterclockwise; the arms are L long. a b c u v w are joints 3 to 8.
"""

from libc.math cimport cos, sin, sqrt

from emcmot.kins.frames cimport DEGREE, lower_meeting_point
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule

from emcmot.kins.kinematics import check_arguments, provide

cdef enum:               # parameters
    R = 0
    L = 1

JOINTS = 9
PARAMETERS = (("R", 130.25), ("L", 269.0))


cdef double column_angle(int n) noexcept nogil:
    return (90.0 + 120.0 * n) * DEGREE


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double tops[9]
    cdef int n
    for n in range(3):
        tops[3 * n] = kins.parameter[R] * cos(column_angle(n))
        tops[3 * n + 1] = kins.parameter[R] * sin(column_angle(n))
        tops[3 * n + 2] = joints[n]
    for n in range(3, kins.joints):
        pose[n] = joints[n]
    return lower_meeting_point(tops, kins.parameter[L], pose)


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double x, y, height2
    cdef int n
    for n in range(3):
        x = pose[0] - kins.parameter[R] * cos(column_angle(n))
        y = pose[1] - kins.parameter[R] * sin(column_angle(n))
        height2 = kins.parameter[L] * kins.parameter[L] - x * x - y * y
        if not height2 >= 0.0:
            return -1
        joints[n] = pose[2] + sqrt(height2)
    for n in range(3, kins.joints):
        joints[n] = pose[n]
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("lineardeltakins", JOINTS, PARAMETERS)
    module.fewest_joints = 3
    module.offer(forward, inverse, {joint: joint for joint in range(3, JOINTS)})
    return module


def load(host, args: dict) -> None:
    check_arguments("lineardeltakins", args)
    provide(host, create())
