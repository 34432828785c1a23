"""Types of the geometry canon: see geometry.pyx."""

from typing import Any

from rs274ngc.canon import Canon

RAPID: int
FEED: int
ARC: int
PROBE: int

class GeometryCanon(Canon):
    count: int
    tools_used: list[int]
    dwell_time: float
    moves: Any
    lines: Any
    kinds: Any
    feeds: Any
    def __init__(self, chord_error: float = 0.01, **machine: Any) -> None: ...
    def table(self) -> Any: ...
