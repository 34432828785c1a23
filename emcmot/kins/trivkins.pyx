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
    KinematicsModule,
    identity_forward,
    identity_inverse,
)

from emcmot.kins.kinematics import AXIS_LETTERS, check_arguments, joint_letters, provide
from nml.errors import HalError

TYPES = {
    "1": KINEMATICS_IDENTITY,
    "f": KINEMATICS_FORWARD_ONLY,
    "i": KINEMATICS_INVERSE_ONLY,
    "b": KINEMATICS_BOTH,
}


def create(coordinates: str | None = None, kinstype: str = "1") -> KinematicsModule:
    """The kinematics of these coordinates; HalError for letters that are no axes."""
    letters = joint_letters("trivkins", coordinates, "", repeats=True) if coordinates else AXIS_LETTERS
    cdef KinematicsModule module = KinematicsModule("trivkins", len(letters))
    kind = TYPES.get(kinstype[:1].lower())
    if kind is None:
        raise HalError(f"trivkins: kinstype={kinstype}: 1, forward, inverse or both are allowed")
    module.kins.type = kind
    module.fewest_joints = 0 if coordinates else 1
    module.set_letters(letters)
    axes = {joint: AXIS_LETTERS.index(letter) for joint, letter in enumerate(letters)}
    module.offer(identity_forward, identity_inverse, axes, linear=True)
    return module


def load(host, args: dict) -> None:
    check_arguments("trivkins", args, ("coordinates", "kinstype"))
    provide(host, create(**args))
