"""The realtime module ``tpmod``: this package's own trajectory planner, under LinuxCNC's name for its own.

motmod uses it also where no planner module was loaded.
"""

from __future__ import annotations

from emcmot.modules import PLANNER
from hal.realtime import Host
from nml.errors import HalError


def load(host: Host, args: dict[str, str]) -> None:
    """``loadrt tpmod``."""
    if args:
        raise HalError(f"tpmod: unknown argument {next(iter(args))}; it has none")
    component = host.component("tpmod")
    host.provide("planner", PLANNER)
    component.ready()
