"""A hexapod: six struts between base and platform are the joints; x y z a b c are the platform's place and attitude.

The platform turns about x by a, then about y by b, then about z by c (degrees). The struts of a pose are distances;
the pose of given struts is found by Newton's method from the last known pose, which takes two or three steps from a
period before. Geometry, as pins: base.N.x .. and platform.N.x .. (ends of strut N), spindle-offset, tool-offset,
convergence-criterion, limit-iterations, max-error. A strut whose screw may turn in its nut as its cardanic joints lean
(axes base-n.N.x .., platform-n.N.x ..) is lengthened by its twist times ``screw-lead``; correction.N shows it. The pins
skgui.x .. show the last pose for a screen. Switchable to the identity.
"""

from libc.math cimport M_PI, asin, cos, fabs, sin, sqrt

from emcmot.kins.frames cimport DEGREE, attitude_matrix
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule
from emcmot.kins.serial cimport solve6

from emcmot.kins.kinematics import check_arguments, joint_letters, provide

cdef enum:                  # parameters
    STRUTS = 6
    PLATFORM = 18           # the platform's points, after those of the base
    BASE_AXES = 36
    PLATFORM_AXES = 54
    SPINDLE_OFFSET = 72
    TOOL_OFFSET = 73
    CRITERION = 74
    LIMIT_ITERATIONS = 75
    MAX_ERROR = 76
    SCREW_LEAD = 77

cdef enum:                  # outputs
    CORRECTION = 0
    LAST_ITERATIONS = 6
    MAX_ITERATIONS = 7
    FORWARD_FAILED = 8
    SHOWN_POSE = 9

BASE = ((-22.95, 13.25), (22.95, 13.25), (22.95, 13.25), (0.0, -26.5), (0.0, -26.5), (-22.95, 13.25))
TOP = ((-1.0, 11.5), (1.0, 11.5), (10.459, -4.884), (9.459, -6.616), (-9.459, -6.616), (-10.459, -4.884))
S45, S60 = 0.707107, 0.866025
BASE_N = ((S45, 0.0), (0.0, -S45), (-S45, 0.0), (-S45, 0.0), (0.0, S45), (S45, 0.0))
TOP_N = ((-1.0, 0.0), (S60, 0.5), (S60, 0.5), (S60, -0.5), (S60, -0.5), (-1.0, 0.0))


def points(stem: str, places, z: float) -> list:
    return [
        (f"{stem}.{n}.{letter}", value)
        for n, (x, y) in enumerate(places)
        for letter, value in (("x", x), ("y", y), ("z", z))
    ]


PARAMETERS = (
    *points("base", BASE, 0.0),
    *points("platform", TOP, 0.0),
    *points("base-n", BASE_N, S45),
    *points("platform-n", TOP_N, 0.0),
    ("spindle-offset", 0.0),
    ("tool-offset", 0.0),
    ("convergence-criterion", 1e-9),
    ("limit-iterations", 120.0, "u32"),
    ("max-error", 500.0),
    ("screw-lead", 0.0),
)
OUTPUTS = (
    *((f"correction.{n}", 0.0, "float", "OUT") for n in range(6)),
    ("last-iterations", 0.0, "u32", "OUT"),
    ("max-iterations", 0.0, "u32", "OUT"),
    ("fwd-kins-fail", 0.0, "bit", "OUT"),
    *((f"skgui.{letter}", 0.0, "float", "OUT") for letter in "xyzabc"),
)
cdef double UPRIGHT_SHARE = 0.8   # height of the upright pose over the mean length of the struts


cdef void strut(
    const Kinematics* kins, const double* pose, const double* r, int n, double* arm, double* vector
) noexcept nogil:
    """``arm``: from the tool's tip to the strut's end on the platform; ``vector``: from the base to there."""
    cdef const double* base = &kins.parameter[3 * n]
    cdef const double* top = &kins.parameter[PLATFORM + 3 * n]
    cdef double offset = kins.parameter[SPINDLE_OFFSET] + kins.parameter[TOOL_OFFSET]
    cdef int i
    for i in range(3):
        arm[i] = r[3 * i] * top[0] + r[3 * i + 1] * top[1] + r[3 * i + 2] * (top[2] + offset)
        vector[i] = pose[i] + arm[i] - base[i]
    vector[2] -= offset


