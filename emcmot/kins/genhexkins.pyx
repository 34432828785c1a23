"""A hexapod: six struts between base and platform are the joints; x y z a b c are the platform's place and attitude.

The platform turns about x by a, then about y by b, then about z by c (degrees). The struts of a pose are distances;
the pose of given struts is found by Newton's method from the last known pose, which takes two or three steps from a
period before. Geometry, as pins: base.N.x .. and platform.N.x .. (ends of strut N), spindle-offset, tool-offset,
convergence-criterion, limit-iterations, max-error.
"""

from libc.math cimport M_PI, cos, fabs, sin, sqrt

from emcmot.kins.kinematics cimport KINEMATICS_BOTH, Kinematics, KinematicsModule

from emcmot.kins.kinematics import provide, refuse_arguments

cdef enum:
    STRUTS = 6
    PLATFORM = 18           # first parameter of the platform's points, after those of the base
    SPINDLE_OFFSET = 36
    TOOL_OFFSET = 37
    CRITERION = 38
    LIMIT_ITERATIONS = 39
    MAX_ERROR = 40

NAMES = (
    *(f"base.{n}.{c}" for n in range(6) for c in "xyz"),
    *(f"platform.{n}.{c}" for n in range(6) for c in "xyz"),
    "spindle-offset",
    "tool-offset",
    "convergence-criterion",
    "limit-iterations",
    "max-error",
)
BASE = ((-22.95, 13.25), (22.95, 13.25), (22.95, 13.25), (0.0, -26.5), (0.0, -26.5), (-22.95, 13.25))
TOP = ((-1.0, 11.5), (1.0, 11.5), (10.459, -4.884), (9.459, -6.616), (-9.459, -6.616), (-10.459, -4.884))
DEFAULTS = (
    *(v for x, y in BASE for v in (x, y, 0.0)),
    *(v for x, y in TOP for v in (x, y, 0.0)),
    0.0,
    0.0,
    1e-9,
    120.0,
    500.0,
)
cdef double DEGREE = M_PI / 180.0
cdef double SMALL_PIVOT = 1e-12
cdef double UPRIGHT_SHARE = 0.8   # height of the upright pose over the mean length of the struts


cdef void rotation(const double* pose, double* r) noexcept nogil:
    """The matrix of the platform's attitude, row by row."""
    cdef double sa = sin(pose[3] * DEGREE), ca = cos(pose[3] * DEGREE)
    cdef double sb = sin(pose[4] * DEGREE), cb = cos(pose[4] * DEGREE)
    cdef double sc = sin(pose[5] * DEGREE), cc = cos(pose[5] * DEGREE)
    r[0], r[1], r[2] = cc * cb, cc * sb * sa - sc * ca, cc * sb * ca + sc * sa
    r[3], r[4], r[5] = sc * cb, sc * sb * sa + cc * ca, sc * sb * ca - cc * sa
    r[6], r[7], r[8] = -sb, cb * sa, cb * ca


cdef void strut(
    const Kinematics* kins, const double* pose, const double* r, int n, double* arm, double* vector
) noexcept nogil:
    """``arm``: from the tool's tip to the strut's end on the platform; ``vector``: from the base to there."""
    cdef const double* base = &kins.parameter[3 * n]
    cdef const double* top = &kins.parameter[PLATFORM + 3 * n]
    cdef double z = top[2] + kins.parameter[SPINDLE_OFFSET] + kins.parameter[TOOL_OFFSET]
    cdef int i
    for i in range(3):
        arm[i] = r[3 * i] * top[0] + r[3 * i + 1] * top[1] + r[3 * i + 2] * z
        vector[i] = pose[i] + arm[i] - base[i]
    vector[2] -= kins.parameter[SPINDLE_OFFSET]


cdef double length(const double* v) noexcept nogil:
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double r[9]
    cdef double arm[3]
    cdef double vector[3]
    cdef int n
    rotation(pose, r)
    for n in range(STRUTS):
        strut(kins, pose, r, n, arm, vector)
        joints[n] = length(vector)
    return 0


