"""Types of the geometry canon: see geometry.pyx."""

from collections.abc import Callable
from typing import Any

from rs274ngc.canon import Canon

RAPID: int
FEED: int
ARC: int
PROBE: int
ROW: Any

class GeometryCanon(Canon):
    count: int
    tools_used: list[int]
    dwell_time: float
    axis_mask: int
    moves: Any
    lines: Any
    kinds: Any
    feeds: Any
    def __init__(
        self,
        chord_error: float = 0.01,
        on_rows: Callable[[Any], None] | None = None,
        piece: int = 1 << 16,
        **machine: Any,
    ) -> None: ...
    def hand_on(self) -> None: ...
    def table(self) -> Any: ...
