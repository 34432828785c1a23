"""The realtime module xyzab_tdr_kins; the geometry is in ``tablekins.pyx``."""

from typing import Any

from emcmot.kins.kinematics import KinematicsModule, check_arguments, provide
from emcmot.kins.tablekins import create_dual


def create() -> KinematicsModule:
    """A mill with a table about x upon a table about y."""
    return create_dual()


def load(host: Any, args: dict[str, str]) -> None:
    """``loadrt xyzab_tdr_kins``."""
    check_arguments("xyzab_tdr_kins", args)
    provide(host, create())
