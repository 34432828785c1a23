"""An arm of six turning joints with any geometry: A-N, ALPHA-N, D-N, Craig's Denavit-Hartenberg parameters, mm and rad.

The joints of a pose are found from where they are, by damped Newton steps; ``last-iterations`` shows how many it took.
``unrotate-N``: joint N's motor turns with this share of joint N - 1 as well, which is taken out. Axes u v w are joints
6 to 8 where the machine has them. Switchable to the identity.
"""

from libc.math cimport M_PI, atan2, fabs, hypot, sqrt

from emcmot.kins.frames cimport DEGREE, attitude_matrix, attitude_of_matrix
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule
from emcmot.kins.serial cimport LINKS, Link, chain, frame_times_link, solve6

from emcmot.kins.kinematics import check_arguments, joint_letters, provide

cdef enum:
    ROW = 4                  # parameters of a joint: A, ALPHA, D, unrotate
    MAX_ITERATIONS = 24      # parameter
    LAST_ITERATIONS = 0      # output

cdef double CLOSE = 1e-9         # mm and rad: a smaller error is none
cdef double DAMPING = 1e-6       # keeps steps finite where the wrist is stretched
cdef double LONGEST_STEP = 0.5   # rad

STANDARD = "xyzabcuvw"
PUMA = ((0.0, 0.0, 0.0), (0.0, -M_PI / 2, 0.0), (300.0, 0.0, 70.0), (50.0, -M_PI / 2, 400.0), (0.0, M_PI / 2, 0.0),
        (0.0, -M_PI / 2, 0.0))
PARAMETERS = (
    *(
        row
        for n, (a, alpha, d) in enumerate(PUMA)
        for row in ((f"A-{n}", a), (f"ALPHA-{n}", alpha), (f"D-{n}", d), (f"unrotate-{n}", 0.0, "s32"))
    ),
    ("max-iterations", 100.0, "u32"),
)
OUTPUTS = (("last-iterations", 0.0, "u32", "OUT"),)


cdef void links_of(const Kinematics* kins, Link* links) noexcept nogil:
    cdef int n
    for n in range(LINKS):
        links[n] = Link(kins.parameter[ROW * n], kins.parameter[ROW * n + 1], kins.parameter[ROW * n + 2])


cdef void angles_of(const Kinematics* kins, const double* joints, double* angles) noexcept nogil:
    """What the links turn by when the motors stand at ``joints``."""
    cdef int n
    angles[0] = joints[0]
    for n in range(1, LINKS):
        angles[n] = joints[n] - kins.parameter[ROW * n + 3] * joints[n - 1]


cdef void joints_of(const Kinematics* kins, const double* angles, double* joints) noexcept nogil:
    cdef int n
    joints[0] = angles[0]
    for n in range(1, LINKS):
        joints[n] = angles[n] + kins.parameter[ROW * n + 3] * joints[n - 1]


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef Link links[LINKS]
    cdef double angles[LINKS]
    cdef double r[9]
    cdef int n
    links_of(kins, links)
    angles_of(kins, joints, angles)
    chain(links, angles, r, pose)
    attitude_of_matrix(r, pose)
    for n in range(LINKS, kins.joints):
        pose[n] = joints[n]
    return 0


cdef double error_of(
    const double* wanted_r, const double* wanted_p, const double* r, const double* p, double* e
) noexcept nogil:
    """What is missing to the wanted frame: three ways, then the turn as a vector (rad); returns its size."""
    cdef double turn[3]
    cdef double m[9]
    cdef double sine, angle
    cdef int i, k
    for i in range(3):
        e[i] = wanted_p[i] - p[i]
        for k in range(3):
            m[3 * i + k] = (
                wanted_r[3 * i] * r[3 * k] + wanted_r[3 * i + 1] * r[3 * k + 1] + wanted_r[3 * i + 2] * r[3 * k + 2]
            )
    turn[0], turn[1], turn[2] = 0.5 * (m[7] - m[5]), 0.5 * (m[2] - m[6]), 0.5 * (m[3] - m[1])
    sine = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2])
    angle = atan2(sine, 0.5 * (m[0] + m[4] + m[8] - 1.0))
    for i in range(3):
        e[3 + i] = turn[i] * (angle / sine if sine > CLOSE else 1.0)
    return hypot(sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]), angle)


