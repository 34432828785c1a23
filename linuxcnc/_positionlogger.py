"""``linuxcnc.positionlogger``: the path that the tool has taken, point by point, for screens that draw it.

``call`` draws it with OpenGL (``_drawing``), as AXIS wants it; other screens take ``points``.
"""

from __future__ import annotations

import math
import struct
import threading
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from linuxcnc._drawing import draw_track

if TYPE_CHECKING:
    from linuxcnc._stat import stat

SAME = 1e-9  # machine unit or degree, by which two points may differ and be one
STRAIGHT = 1e-6  # machine units that a point may be off the line of its neighbours and be left out
MOST_POINTS = 100_000  # the older half goes when there are more
FOAM_DEPTHS = (0.0, 1.5)  # Z and W of a foam cutter's two planes until set_depth
AXES = "XYZABCUVW"
DIRECTION = {"X": 0, "Y": 1, "Z": 2, "U": 0, "V": 1, "W": 2}  # of the picture, for each linear axis

ROW = struct.Struct("=3f4B3f4B")
"""A point as ``draw_track`` wants it: place, colour, second place, colour."""

Point = tuple[float, float, float, float, float, float]
Colour = tuple[int, int, int, int]


class positionlogger:
    """Logs the tool tip: x, y, z in machine units, and the rotations a, -b, c in degrees.

    The six colours (red, green, blue, alpha; 0 to 255) are those of jogs, rapids, feeds, arcs, tool changes and
    probing, in the order of MOTION_TYPE_*. ``geometry`` has the linear axes that make up the picture, as in
    [DISPLAY]GEOMETRY: U, V and W add to X, Y and Z, and a minus turns an axis round. With ``is_xyuv``, as for foam
    cutters, a point is x, y, the first depth, u, v, the second depth.
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
        self._parts = list(_parts(geometry))
        self._depths = FOAM_DEPTHS
        self._points: list[tuple[Point, Colour]] = []
        self._rows = bytearray(MOST_POINTS * ROW.size)
        self._drawn: Point | None = None
        self._lock = threading.Lock()
        self._over = threading.Event()
        self.set_colors(jog, traverse, feed, arc, toolchange, probing)

    @property
    def npts(self) -> int:
        """Number of points."""
        return len(self._points)

    @property
    def points(self) -> list[tuple[Point, Colour]]:
        """All points with the colours of the lines that lead to them; the inner points of a straight are left out."""
        with self._lock:
            return list(self._points)

    def set_colors(
        self, jog: Colour, traverse: Colour, feed: Colour, arc: Colour, toolchange: Colour, probing: Colour
    ) -> None:
        """Change the colours of the lines to come."""
        self._colours = (jog, traverse, feed, arc, toolchange, probing)

    def get_colors(self) -> tuple[Colour, ...]:
        """The six colours."""
        return self._colours

    def set_depth(self, z: float, w: float) -> None:
        """Set the depths of a foam cutter's two planes."""
        self._depths = (z, w)

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
            self._drawn = None

    def call(self) -> None:
        """Draw the path in the OpenGL context in force. ``linuxcnc.error`` where OpenGL is not installed."""
        with self._lock:
            count = len(self._points)
            draw_track(self._rows, count, self.is_xyuv)
            self._drawn = self._points[-1][0] if count else None

    def last(self, flag: int = 1) -> Point | None:
        """The newest point of the last drawing, of all with ``flag`` = 0; None when there is none."""
        with self._lock:
            if flag:
                return self._drawn
            return self._points[-1][0] if self._points else None

    def _log(self) -> None:
        """Add where the tool tip is, unless it is still there."""
        status = self._status
        tip = [at - offset for at, offset in zip(status.position, status.tool_offset, strict=True)]
        point = self._foam_point(tip) if self.is_xyuv else self._point(tip)
        kind = status.motion_type
        colour = self._colours[kind if kind < len(self._colours) else 0]
        with self._lock:
            points = self._points
            if points and _distance(point, points[-1][0]) < SAME:
                return
            if len(points) > 1 and points[-1][1] == colour and _straight(points[-2][0], points[-1][0], point):
                points.pop()
            elif len(points) == MOST_POINTS:
                del points[: MOST_POINTS // 2]
                self._rows[: len(points) * ROW.size] = self._rows[-len(points) * ROW.size :]
            ROW.pack_into(self._rows, len(points) * ROW.size, *point[:3], *colour, *point[3:], *colour)
            points.append((point, colour))

    def _point(self, tip: Sequence[float]) -> Point:
        picture = [0.0, 0.0, 0.0]
        for direction, axis, sign in self._parts:
            picture[direction] += sign * tip[axis]
        x, y, z = picture
        return (x, y, z, tip[3], -tip[4], tip[5])

    def _foam_point(self, tip: Sequence[float]) -> Point:
        return (tip[0], tip[1], self._depths[0], tip[6], tip[7], self._depths[1])


def _parts(geometry: str) -> Iterator[tuple[int, int, float]]:
    """Direction of the picture, axis and sign for each linear axis of a geometry."""
    sign = 1.0
    for letter in geometry.upper():
        if letter in DIRECTION:
            yield DIRECTION[letter], AXES.index(letter), sign
        sign = -1.0 if letter == "-" else 1.0


def _distance(one: Point, other: Point) -> float:
    return max(abs(a - b) for a, b in zip(one, other, strict=True))


def _straight(first: Point, middle: Point, last: Point) -> bool:
    """Whether ``middle`` lies on the way from ``first`` to ``last``."""
    way = [b - a for a, b in zip(first, last, strict=True)]
    part = [b - a for a, b in zip(first, middle, strict=True)]
    length = math.hypot(*way)
    along = sum(a * b for a, b in zip(part, way, strict=True)) / length if length else 0.0
    across = math.sqrt(max(0.0, sum(value * value for value in part) - along * along))
    return 0.0 <= along <= length and across < STRAIGHT
