"""Types of the machine in memory: see offline.pyx."""

from collections.abc import Sequence
from typing import Any

from rs274ngc.canon import Canon, Tool

class OfflineCanon(Canon):
    length_units: float
    angle_units: float
    units: int
    plane: int
    control_mode: int
    axis_mask: int
    tolerance: float
    naivecam_tolerance: float
    feed: float
    tools: list[Tool]
    selected: int
    slot: int
    mist: bool
    flood: bool
    def __init__(
        self, length_units: float = ..., angle_units: float = 1.0, tools: Sequence[Tool] = (), **machine: Any
    ) -> None: ...
