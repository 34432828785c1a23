"""Types of scarakins; the texts are in ``scarakins.pyx``."""

from typing import Any

from emcmot.kins.kinematics import KinematicsModule

def create(coordinates: str | None = None, sparm: str = "") -> KinematicsModule: ...
def load(host: Any, args: dict[str, str]) -> None: ...
