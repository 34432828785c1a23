"""A small five-axis mill: the head tilts about y (b), the work turns on the table (c), and u v w move along the tool.

``pivot-length`` is the distance from the head's pivot to the tool's tip at w 0. Joints are x y z a b c u v w, the last
three where there are any; x and z of the slides make up for the tilted tool, x and y turn with the table.
"""

from libc.math cimport cos, sin

from emcmot.kins.frames cimport DEGREE, turn_plane
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule

from emcmot.kins.kinematics import check_arguments, provide

cdef enum:
    PIVOT = 0            # parameter
    JOINTS = 9

PARAMETERS = (("pivot-length", 0.666, "float", "IO"),)


cdef void tilt(const Kinematics* kins, const double* pose, double* x, double* z) noexcept nogil:
    """How far the slides are from the tip because the tool is tilted; u is across the tool, w along it."""
    cdef double s = sin(pose[4] * DEGREE), c = cos(pose[4] * DEGREE)
    cdef double length = kins.parameter[PIVOT] + pose[8]
    x[0] = pose[6] * c - length * s
    z[0] = pose[6] * s + length * c - kins.parameter[PIVOT]


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double x, z
    cdef int n
    for n in range(3, kins.joints):
        pose[n] = joints[n]
    tilt(kins, pose, &x, &z)
    pose[0] = joints[0] - x
    pose[1] = joints[1] - pose[7]
    pose[2] = joints[2] - z
    turn_plane(&pose[0], &pose[1], joints[5])
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double x, z
    cdef int n
    for n in range(kins.joints):
        joints[n] = pose[n]
    tilt(kins, pose, &x, &z)
    turn_plane(&joints[0], &joints[1], -pose[5])
    joints[0] += x
    joints[1] += pose[7]
    joints[2] += z
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("maxkins", JOINTS, PARAMETERS)
    module.fewest_joints = 6
    module.offer(forward, inverse, {joint: joint for joint in range(3, JOINTS)})
    return module


def load(host, args: dict) -> None:
    check_arguments("maxkins", args)
    provide(host, create())
