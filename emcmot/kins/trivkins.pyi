"""Types of trivkins; the texts are in ``trivkins.pyx``."""

from typing import Any

from emcmot.kins.kinematics import KinematicsModule

def create(coordinates: str | None = None, kinstype: str = "1") -> KinematicsModule: ...
def load(host: Any, args: dict[str, str]) -> None: ...
