"""Types of matrixkins; the texts are in ``matrixkins.pyx``."""

from typing import Any

from emcmot.kins.kinematics import KinematicsModule

def create() -> KinematicsModule: ...
def load(host: Any, args: dict[str, str]) -> None: ...
