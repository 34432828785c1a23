"""How the client classes reach a machine: NML channels of the client process, and what goes wrong with them."""

from __future__ import annotations

import sys
from operator import attrgetter
from typing import Any

from nml.channel import Channel
from nml.errors import ConfigError, NmlError

PROCESS = "xemc"  # the process line of clients in NML files

_pose_parts = attrgetter("tran.x", "tran.y", "tran.z", "a", "b", "c", "u", "v", "w")


class error(Exception):
    """What this module raises: no machine is there, or it does not answer."""


error.__module__ = "linuxcnc"


def open_channel(buffer: str) -> Channel:
    """The channel to ``buffer`` through the NML file that ``linuxcnc.nmlfile`` names."""
    try:
        return Channel(sys.modules["linuxcnc"].nmlfile, buffer, PROCESS)
    except (NmlError, ConfigError, OSError) as reason:
        raise error(f"{buffer}: no connection: {reason}") from reason


def pose_tuple(pose: Any) -> tuple[float, ...]:
    """An EmcPose as the nine numbers x y z a b c u v w."""
    return _pose_parts(pose)
