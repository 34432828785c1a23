"""Types of corexykins; the texts are in ``corexykins.pyx``."""

from typing import Any

from emcmot.kins.kinematics import KinematicsModule

def create() -> KinematicsModule: ...
def load(host: Any, args: dict[str, str]) -> None: ...
