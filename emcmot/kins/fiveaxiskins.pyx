"""A five-axis bridge mill: the head turns about z (c) and tilts about y (b), w moves the tool. Loaded as ``5axiskins``.

``pivot-length`` is the distance from the head's pivot to the tool's tip at w 0; at b 0 the slides stand at the tip.
``coordinates=`` names the joints (standard XYZBCW); letters may come twice, and A, U, V are joints of their own.
Switchable to the identity.
"""

from libc.math cimport cos, sin

from emcmot.kins.frames cimport DEGREE
from emcmot.kins.kinematics cimport (
    KINS_AXES,
    KINS_JOINTS,
    Kinematics,
    KinematicsModule,
    identity_forward,
    identity_inverse,
)

from emcmot.kins.kinematics import AXIS_LETTERS, check_arguments, joint_letters, provide

cdef enum:
    PIVOT = 0            # parameter

STANDARD = "xyzbcw"
PARAMETERS = (("pivot-length", 250.0),)


cdef void pivot_from_tip(const Kinematics* kins, const double* pose, double* way) noexcept nogil:
    """How far the slides are from the tip: not at all while the tool hangs down and w is 0."""
    cdef double length = kins.parameter[PIVOT] + pose[8]
    cdef double aside = length * sin(pose[4] * DEGREE)
    way[0] = -aside * cos(pose[5] * DEGREE)
    way[1] = -aside * sin(pose[5] * DEGREE)
    way[2] = length * cos(pose[4] * DEGREE) - kins.parameter[PIVOT]


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double way[3]
    cdef int i
    identity_forward(kins, joints, pose)
    pivot_from_tip(kins, pose, way)
    for i in range(3):
        pose[i] -= way[i]
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef double slides[KINS_AXES]
    cdef double way[3]
    cdef int i
    pivot_from_tip(kins, pose, way)
    for i in range(KINS_AXES):
        slides[i] = pose[i] + (way[i] if i < 3 else 0.0)
    return identity_inverse(kins, joints, slides)


def create(coordinates: str | None = None, sparm: str = "") -> KinematicsModule:
    letters = joint_letters("5axiskins", coordinates, STANDARD, KINS_JOINTS, repeats=True)
    cdef KinematicsModule module = KinematicsModule("5axiskins", len(letters), PARAMETERS)
    axes = {joint: AXIS_LETTERS.index(letter) for joint, letter in enumerate(letters) if letter not in "xyz"}
    module.offer_switchable(forward, inverse, letters, sparm, axes)
    return module


def load(host, args: dict) -> None:
    check_arguments("5axiskins", args, ("coordinates", "sparm"))
    provide(host, create(**args))
