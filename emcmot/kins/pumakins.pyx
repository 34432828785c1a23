"""A Puma robot with six joints, described by Craig's A2, A3, D3, D4 (mm) and the tool's length D6.

Eight sets of joints reach a pose: shoulder left or right, elbow up or down, wrist turned over or not. The joints take
the set that is nearest to where they are. Switchable to the identity.
"""

from libc.math cimport M_PI, atan2, cos, fabs, hypot, sin, sqrt

from emcmot.kins.frames cimport DEGREE, attitude_matrix, attitude_of_matrix, nearest_turn
from emcmot.kins.kinematics cimport Kinematics, KinematicsModule
from emcmot.kins.serial cimport LINKS, Link, chain, frame_times_link

from emcmot.kins.kinematics import check_arguments, joint_letters, provide

cdef enum:               # parameters
    A2 = 0
    A3 = 1
    D3 = 2
    D4 = 3
    D6 = 4

cdef double STRETCHED = 1e-9     # sine of a wrist angle that leaves joints 3 and 5 on one line
cdef double FAR = 1e9

PARAMETERS = (("A2", 300.0), ("A3", 50.0), ("D3", 70.0), ("D4", 400.0), ("D6", 70.0))


cdef void links_of(const Kinematics* kins, Link* links) noexcept nogil:
    cdef const double* p = kins.parameter
    links[0] = Link(0.0, 0.0, 0.0)
    links[1] = Link(0.0, -0.5 * M_PI, 0.0)
    links[2] = Link(p[A2], 0.0, p[D3])
    links[3] = Link(p[A3], -0.5 * M_PI, p[D4])
    links[4] = Link(0.0, 0.5 * M_PI, 0.0)
    links[5] = Link(0.0, -0.5 * M_PI, 0.0)


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef Link links[LINKS]
    cdef double r[9]
    cdef int i
    links_of(kins, links)
    chain(links, joints, r, pose)
    for i in range(3):
        pose[i] += kins.parameter[D6] * r[3 * i + 2]
    attitude_of_matrix(r, pose)
    return 0


cdef int arm(const Kinematics* kins, const double* wrist, int left, int down, double* joints) noexcept nogil:
    """Joints 0 to 2 (degrees) that bring the wrist to its place; -1 where this kind of arm cannot."""
    cdef const double* p = kins.parameter
    cdef double out = wrist[0] * wrist[0] + wrist[1] * wrist[1] - p[D3] * p[D3]
    cdef double size2 = p[A3] * p[A3] + p[D4] * p[D4]
    cdef double k, turn, elbow, along, both, reach2, bend
    if out < 0.0:
        return -1
    out = -sqrt(out) if left else sqrt(out)
    turn = atan2(wrist[1], wrist[0]) - atan2(p[D3], out)
    k = (out * out + wrist[2] * wrist[2] - p[A2] * p[A2] - size2) / (2.0 * p[A2])
    bend = size2 - k * k
    if bend < 0.0:
        return -1
    elbow = atan2(p[A3], p[D4]) - atan2(k, -sqrt(bend) if down else sqrt(bend))
    along = p[A3] + p[A2] * cos(elbow)
    reach2 = wrist[2] * wrist[2] + out * out
    if reach2 == 0.0:
        return -1
    both = p[A2] * sin(elbow) - p[D4]
    joints[0] = turn / DEGREE
    joints[2] = elbow / DEGREE
    joints[1] = atan2(-along * wrist[2] + out * both, both * wrist[2] + out * along) / DEGREE - joints[2]
    return 0


cdef void wrist_angles(const Kinematics* kins, const double* r, int over, double keep, double* joints) noexcept nogil:
    """Joints 3 to 5 that give the attitude ``r`` behind joints 0 to 2; where they are on one line, joint 3 stays."""
    cdef Link links[LINKS]
    cdef double f[9]
    cdef double p[3]
    cdef double m[9]
    cdef double sine
    cdef int i, k
    links_of(kins, links)
    for i in range(9):
        f[i] = i % 4 == 0
    for i in range(3):
        p[i] = 0.0
    for i in range(3):
        frame_times_link(f, p, &links[i], joints[i])
    for i in range(3):
        for k in range(3):
            m[3 * i + k] = f[i] * r[k] + f[3 + i] * r[3 + k] + f[6 + i] * r[6 + k]
    sine = hypot(m[2], m[8])
    if sine < STRETCHED:
        joints[3] = keep
        joints[4] = atan2(0.0, m[5]) / DEGREE
        joints[5] = atan2(-m[1], m[0]) / DEGREE - (keep if m[5] > 0.0 else -keep)
        return
    joints[3] = (atan2(-m[8], m[2]) if over else atan2(m[8], -m[2])) / DEGREE
    joints[4] = atan2(-sine if over else sine, m[5]) / DEGREE
    joints[5] = (atan2(m[4], -m[3]) if over else atan2(-m[4], m[3])) / DEGREE


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double r[9]
    cdef double wrist[3]
    cdef double found[LINKS]
    cdef double best[LINKS]
    cdef double way, shortest = FAR
    cdef int kind, i
    attitude_matrix(pose, r)
    for i in range(3):
        wrist[i] = pose[i] - kins.parameter[D6] * r[3 * i + 2]
    for kind in range(8):
        if arm(kins, wrist, kind & 1, kind & 2, found) != 0:
            continue
        wrist_angles(kins, r, kind & 4, joints[3], found)
        way = 0.0
        for i in range(LINKS):
            found[i] = nearest_turn(found[i], joints[i])
            way += fabs(found[i] - joints[i])
        if way < shortest:
            shortest = way
            best = found
    if shortest == FAR:
        return -1
    for i in range(LINKS):
        joints[i] = best[i]
    return 0


def create(coordinates: str | None = None, sparm: str = "") -> KinematicsModule:
    cdef KinematicsModule module = KinematicsModule("pumakins", LINKS, PARAMETERS)
    module.offer_switchable(forward, inverse, joint_letters("pumakins", coordinates, "xyzabc", LINKS), sparm)
    return module


def load(host, args: dict) -> None:
    check_arguments("pumakins", args, ("coordinates", "sparm"))
    provide(host, create(**args))
