"""The Scorbot ER-3: a base that turns (joint 0), a shoulder (1) and an elbow (2), both measured from the level; a and b
of the gripper are joints 3 and 4. Loaded as ``scorbot-kins``. Lengths are mm.
"""

from libc.math cimport acos, atan2, cos, hypot, sin

from emcmot.kins.frames cimport DEGREE, nearest_turn
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule

from emcmot.kins.kinematics import check_arguments, provide

cdef double OUT = 16.0      # of the shoulder from the base's axis
cdef double UP = 140.0      # of the shoulder above the origin
cdef double ARM = 221.0     # upper arm and forearm, each

JOINTS = 5


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double reach = OUT + ARM * (cos(joints[1] * DEGREE) + cos(joints[2] * DEGREE))
    pose[0] = reach * cos(joints[0] * DEGREE)
    pose[1] = reach * sin(joints[0] * DEGREE)
    pose[2] = UP + ARM * (sin(joints[1] * DEGREE) + sin(joints[2] * DEGREE))
    pose[3] = joints[3]
    pose[4] = joints[4]
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    """Both arms are equally long, so they lean by the same angle from the line to the wrist; the elbow is above."""
    cdef double out = hypot(pose[0], pose[1]) - OUT
    cdef double up = pose[2] - UP
    cdef double cosine = hypot(out, up) / (2.0 * ARM)
    cdef double line = atan2(up, out) / DEGREE
    if not cosine <= 1.0:
        return -1
    joints[0] = nearest_turn(atan2(pose[1], pose[0]) / DEGREE, joints[0])
    joints[1] = line + acos(cosine) / DEGREE
    joints[2] = line - acos(cosine) / DEGREE
    joints[3] = pose[3]
    joints[4] = pose[4]
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("scorbot-kins", JOINTS)
    module.offer(forward, inverse, {3: 3, 4: 4})
    return module


def load(host, args: dict) -> None:
    check_arguments("scorbot-kins", args)
    provide(host, create())
