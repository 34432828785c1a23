"""A tripod: joints 0 to 2 are the distances of the tool from three motors at (0, 0, 0), (Bx, 0, 0) and (Cx, Cy, 0).

The tool stays above the motors' plane or below it, as its last known z says.
"""

from libc.math cimport sqrt

from emcmot.kins.kinematics cimport Kinematics, KinematicsModule

from emcmot.kins.kinematics import check_arguments, provide

cdef enum:               # parameters
    BX = 0
    CX = 1
    CY = 2

JOINTS = 3
PARAMETERS = tuple((name, 1.0, "float", "IO") for name in ("Bx", "Cx", "Cy"))


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef const double* p = kins.parameter
    cdef double a2 = joints[0] * joints[0]
    cdef double b2 = joints[1] * joints[1]
    cdef double c2 = joints[2] * joints[2]
    cdef double x = (a2 - b2 + p[BX] * p[BX]) / (2.0 * p[BX])
    cdef double y = (a2 - c2 + p[CX] * p[CX] + p[CY] * p[CY] - 2.0 * p[CX] * x) / (2.0 * p[CY])
    cdef double z2 = a2 - x * x - y * y
    if not z2 >= 0.0:
        return -1
    pose[0] = x
    pose[1] = y
    pose[2] = -sqrt(z2) if pose[2] < 0.0 else sqrt(z2)
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef const double* p = kins.parameter
    cdef double x = pose[0], y = pose[1]
    cdef double z2 = pose[2] * pose[2]
    joints[0] = sqrt(x * x + y * y + z2)
    joints[1] = sqrt((x - p[BX]) * (x - p[BX]) + y * y + z2)
    joints[2] = sqrt((x - p[CX]) * (x - p[CX]) + (y - p[CY]) * (y - p[CY]) + z2)
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("tripodkins", JOINTS, PARAMETERS)
    module.offer(forward, inverse)
    return module


def load(host, args: dict) -> None:
    check_arguments("tripodkins", args)
    provide(host, create())
