"""The realtime module xyzbc-trt-kins; the geometry is in ``tablekins.pyx``."""

from typing import Any

from emcmot.kins.kinematics import KinematicsModule, check_arguments, provide
from emcmot.kins.tablekins import create as create_table


def create(coordinates: str | None = None, sparm: str = "") -> KinematicsModule:
    """A mill with a rotary table upon a table that tilts about b."""
    return create_table("b", coordinates, sparm)


def load(host: Any, args: dict[str, str]) -> None:
    """``loadrt xyzbc-trt-kins [coordinates=] [sparm=identityfirst]``."""
    check_arguments("xyzbc-trt-kins", args, ("coordinates", "sparm"))
    provide(host, create(**args))
