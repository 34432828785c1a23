"""A lathe with a driven tool: type 0 is the mill x y z a, type 1 the lathe, whose x is the mill's z.

Joints are those of the mill; in the lathe joint 0 is z, joint 1 is y the other way, joint 2 is x.
"""

from emcmot.kins.kinematics cimport Kinematics, KinematicsModule, identity_forward, identity_inverse
from emcmot.kins.template cimport echo

from emcmot.kins.kinematics import check_arguments
from emcmot.kins.template import OUTPUTS, PARAMETERS, provide_with_demo

LETTERS = "xyza"


cdef int mill_inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    echo(kins)
    return identity_inverse(kins, joints, pose)


cdef int lathe_forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    pose[0] = joints[2]
    pose[1] = -joints[1]
    pose[2] = joints[0]
    pose[3] = joints[3]
    return 0


cdef int lathe_inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    echo(kins)
    joints[0] = pose[2]
    joints[1] = -pose[1]
    joints[2] = pose[0]
    joints[3] = pose[3]
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("millturn", len(LETTERS), PARAMETERS, OUTPUTS)
    module.set_letters(LETTERS)
    module.offer(identity_forward, mill_inverse, {0: 0, 1: 1, 2: 2, 3: 3}, linear=True)
    module.offer(lathe_forward, lathe_inverse, {0: 2, 2: 0, 3: 3}, linear=True)
    return module


def load(host, args: dict) -> None:
    check_arguments("millturn", args)
    provide_with_demo(host, create())