cdef void jacobian_of(const Link* links, const double* angles, const double* tip, double* jacobian) noexcept nogil:
    """How the tip's place and attitude change with each joint (rad), column by column."""
    cdef double r[9]
    cdef double p[3]
    cdef double arm[3]
    cdef int n, i
    for i in range(9):
        r[i] = i % 4 == 0
    for i in range(3):
        p[i] = 0.0
    for n in range(LINKS):
        frame_times_link(r, p, &links[n], angles[n])
        for i in range(3):
            arm[i] = tip[i] - p[i]
            jacobian[6 * (3 + i) + n] = r[3 * i + 2]
        jacobian[n] = r[5] * arm[2] - r[8] * arm[1]
        jacobian[6 + n] = r[8] * arm[0] - r[2] * arm[2]
        jacobian[12 + n] = r[2] * arm[1] - r[5] * arm[0]


cdef int newton_step(const double* jacobian, double* e, double scale) noexcept nogil:
    """Replace the error by the joints' step (rad) that removes it: (JtJ + damping) step = Jt e, ways in ``scale``."""
    cdef double a[36]
    cdef double b[6]
    cdef double weight
    cdef int i, k, n
    for i in range(LINKS):
        b[i] = 0.0
        for k in range(LINKS):
            a[6 * i + k] = DAMPING * (i == k)
        for n in range(6):
            weight = scale if n < 3 else 1.0
            b[i] += weight * jacobian[6 * n + i] * e[n]
            for k in range(LINKS):
                a[6 * i + k] += weight * jacobian[6 * n + i] * jacobian[6 * n + k]
    if solve6(a, b) != 0:
        return -1
    weight = 0.0
    for i in range(LINKS):
        weight = max(weight, fabs(b[i]))
    for i in range(LINKS):
        e[i] = b[i] * (LONGEST_STEP / weight if weight > LONGEST_STEP else 1.0)
    return 0


cdef double squared_reach(const Link* links) noexcept nogil:
    cdef double reach = 1.0
    cdef int n
    for n in range(LINKS):
        reach += fabs(links[n].a) + fabs(links[n].d)
    return reach * reach


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef Link links[LINKS]
    cdef double angles[LINKS]
    cdef double wanted[9]
    cdef double r[9]
    cdef double p[3]
    cdef double e[6]
    cdef double jacobian[36]
    cdef int n, iteration
    links_of(kins, links)
    angles_of(kins, joints, angles)
    attitude_matrix(pose, wanted)
    for iteration in range(<int>kins.parameter[MAX_ITERATIONS]):
        chain(links, angles, r, p)
        if error_of(wanted, pose, r, p, e) <= CLOSE:
            kins.output[LAST_ITERATIONS] = iteration
            joints_of(kins, angles, joints)
            for n in range(LINKS, kins.joints):
                joints[n] = pose[n]
            return 0
        jacobian_of(links, angles, p, jacobian)
        if newton_step(jacobian, e, 1.0 / squared_reach(links)) != 0:
            return -1
        for n in range(LINKS):
            angles[n] += e[n] / DEGREE
    return -1


def create(coordinates: str | None = None, sparm: str = "") -> KinematicsModule:
    letters = joint_letters("genserkins", coordinates, STANDARD[:LINKS], 9) if coordinates else STANDARD
    cdef KinematicsModule module = KinematicsModule("genserkins", len(letters), PARAMETERS, OUTPUTS)
    module.fewest_joints = LINKS
    module.offer_switchable(forward, inverse, letters, sparm)
    return module


def load(host, args: dict) -> None:
    check_arguments("genserkins", args, ("coordinates", "sparm"))
    provide(host, create(**args))
