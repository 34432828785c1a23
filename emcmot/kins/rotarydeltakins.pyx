"""A rotary delta robot: three thighs turn at the corners of the platform (joints 0 to 2), shins lead to the foot.

The hips are at ``platformradius``, the first in the direction of -y, the others a third of a turn on each,
counterclockwise. A joint at 0 holds its thigh level and outwards; positive is downwards. The shins meet the foot at
``footradius``. a b c u v w are joints 3 to 8.
"""

from libc.math cimport acos, atan2, cos, hypot, sin

from emcmot.kins.frames cimport DEGREE, lower_meeting_point, turn_plane
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule

from emcmot.kins.kinematics import check_arguments, provide

cdef enum:               # parameters
    PLATFORM = 0
    THIGH = 1
    SHIN = 2
    FOOT = 3

JOINTS = 9
PARAMETERS = (("platformradius", 10.0), ("thighlength", 10.0), ("shinlength", 14.0), ("footradius", 6.0))


cdef double hip_angle(int n) noexcept nogil:
    """Degrees."""
    return -90.0 + 120.0 * n


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    """The tool is a shin away from each knee, moved inwards by the foot's radius."""
    cdef const double* p = kins.parameter
    cdef double knees[9]
    cdef double angle
    cdef int n
    for n in range(3):
        angle = joints[n] * DEGREE
        knees[3 * n] = p[PLATFORM] - p[FOOT] + p[THIGH] * cos(angle)
        knees[3 * n + 1] = 0.0
        knees[3 * n + 2] = -p[THIGH] * sin(angle)
        turn_plane(&knees[3 * n], &knees[3 * n + 1], hip_angle(n))
    for n in range(3, kins.joints):
        pose[n] = joints[n]
    return lower_meeting_point(knees, p[SHIN], pose)


cdef int thigh_angle(const Kinematics* kins, double out, double aside, double z, double* joint) noexcept nogil:
    """The joint where the foot's corner is ``out`` from the hip's line, ``aside`` of the thigh's plane and at ``z``."""
    cdef const double* p = kins.parameter
    cdef double reach = hypot(out, z)
    cdef double cosine = (p[THIGH] * p[THIGH] + reach * reach + aside * aside - p[SHIN] * p[SHIN])
    cosine /= 2.0 * p[THIGH] * reach
    if not -1.0 <= cosine <= 1.0:
        return -1
    joint[0] = (atan2(-z, out) - acos(cosine)) / DEGREE
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef const double* p = kins.parameter
    cdef double out, aside
    cdef int n
    for n in range(3):
        out, aside = pose[0], pose[1]
        turn_plane(&out, &aside, -hip_angle(n))
        if thigh_angle(kins, out + p[FOOT] - p[PLATFORM], aside, pose[2], &joints[n]) != 0:
            return -1
    for n in range(3, kins.joints):
        joints[n] = pose[n]
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("rotarydeltakins", JOINTS, PARAMETERS)
    module.fewest_joints = 3
    module.offer(forward, inverse, {joint: joint for joint in range(3, JOINTS)})
    return module


def load(host, args: dict) -> None:
    check_arguments("rotarydeltakins", args)
    provide(host, create())
