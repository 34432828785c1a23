"""A pentapod: five struts (joints) from points above to rings around the effector; x y z a b are its pose.

The effector turns about x by a, then about y by b. Strut N leads from base.N.x y z to the nearest point of the ring
of radius effector.N.r at the height effector.N.z above the effector's origin, so it may turn freely about its own axis.
``tool-offset`` moves the origin along that axis. The pose of given struts is found by Newton's method from the last
known pose.
"""

from libc.math cimport cos, fabs, hypot, sin, sqrt

from emcmot.kins.frames cimport DEGREE
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule
from emcmot.kins.serial cimport solve6

from emcmot.kins.kinematics import check_arguments, provide

cdef enum:
    STRUTS = 5
    ROW = 5                  # parameters of a strut: base x y z, effector r z
    CRITERION = 25
    LIMIT_ITERATIONS = 26
    MAX_ERROR = 27
    TOOL_OFFSET = 28

cdef enum:                   # outputs
    LAST_ITERATIONS = 0
    MAX_ITERATIONS = 1

cdef double SMALL_STEP = 1e-5    # mm and degrees, for the derivative of the struts

BASE = ((-418.03, 324.56, 895.56), (417.96, 324.56, 895.56), (-418.03, -325.44, 895.56), (417.96, -325.44, 895.56),
        (-0.06, -492.96, 895.56))
HEIGHTS = (-185.5, -159.5, -67.5, -41.5, -14.0)
RADIUS = 80.32
PARAMETERS = (
    *(
        row
        for n, ((x, y, z), height) in enumerate(zip(BASE, HEIGHTS, strict=True))
        for row in (
            (f"base.{n}.x", x, "float", "PARAM"),
            (f"base.{n}.y", y, "float", "PARAM"),
            (f"base.{n}.z", z, "float", "PARAM"),
            (f"effector.{n}.r", RADIUS, "float", "PARAM"),
            (f"effector.{n}.z", height, "float", "PARAM"),
        )
    ),
    ("convergence-criterion", 1e-9, "float", "IO"),
    ("limit-iterations", 120.0, "u32", "IO"),
    ("max-error", 100.0, "float", "IO"),
    ("tool-offset", 0.0),
)
OUTPUTS = (("last-iterations", 0.0, "u32", "OUT"), ("max-iterations", 0.0, "u32", "OUT"))


cdef void struts(const Kinematics* kins, const double* pose, double* lengths) noexcept nogil:
    cdef double axis[3]
    cdef double way[3]
    cdef double along, across
    cdef const double* p
    cdef int n, i
    axis[0] = sin(pose[4] * DEGREE) * cos(pose[3] * DEGREE)
    axis[1] = -sin(pose[3] * DEGREE)
    axis[2] = cos(pose[4] * DEGREE) * cos(pose[3] * DEGREE)
    for n in range(STRUTS):
        p = &kins.parameter[ROW * n]
        along = 0.0
        across = 0.0
        for i in range(3):
            way[i] = p[i] - pose[i] - (p[4] + kins.parameter[TOOL_OFFSET]) * axis[i]
            if i == 2:
                way[i] += kins.parameter[TOOL_OFFSET]
            along += way[i] * axis[i]
        for i in range(3):
            across += (way[i] - along * axis[i]) * (way[i] - along * axis[i])
        lengths[n] = hypot(along, sqrt(across) - p[3])


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    struts(kins, pose, joints)
    return 0


cdef void derive(const Kinematics* kins, const double* pose, double* jacobian) noexcept nogil:
    """How the struts change with x y z a b; the sixth row and column are those of the identity."""
    cdef double moved[STRUTS]
    cdef double less[STRUTS]
    cdef double more[STRUTS]
    cdef int n, k
    for k in range(36):
        jacobian[k] = k % 7 == 0
    for k in range(STRUTS):
        for n in range(STRUTS):
            moved[n] = pose[n] - (SMALL_STEP if n == k else 0.0)
        struts(kins, moved, less)
        moved[k] = pose[k] + SMALL_STEP
        struts(kins, moved, more)
        for n in range(STRUTS):
            jacobian[6 * n + k] = (more[n] - less[n]) / (2.0 * SMALL_STEP)


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double lengths[STRUTS]
    cdef double jacobian[36]
    cdef double step[6]
    cdef double worst
    cdef int iteration, n
    for iteration in range(<int>kins.parameter[LIMIT_ITERATIONS]):
        struts(kins, pose, lengths)
        worst = 0.0
        step[5] = 0.0
        for n in range(STRUTS):
            step[n] = joints[n] - lengths[n]
            worst = max(worst, fabs(step[n]))
        kins.output[LAST_ITERATIONS] = iteration
        if worst <= kins.parameter[CRITERION]:
            kins.output[MAX_ITERATIONS] = max(kins.output[MAX_ITERATIONS], kins.output[LAST_ITERATIONS])
            return 0
        derive(kins, pose, jacobian)
        if not worst <= kins.parameter[MAX_ERROR] or solve6(jacobian, step) != 0:
            return -1
        for n in range(STRUTS):
            pose[n] += step[n]
    return -1


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("pentakins", STRUTS, PARAMETERS, OUTPUTS)
    module.offer(forward, inverse)
    return module


def load(host, args: dict) -> None:
    check_arguments("pentakins", args)
    provide(host, create())
