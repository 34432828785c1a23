"""Types of userkins; the texts are in ``userkins.pyx``."""

from typing import Any

from emcmot.kins.kinematics import KinematicsModule

def create() -> KinematicsModule: ...
def load(host: Any, args: dict[str, str]) -> None: ...
