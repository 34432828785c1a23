"""The realtime module ``homemod``: this package's own homing, under LinuxCNC's name for its own.

motmod uses it also where no homing module was loaded.
"""

from __future__ import annotations

from emcmot.modules import HOMING
from hal.realtime import Host
from nml.errors import HalError


def load(host: Host, args: dict[str, str]) -> None:
    """``loadrt homemod``."""
    if args:
        raise HalError(f"homemod: unknown argument {next(iter(args))}; it has none")
    component = host.component("homemod")
    host.provide("homing", HOMING)
    component.ready()
