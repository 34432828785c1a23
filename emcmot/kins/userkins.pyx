"""The kinematics of LinuxCNC's template, as it comes: joints 0, 1 and 2 are x, y and z."""

from emcmot.kins.kinematics cimport Kinematics, KinematicsModule, identity_forward, identity_inverse
from emcmot.kins.template cimport echo

from emcmot.kins.kinematics import check_arguments
from emcmot.kins.template import OUTPUTS, PARAMETERS, provide_with_demo

LETTERS = "xyz"


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    echo(kins)
    return identity_inverse(kins, joints, pose)


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("userkins", len(LETTERS), PARAMETERS, OUTPUTS)
    module.set_letters(LETTERS)
    module.offer(identity_forward, inverse, {0: 0, 1: 1, 2: 2}, linear=True)
    return module


def load(host, args: dict) -> None:
    check_arguments("userkins", args)
    provide_with_demo(host, create())
