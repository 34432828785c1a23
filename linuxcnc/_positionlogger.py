"""``linuxcnc.positionlogger``: the path that the tool has taken, point by point, for screens that draw it.

Under LinuxCNC it also draws, with OpenGL; here a screen takes ``points`` and draws them by its own means.
"""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from linuxcnc._connection import error

if TYPE_CHECKING:
    from linuxcnc._stat import stat

MM_PER_INCH = 25.4
SAME = 1e-9  # inch or degree, by which two points may differ and be one
MOST_POINTS = 100_000  # the older half goes when there are more

Point = tuple[float, float, float, float, float, float]
Colour = tuple[int, int, int, int]


class positionlogger:
    """Logs the tool tip: x, y, z in inches as LinuxCNC's plots have them, and a, b, c in degrees.

    The six colours (red, green, blue, alpha; 0 to 255) are those of jogs, rapids, feeds, arcs, tool changes and
    probing, in the order of MOTION_TYPE_*. ``geometry`` and ``is_xyuv`` say how a screen wants to draw; they are kept.
    """

    def __init__(
        self,
        status: stat,
        jog: Colour,
        traverse: Colour,
        feed: Colour,
        arc: Colour,
        toolchange: Colour,
        probing: Colour,
        geometry: str = "XYZ",
        is_xyuv: int = 0,
    ) -> None:
        self.geometry = geometry
        self.is_xyuv = bool(is_xyuv)
        self._status = status
        self._colours = (jog, traverse, feed, arc, toolchange, probing)
        self._points: list[tuple[Point, Colour]] = []
        self._lock = threading.Lock()
        self._over = threading.Event()

    @property
    def npts(self) -> int:
        """Number of points."""
        return len(self._points)

    @property
    def points(self) -> list[tuple[Point, Colour]]:
        """All points with the colours of the lines that lead to them."""
        with self._lock:
            return list(self._points)

    def start(self, interval: float) -> None:
        """Log every ``interval`` host seconds until ``stop``; give it a thread of its own."""
        self._over.clear()
        while not self._over.wait(interval):
            self._status.poll()
            self._log()

    def stop(self) -> None:
        """End ``start``."""
        self._over.set()

    def clear(self) -> None:
        """Forget all points."""
        with self._lock:
            self._points.clear()

    def call(self) -> None:
        """Refused: OpenGL is not part of this package."""
        raise error("positionlogger.call draws with OpenGL, which is not supported; draw positionlogger.points")

    def last(self, flag: int = 1) -> Point | None:
        """The newest point, None when there is none; there is no drawing that ``flag`` = 0 could refer to."""
        with self._lock:
            return self._points[-1][0] if self._points else None

    def _log(self) -> None:
        """Add where the tool tip is, unless it is still there."""
        status = self._status
        inches = 1.0 / (status.linear_units * MM_PER_INCH) if status.linear_units else 1.0
        degrees = 1.0 / status.angular_units if status.angular_units else 1.0
        tip = [at - offset for at, offset in zip(status.position[:6], status.tool_offset[:6], strict=True)]
        x, y, z = (value * inches for value in tip[:3])
        a, b, c = (value * degrees for value in tip[3:])
        point = (x, y, z, a, b, c)
        kind = status.motion_type
        colour = self._colours[kind if kind < len(self._colours) else 0]
        with self._lock:
            if self._points and max(abs(new - old) for new, old in zip(point, self._points[-1][0], strict=True)) < SAME:
                return
            self._points.append((point, colour))
            if len(self._points) > MOST_POINTS:
                del self._points[: MOST_POINTS // 2]
