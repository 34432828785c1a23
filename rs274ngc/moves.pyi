"""Types of the compiled module ``moves.pyx``."""

from collections.abc import Sequence

from rs274ngc.canon import Canon
from rs274ngc.coords import Coordinates

TRAVERSE: int
FEED: int
ARC: int
TOOLCHANGE: int
PROBING: int
INDEXROTARY: int
STOP: int
BLEND: int
TANGENT: int
NURBS_STEPS: int

class MoveCanon(Canon):
    coords: Coordinates
    motion_mode: int
    term_cond: int
    tolerance: float
    naivecam_tolerance: float
    linear_feed: float
    angular_feed: float
    turn_feed: float
    synched: bool
    feed_mode: int
    feed_spindle: int
    indexer: int
    def __init__(self, length_units: float = 1.0, angle_units: float = 1.0) -> None: ...
    def set_limits(self, velocities: Sequence[float], accelerations: Sequence[float], axis_mask: int) -> None: ...
    def set_end(self, point: Sequence[float]) -> None: ...
    def chain_end(self) -> tuple[float, ...]: ...
    @property
    def end_point(self) -> tuple[float, ...]: ...
    def flush(self) -> None: ...
    def line(
        self, line: int, kind: int, x: float, y: float, z: float, a: float, b: float, c: float, u: float, v: float,
        w: float, vel: float, ini_maxvel: float, acc: float,
    ) -> None: ...  # fmt: skip
    def arc(
        self, line: int, x: float, y: float, z: float, a: float, b: float, c: float, u: float, v: float, w: float,
        cx: float, cy: float, cz: float, nx: float, ny: float, nz: float, turn: int, vel: float, ini_maxvel: float,
        acc: float,
    ) -> None: ...  # fmt: skip
    def probe(
        self, line: int, x: float, y: float, z: float, a: float, b: float, c: float, u: float, v: float, w: float,
        vel: float, ini_maxvel: float, acc: float, probe_type: int,
    ) -> None: ...  # fmt: skip
    def tap(
        self, line: int, x: float, y: float, z: float, a: float, b: float, c: float, u: float, v: float, w: float,
        vel: float, ini_maxvel: float, acc: float, scale: float,
    ) -> None: ...  # fmt: skip
