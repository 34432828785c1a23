"""The common part of all kinematics modules: how they are handed to motion, and a Python door for tests and tools.

A kinematics file makes one ``KinematicsModule``, fills in its ``kins`` structure, and calls ``provide`` from its
``load(host, args)``. Motion gets the object by ``host.require("kinematics")`` and works with ``address`` only.
"""

from libc.math cimport isfinite
from libc.stdint cimport uintptr_t

from nml.errors import HalError

AXIS_LETTERS = "xyzabcuvw"


cdef class KinematicsModule:
    """One loaded kinematics; the memory that ``address`` names lives as long as this object."""

    def __init__(self, str name, tuple parameter_names=(), tuple parameter_values=()):
        if len(parameter_names) > KINS_PARAMETERS:
            raise HalError(f"{name}: more than {KINS_PARAMETERS} parameters")
        self.name = name
        self.pin_addresses = []
        self.parameter_names = parameter_names
        self.kins.parameters = len(parameter_names)
        for index, value in enumerate(parameter_values):
            self.kins.parameter[index] = value
        for index in range(KINS_JOINTS):
            self.kins.axis_of_joint[index] = -1

    @property
    def address(self) -> int:
        """Where the C structure ``Kinematics`` is."""
        return <uintptr_t>&self.kins

    @property
    def parameter_address(self) -> int:
        """Where the doubles of the parameters are, in the order of ``parameter_names``."""
        return <uintptr_t>&self.kins.parameter[0]

    @property
    def type(self) -> int:
        return self.kins.type

    @property
    def joints(self) -> int:
        return self.kins.joints

    def fit(self, int joints) -> None:
        """Use no more than ``joints`` joints, where the kinematics is flexible."""
        if self.flexible and joints < self.kins.joints:
            self.kins.joints = joints

    def parameters(self) -> dict:
        return {name: self.kins.parameter[i] for i, name in enumerate(self.parameter_names)}

    def set_parameter(self, str name, double value) -> None:
        self.kins.parameter[self.parameter_names.index(name)] = value

    def forward(self, joints, guess=None) -> list:
        """The pose (nine coordinates) of ``joints``; ValueError where there is none."""
        cdef double j[16]
        cdef double pose[9]
        _fill(j, 16, joints)
        _fill(pose, 9, guess or ())
        if self.kins.forward == NULL or self.kins.forward(&self.kins, j, pose) != 0 or not _finite(pose, 9):
            raise ValueError(f"{self.name}: no forward solution for joints {list(joints)}")
        return [pose[i] for i in range(9)]

    def inverse(self, pose, near=None) -> list:
        """The joint positions of ``pose``, of several solutions that which joints ``near`` have; ValueError for none."""
        cdef double j[16]
        cdef double p[9]
        _fill(p, 9, pose)
        _fill(j, 16, near or ())
        if self.kins.inverse(&self.kins, j, p) != 0 or not _finite(j, self.kins.joints):
            raise ValueError(f"{self.name}: no inverse solution for pose {list(pose)}")
        return [j[i] for i in range(self.kins.joints)]


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


def refuse_arguments(name: str, args: dict) -> None:
    """For a kinematics that takes no arguments."""
    if args:
        raise HalError(f"{name}: unknown argument {', '.join(sorted(args))}; it takes none")


def provide(host, module: KinematicsModule) -> None:
    """Register ``module`` with the realtime host, with one HAL pin for each of its parameters."""
    from hal import HAL_FLOAT, HAL_IN  # here, so that the library itself needs no HAL

    comp = host.component(module.name)
    for name, value in module.parameters().items():
        module.pin_addresses.append(comp.pin(f"{module.name}.{name}", HAL_FLOAT, HAL_IN, value=value).address)
    comp.keep(module)
    host.provide("kinematics", module)
    comp.ready()
