"""The common part of all kinematics modules: how they are handed to motion, and a Python door for tests and tools.

A kinematics file makes one ``KinematicsModule``, offers its two functions, and calls ``provide`` from its
``load(host, args)``. Motion gets the object by ``host.require("kinematics")`` and works with ``address`` only.
"""

from libc.math cimport isfinite
from libc.stdint cimport uintptr_t

from typing import NamedTuple

from emcmot.layout import same_size
from nml.errors import HalError

same_size(__name__, "Kinematics", sizeof(Kinematics))

AXIS_LETTERS = "xyzabcuvw"
IDENTITY_FIRST = "identityfirst"


class Value(NamedTuple):
    """A parameter or an output of a kinematics, with its HAL type and direction (``PARAM``: no pin but a parameter)."""

    name: str
    value: float = 0.0
    type: str = "float"
    direction: str = "IN"


class Binding(NamedTuple):
    """A HAL cell and the double that it is read into or shows."""

    cell: int
    at: int
    type: str
    direction: str


cdef int select_way(Kinematics* kins, int way) noexcept nogil:
    cdef int n
    if not 0 <= way < kins.ways:
        return -1
    kins.way = way
    kins.forward = kins.offered[way].forward
    kins.inverse = kins.offered[way].inverse
    kins.linear = kins.offered[way].linear
    for n in range(KINS_JOINTS):
        kins.axis_of_joint[n] = kins.offered[way].axis_of_joint[n]
    for n in range(KINS_WAYS):
        kins.selected[n] = n == way
    return 0


