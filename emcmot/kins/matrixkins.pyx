"""Slides that are not quite square or true: joints 0 to 2 are a matrix times x y z; the other joints are axes.

joint 0 = C_xx x + C_xy y + C_xz z, and so on: pins ``C_xx`` .. ``C_zz``, at first the identity. They are what measuring
a test piece gives.
"""

from libc.math cimport fabs

from emcmot.kins.kinematics cimport Kinematics, KinematicsModule

from emcmot.kins.kinematics import check_arguments, provide

JOINTS = 9
PARAMETERS = tuple((f"C_{row}{column}", float(row == column)) for row in "xyz" for column in "xyz")
cdef double SINGULAR = 1e-9


cdef double minor(const double* m, int row, int column) noexcept nogil:
    """The cofactor of an element of the matrix."""
    cdef int r1 = (row + 1) % 3, r2 = (row + 2) % 3
    cdef int c1 = (column + 1) % 3, c2 = (column + 2) % 3
    return m[3 * r1 + c1] * m[3 * r2 + c2] - m[3 * r1 + c2] * m[3 * r2 + c1]


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    """Cramer's rule."""
    cdef const double* m = kins.parameter
    cdef double determinant = 0.0
    cdef double total
    cdef int i, k
    for i in range(3):
        determinant += m[i] * minor(m, 0, i)
    if fabs(determinant) < SINGULAR:
        return -1
    for i in range(3):
        total = 0.0
        for k in range(3):
            total += minor(m, k, i) * joints[k]
        pose[i] = total / determinant
    for i in range(3, kins.joints):
        pose[i] = joints[i]
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef const double* m = kins.parameter
    cdef int i
    for i in range(3):
        joints[i] = m[3 * i] * pose[0] + m[3 * i + 1] * pose[1] + m[3 * i + 2] * pose[2]
    for i in range(3, kins.joints):
        joints[i] = pose[i]
    return 0


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("matrixkins", JOINTS, PARAMETERS)
    module.fewest_joints = 3
    module.offer(forward, inverse, {joint: joint for joint in range(3, JOINTS)})
    return module


def load(host, args: dict) -> None:
    check_arguments("matrixkins", args)
    provide(host, create())