cdef int solve(double* a, double* b) noexcept nogil:
    """Gauss with column pivots: a (6 x 6) x = b, the solution in b; -1 where a is singular."""
    cdef int col, row, k, best
    cdef double swap, factor
    for col in range(STRUTS):
        best = col
        for row in range(col + 1, STRUTS):
            if fabs(a[6 * row + col]) > fabs(a[6 * best + col]):
                best = row
        if not fabs(a[6 * best + col]) > SMALL_PIVOT:
            return -1
        for k in range(STRUTS):
            swap = a[6 * col + k]
            a[6 * col + k] = a[6 * best + k]
            a[6 * best + k] = swap
        swap = b[col]
        b[col] = b[best]
        b[best] = swap
        for row in range(col + 1, STRUTS):
            factor = a[6 * row + col] / a[6 * col + col]
            for k in range(col, STRUTS):
                a[6 * row + k] -= factor * a[6 * col + k]
            b[row] -= factor * b[col]
    for row in range(STRUTS - 1, -1, -1):
        for k in range(row + 1, STRUTS):
            b[row] -= a[6 * row + k] * b[k]
        b[row] /= a[6 * row + row]
    return 0


cdef void axes_of_attitude(const double* pose, double* axes) noexcept nogil:
    """About which directions a, b and c turn the platform, a row each."""
    cdef double sb = sin(pose[4] * DEGREE), cb = cos(pose[4] * DEGREE)
    cdef double sc = sin(pose[5] * DEGREE), cc = cos(pose[5] * DEGREE)
    axes[0], axes[1], axes[2] = cc * cb, sc * cb, -sb
    axes[3], axes[4], axes[5] = -sc, cc, 0.0
    axes[6], axes[7], axes[8] = 0.0, 0.0, 1.0


cdef double row_of(
    const Kinematics* kins, const double* pose, const double* r, const double* axes, int n, double* row
) noexcept nogil:
    """The length of strut n; ``row``: how it changes with x y z a b c."""
    cdef double arm[3]
    cdef double vector[3]
    cdef double moment[3]
    cdef double size, turned
    cdef int i
    strut(kins, pose, r, n, arm, vector)
    size = length(vector)
    moment[0] = arm[1] * vector[2] - arm[2] * vector[1]
    moment[1] = arm[2] * vector[0] - arm[0] * vector[2]
    moment[2] = arm[0] * vector[1] - arm[1] * vector[0]
    for i in range(3):
        row[i] = vector[i] / size
        turned = axes[3 * i] * moment[0] + axes[3 * i + 1] * moment[1] + axes[3 * i + 2] * moment[2]
        row[3 + i] = turned / size * DEGREE
    return size


cdef int newton(const Kinematics* kins, const double* joints, double* pose) noexcept nogil:
    """Improve ``pose`` until the struts fit; -1 where that does not come to an end."""
    cdef double r[9]
    cdef double axes[9]
    cdef double jacobian[36]
    cdef double step[6]
    cdef double worst
    cdef int iteration, n
    for iteration in range(<int>kins.parameter[LIMIT_ITERATIONS]):
        rotation(pose, r)
        axes_of_attitude(pose, axes)
        worst = 0.0
        for n in range(STRUTS):
            step[n] = joints[n] - row_of(kins, pose, r, axes, n, &jacobian[6 * n])
            worst = max(worst, fabs(step[n]))
        if worst <= kins.parameter[CRITERION]:
            return 0
        if not worst <= kins.parameter[MAX_ERROR] or solve(jacobian, step) != 0:
            return -1
        for n in range(STRUTS):
            pose[n] += step[n]
    return -1


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    """From the last known pose; where none is near (at the first homing), from an upright one above the base."""
    cdef double mean = 0.0
    cdef int n
    if newton(kins, joints, pose) == 0:
        return 0
    for n in range(STRUTS):
        mean += joints[n] / STRUTS
        pose[n] = 0.0
    pose[2] = UPRIGHT_SHARE * mean
    return newton(kins, joints, pose)


def create() -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("genhexkins", NAMES, DEFAULTS)
    module.kins.type = KINEMATICS_BOTH
    module.kins.joints = STRUTS
    module.kins.forward = forward
    module.kins.inverse = inverse
    return module


def load(host, args: dict) -> None:
    refuse_arguments("genhexkins", args)
    provide(host, create())
