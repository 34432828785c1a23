"""Trivial kinematics: every joint is one axis. ``coordinates=`` gives the axis letter of each joint in order.

Without it, as many joints as the machine has are x y z a b c u v w. A letter may come several times: these joints move
together (a gantry), and the first of them gives the axis position.
``kinstype=`` is 1 or identity (the default), f or forward, i or inverse, b or both: what motion believes of it.
"""

from emcmot.kins.kinematics cimport (
    KINEMATICS_BOTH,
    KINEMATICS_FORWARD_ONLY,
    KINEMATICS_IDENTITY,
    KINEMATICS_INVERSE_ONLY,
    Kinematics,
    KinematicsModule,
)

from emcmot.kins.kinematics import AXIS_LETTERS, provide
from nml.errors import HalError

TYPES = {
    "1": KINEMATICS_IDENTITY,
    "f": KINEMATICS_FORWARD_ONLY,
    "i": KINEMATICS_INVERSE_ONLY,
    "b": KINEMATICS_BOTH,
}
ARGUMENTS = ("coordinates", "kinstype")


cdef int forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef int i
    for i in range(kins.joints - 1, -1, -1):  # the first joint of a letter has the last word
        pose[kins.axis_of_joint[i]] = joints[i]
    return 0


cdef int inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef int i
    for i in range(kins.joints):
        joints[i] = pose[kins.axis_of_joint[i]]
    return 0


def create(coordinates: str | None = None, kinstype: str = "1") -> KinematicsModule:
    """The kinematics of these coordinates; HalError for letters that are no axes."""
    cdef KinematicsModule module = KinematicsModule("trivkins")
    letters = (coordinates or AXIS_LETTERS).replace(" ", "").lower()
    module.flexible = coordinates is None
    unknown = sorted(set(letters) - set(AXIS_LETTERS))
    if unknown or not 1 <= len(letters) <= 16:
        raise HalError(f"trivkins: coordinates={coordinates}: 1 to 16 letters of {AXIS_LETTERS} are allowed")
    kind = TYPES.get(kinstype[:1].lower())
    if kind is None:
        raise HalError(f"trivkins: kinstype={kinstype}: 1, forward, inverse or both are allowed")
    module.kins.type = kind
    module.kins.linear = 1
    module.kins.joints = len(letters)
    for index, letter in enumerate(letters):
        module.kins.axis_of_joint[index] = AXIS_LETTERS.index(letter)
    module.kins.forward = forward
    module.kins.inverse = inverse
    return module


def load(host, args: dict) -> None:
    unknown = set(args) - set(ARGUMENTS)
    if unknown:
        raise HalError(f"trivkins: unknown argument {', '.join(sorted(unknown))}; known: {', '.join(ARGUMENTS)}")
    provide(host, create(**args))