cdef int identity_forward(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    """Each joint is the axis that its letter says; the first joint of a letter has the last word."""
    cdef int i
    for i in range(kins.joints - 1, -1, -1):
        pose[kins.letter_of_joint[i]] = joints[i]
    return 0


cdef int identity_inverse(const Kinematics* kins, double* joints, double* pose) noexcept nogil:
    cdef int i
    for i in range(kins.joints):
        joints[i] = pose[kins.letter_of_joint[i]]
    return 0


cdef class KinematicsModule:
    """One loaded kinematics; the memory that ``address`` names lives as long as this object.

    ``parameters`` and ``outputs`` are rows of ``Value``; their pins are named after the module.
    """

    def __init__(self, str name, int joints, parameters=(), outputs=()):
        self.name = name
        self.bindings = []
        parameters = tuple(Value(*row) for row in parameters)
        outputs = tuple(Value(*row) for row in outputs)
        if len(parameters) > KINS_PARAMETERS or len(outputs) > KINS_OUTPUTS:
            raise HalError(f"{name}: more than {KINS_PARAMETERS} parameters or {KINS_OUTPUTS} outputs")
        self.pins = parameters + outputs
        self.parameter_names = tuple(row.name for row in parameters)
        self.kins.type = KINEMATICS_BOTH
        self.kins.joints = joints
        self.kins.parameters = len(parameters)
        self.kins.output = self.outputs
        for index, row in enumerate(parameters):
            self.kins.parameter[index] = row.value

    cdef offer(self, KinsFunction forward, KinsFunction inverse, axes=None, bint linear=False):
        """Add a way to compute; the first is in use at first. ``axes``: joint -> axis where a joint is one axis."""
        cdef KinsWay* way = &self.kins.offered[self.kins.ways]
        way.forward = forward
        way.inverse = inverse
        way.linear = linear
        for joint in range(KINS_JOINTS):
            way.axis_of_joint[joint] = (axes or {}).get(joint, -1)
        self.kins.ways += 1
        select_way(&self.kins, 0)

    cdef set_letters(self, letters):
        """Name the axis of each joint, for the identity and for kinematics that are made of named slides."""
        for joint, letter in enumerate(letters):
            self.kins.letter_of_joint[joint] = AXIS_LETTERS.index(letter)

    cdef offer_switchable(self, KinsFunction forward, KinsFunction inverse, str coordinates, str sparm, axes=None):
        """Offer a kinematics as type 0, the identity of ``coordinates`` as 1 and 2; ``sparm`` may swap 0 and 1."""
        cdef int way
        letters = {joint: AXIS_LETTERS.index(letter) for joint, letter in enumerate(coordinates)}
        self.set_letters(coordinates)
        if sparm not in ("", IDENTITY_FIRST):
            raise HalError(f"{self.name}: sparm={sparm}: only {IDENTITY_FIRST} is known")
        for way in range(KINS_WAYS):
            if way == (sparm == IDENTITY_FIRST):
                self.offer(forward, inverse, axes)
            else:
                self.offer(identity_forward, identity_inverse, letters, linear=True)

    @property
    def address(self) -> int:
        """Where the C structure ``Kinematics`` is."""
        return <uintptr_t>&self.kins

    @property
    def type(self) -> int:
        return self.kins.type

    @property
    def joints(self) -> int:
        return self.kins.joints

    @property
    def ways(self) -> int:
        return self.kins.ways

    def fit(self, int joints) -> None:
        """Use no more than ``joints`` joints, where the kinematics works with fewer."""
        if self.fewest_joints and joints < self.kins.joints:
            self.kins.joints = max(joints, self.fewest_joints)

    def select(self, int way) -> None:
        """Compute this way from now on; ValueError where there is no such way."""
        if select_way(&self.kins, way) != 0:
            raise ValueError(f"{self.name}: there is no kinematics type {way}, it has {self.kins.ways}")

    def parameter_values(self) -> dict:
        return {name: self.kins.parameter[i] for i, name in enumerate(self.parameter_names)}

    def output_values(self) -> dict:
        rows = self.pins[len(self.parameter_names):]
        return {row.name: self.outputs[i] for i, row in enumerate(rows)}

    def set_parameter(self, str name, double value) -> None:
        self.kins.parameter[self.parameter_names.index(name)] = value

    def forward(self, joints, guess=None) -> list:
        """The pose (nine coordinates) of ``joints``; ValueError where there is none."""
        cdef double j[KINS_JOINTS]
        cdef double pose[KINS_AXES]
        _fill(j, KINS_JOINTS, joints)
        _fill(pose, KINS_AXES, guess or ())
        if self.kins.forward == NULL or self.kins.forward(&self.kins, j, pose) != 0 or not _finite(pose, KINS_AXES):
            raise ValueError(f"{self.name}: no forward solution for joints {list(joints)}")
        return [pose[i] for i in range(KINS_AXES)]

    def inverse(self, pose, near=None) -> list:
        """The joint positions of ``pose``, of several solutions the one nearest to ``near``; ValueError for none."""
        cdef double j[KINS_JOINTS]
        cdef double p[KINS_AXES]
        _fill(p, KINS_AXES, pose)
        _fill(j, KINS_JOINTS, near or ())
        if self.kins.inverse(&self.kins, j, p) != 0 or not _finite(j, self.kins.joints):
            raise ValueError(f"{self.name}: no inverse solution for pose {list(pose)}")
        return [j[i] for i in range(self.kins.joints)]

    def connect(self, comp) -> None:
        """Make the HAL pins, and remember which double each is bound to."""
        # here, because the library needs no HAL
        from hal import HAL_BIT, HAL_FLOAT, HAL_IN, HAL_IO, HAL_OUT, HAL_RO, HAL_RW, HAL_S32, HAL_U32

        types = {"float": HAL_FLOAT, "bit": HAL_BIT, "s32": HAL_S32, "u32": HAL_U32}
        directions = {"IN": HAL_IN, "OUT": HAL_OUT, "IO": HAL_IO}
        for index, row in enumerate(self.pins):
            name = row.name if row.name.startswith("skgui.") else f"{self.name}.{row.name}"
            value = row.value if row.type == "float" else int(row.value)
            if row.direction == "PARAM":
                access = HAL_RW if index < self.kins.parameters else HAL_RO
                made = comp.param(name, types[row.type], access, value=value)
            else:
                made = comp.pin(name, types[row.type], directions[row.direction], value=value)
            if index < self.kins.parameters:
                self.bindings.append(Binding(made.address, <uintptr_t>&self.kins.parameter[index], row.type, "IN"))
            else:
                at = <uintptr_t>&self.outputs[index - self.kins.parameters]
                self.bindings.append(Binding(made.address, at, row.type, "OUT"))
        if self.kins.ways > 1:
            for way in range(self.kins.ways):
                made = comp.pin(f"kinstype.is-{way}", HAL_BIT, HAL_OUT, value=way == 0)
                self.bindings.append(Binding(made.address, <uintptr_t>&self.kins.selected[way], "bit", "OUT"))


cdef _fill(double* to, int size, values):
    cdef int i
    values = list(values)
    for i in range(size):
        to[i] = values[i] if i < len(values) else 0.0


cdef bint _finite(const double* values, int size) noexcept nogil:
    cdef int i
    for i in range(size):
        if not isfinite(values[i]):
            return False
    return True


def joint_letters(
    name: str, coordinates: str | None, standard: str, joints: int = KINS_JOINTS, *, repeats: bool = False
) -> str:
    """The letters of the joints that ``coordinates=`` gives, lower case; HalError for letters that do not fit.

    ``standard``: those without the argument; each of them must be there.
    """
    letters = (coordinates or standard).replace(" ", "").lower()
    unknown = sorted(set(letters) - set(AXIS_LETTERS))
    if unknown or not letters or len(letters) > joints:
        raise HalError(f"{name}: coordinates={coordinates}: 1 to {joints} letters of {AXIS_LETTERS} are allowed")
    if not repeats and len(set(letters)) != len(letters):
        raise HalError(f"{name}: coordinates={coordinates}: no letter may come twice")
    missing = sorted(set(standard) - set(letters)) if coordinates else []
    if missing:
        raise HalError(f"{name}: coordinates={coordinates}: {', '.join(missing)} is missing")
    return letters


def check_arguments(name: str, args: dict, known: tuple = ()) -> None:
    """HalError for an argument that this kinematics does not take."""
    unknown = sorted(set(args) - set(known))
    if unknown:
        takes = f"known: {', '.join(known)}" if known else "it takes none"
        raise HalError(f"{name}: unknown argument {', '.join(unknown)}; {takes}")


def provide(host, module: KinematicsModule, add=None) -> None:
    """Register ``module`` with the realtime host, with its HAL pins and what ``add`` gives the component besides."""
    comp = host.component(module.name)
    module.connect(comp)
    if add is not None:
        add(comp)
    comp.keep(module)
    host.provide("kinematics", module)
    comp.ready()
