"""A SCARA robot: two arms that turn in the plane (joints 0, 1), a vertical slide (2) and a wrist (3); a and b may
follow (4, 5).

Lengths (pins D1 .. D6): D1 height of the inner arm, D2 its length, D3 height of the outer arm above the inner one,
D4 its length, D5 height of the outer arm above the tool's tip when joint 2 is 0, D6 distance of the tip from the
wrist's axis. The elbow stays on the side where it is: the sign of joint 1. Switchable to the identity.
"""

from libc.math cimport acos, atan2, cos, sin

from emcmot.kins.frames cimport DEGREE, nearest_turn
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule

from emcmot.kins.kinematics import check_arguments, joint_letters, provide

cdef enum:               # parameters
    D1 = 0
    D2 = 1
    D3 = 2
    D4 = 3
    D5 = 4
    D6 = 5

cdef enum:
    JOINTS = 6

PARAMETERS = (("D1", 490.0), ("D2", 340.0), ("D3", 50.0), ("D4", 250.0), ("D5", 50.0), ("D6", 50.0))


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef const double* d = kins.parameter
    cdef double inner = joints[0] * DEGREE
    cdef double outer = inner + joints[1] * DEGREE
    cdef double wrist = outer + joints[3] * DEGREE
    pose[0] = d[D2] * cos(inner) + d[D4] * cos(outer) + d[D6] * cos(wrist)
    pose[1] = d[D2] * sin(inner) + d[D4] * sin(outer) + d[D6] * sin(wrist)
    pose[2] = d[D1] + d[D3] - joints[2] - d[D5]
    pose[5] = wrist / DEGREE
    if kins.joints == JOINTS:
        pose[3] = joints[4]
        pose[4] = joints[5]
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    """The wrist's axis is known from c; the triangle of the two arms gives the elbow."""
    cdef const double* d = kins.parameter
    cdef double wrist = pose[5] * DEGREE
    cdef double x = pose[0] - d[D6] * cos(wrist)
    cdef double y = pose[1] - d[D6] * sin(wrist)
    cdef double cosine = (x * x + y * y - d[D2] * d[D2] - d[D4] * d[D4]) / (2.0 * d[D2] * d[D4])
    cdef double elbow, inner
    if not -1.0 <= cosine <= 1.0:
        return -1
    elbow = acos(cosine) if joints[1] >= 0.0 else -acos(cosine)
    inner = atan2(y, x) - atan2(d[D4] * sin(elbow), d[D2] + d[D4] * cos(elbow))
    joints[0] = nearest_turn(inner / DEGREE, joints[0])
    joints[1] = elbow / DEGREE
    joints[2] = d[D1] + d[D3] - d[D5] - pose[2]
    joints[3] = pose[5] - joints[0] - joints[1]
    if kins.joints == JOINTS:
        joints[4] = pose[3]
        joints[5] = pose[4]
    return 0


def create(coordinates: str | None = None, sparm: str = "") -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("scarakins", JOINTS, PARAMETERS)
    module.fewest_joints = 4
    module.offer_switchable(forward, inverse, joint_letters("scarakins", coordinates, "xyzabc", JOINTS), sparm)
    return module


def load(host, args: dict) -> None:
    check_arguments("scarakins", args, ("coordinates", "sparm"))
    provide(host, create(**args))
