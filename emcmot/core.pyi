"""Types of the motion core; the texts are in ``core.pyx``."""

from typing import NamedTuple

from emcmot.kins.kinematics import KinematicsModule
from emcmot.modules import HomingModule, PlannerModule

LIMITS: dict[str, tuple[int, int, int]]

class Pin(NamedTuple):
    name: str
    type: str
    direction: str
    address: int

class Core:
    kinematics: KinematicsModule
    pins: list[Pin]
    def __init__(
        self,
        kinematics: KinematicsModule,
        servo_period: float = 0.001,
        planner: PlannerModule | None = None,
        homing: HomingModule | None = None,
        **numbers: int,
    ) -> None: ...