cdef double length(const double* v) noexcept nogil:
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


cdef void cross(const double* u, const double* v, double* w) noexcept nogil:
    w[0] = u[1] * v[2] - u[2] * v[1]
    w[1] = u[2] * v[0] - u[0] * v[2]
    w[2] = u[0] * v[1] - u[1] * v[0]


cdef double screw_correction(const Kinematics* kins, const double* r, int n, const double* vector) noexcept nogil:
    """What the twist between the two joints of strut n screws it out; ``vector``: the strut."""
    cdef double lead = kins.parameter[SCREW_LEAD]
    cdef const double* below = &kins.parameter[BASE_AXES + 3 * n]
    cdef const double* fixed = &kins.parameter[PLATFORM_AXES + 3 * n]
    cdef double above[3]
    cdef double at_base[3]
    cdef double at_top[3]
    cdef double between[3]
    cdef double sine = 0.0, scale
    cdef int i
    if lead == 0.0:
        kins.output[CORRECTION + n] = 0.0
        return 0.0
    for i in range(3):
        above[i] = r[3 * i] * fixed[0] + r[3 * i + 1] * fixed[1] + r[3 * i + 2] * fixed[2]
    cross(below, vector, at_base)
    cross(vector, above, at_top)
    cross(at_top, at_base, between)
    scale = length(at_base) * length(at_top) * length(vector)
    for i in range(3):
        sine += between[i] * vector[i]
    kins.output[CORRECTION + n] = lead * asin(min(max(sine / scale, -1.0), 1.0)) / (2.0 * M_PI) if scale > 0.0 else 0.0
    return kins.output[CORRECTION + n]


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double r[9]
    cdef double arm[3]
    cdef double vector[3]
    cdef int n
    attitude_matrix(pose, r)
    for n in range(STRUTS):
        strut(kins, pose, r, n, arm, vector)
        joints[n] = length(vector) + screw_correction(kins, r, n, vector)
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
    return size + screw_correction(kins, r, n, vector)


cdef int newton(const Kinematics* kins, const double* joints, double* pose) noexcept nogil:
    """Improve ``pose`` until the struts fit; -1 where that does not come to an end."""
    cdef double r[9]
    cdef double axes[9]
    cdef double jacobian[36]
    cdef double step[6]
    cdef double worst
    cdef int iteration, n
    for iteration in range(<int>kins.parameter[LIMIT_ITERATIONS]):
        attitude_matrix(pose, r)
        axes_of_attitude(pose, axes)
        worst = 0.0
        for n in range(STRUTS):
            step[n] = joints[n] - row_of(kins, pose, r, axes, n, &jacobian[6 * n])
            worst = max(worst, fabs(step[n]))
        kins.output[LAST_ITERATIONS] = iteration
        if worst <= kins.parameter[CRITERION]:
            kins.output[MAX_ITERATIONS] = max(kins.output[MAX_ITERATIONS], kins.output[LAST_ITERATIONS])
            return 0
        if not worst <= kins.parameter[MAX_ERROR] or solve6(jacobian, step) != 0:
            return -1
        for n in range(STRUTS):
            pose[n] += step[n]
    return -1


cdef int pose_of_struts(const Kinematics* kins, const double* joints, double* pose) noexcept nogil:
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


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef int n
    cdef int result = pose_of_struts(kins, joints, pose)
    kins.output[FORWARD_FAILED] = result != 0
    for n in range(STRUTS):
        kins.output[SHOWN_POSE + n] = pose[n]
    return result


def create(coordinates: str | None = None, sparm: str = "") -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("genhexkins", STRUTS, PARAMETERS, OUTPUTS)
    module.offer_switchable(forward, inverse, joint_letters("genhexkins", coordinates, "xyzabc", STRUTS), sparm)
    return module


def load(host, args: dict) -> None:
    check_arguments("genhexkins", args, ("coordinates", "sparm"))
    provide(host, create(**args))
