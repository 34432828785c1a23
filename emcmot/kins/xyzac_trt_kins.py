"""The realtime module xyzac-trt-kins; the geometry is in ``tablekins.pyx``."""

from typing import Any

from emcmot.kins.kinematics import KinematicsModule, check_arguments, provide
from emcmot.kins.tablekins import create as create_table


def create(coordinates: str | None = None, sparm: str = "") -> KinematicsModule:
    """A mill with a rotary table upon a table that tilts about a."""
    return create_table("a", coordinates, sparm)


def load(host: Any, args: dict[str, str]) -> None:
    """``loadrt xyzac-trt-kins [coordinates=] [sparm=identityfirst]``."""
    check_arguments("xyzac-trt-kins", args, ("coordinates", "sparm"))
    provide(host, create(**args))
