"""Types of pentakins; the texts are in ``pentakins.pyx``."""

from typing import Any

from emcmot.kins.kinematics import KinematicsModule

def create() -> KinematicsModule: ...
def load(host: Any, args: dict[str, str]) -> None: ...
