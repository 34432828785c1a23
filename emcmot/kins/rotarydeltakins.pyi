"""Types of rotarydeltakins; the texts are in ``rotarydeltakins.pyx``."""

from typing import Any

from emcmot.kins.kinematics import KinematicsModule

def create() -> KinematicsModule: ...
def load(host: Any, args: dict[str, str]) -> None: ...
