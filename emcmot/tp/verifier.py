"""Checks sampled positions against a programmed path: knows geometry and differences, nothing of the planner's code.

`Line` and `Arc` are the ideal curves of a program; `verify` takes the commanded position of every servo period and
returns the worst violations. Used by the planner's tests, the benchmarks and the forecast.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ARC_SAMPLES = 2001
POSITION_WINDOW = 500  # positions after the last match that are tried first, then twice as many, and so on
CHORD = 4e-3  # lu by which a polyline of positions may cut a curve
SURE = 1e-9  # lu beyond the tolerance, at which a position is taken for found


@dataclass
class Line:
    start: Array
    end: Array

    def distance(self, q: Array) -> float:
        """Distance of a point in xyz, or in all nine axes where the move has no xyz part."""
        delta = self.end - self.start
        square = float(delta @ delta)
        t = min(1.0, max(0.0, float((q - self.start) @ delta) / square)) if square > 0 else 0.0
        return float(np.linalg.norm(q - self.start - t * delta))


@dataclass
class Arc:
    """Helix or spiral about `normal`; positive angles turn counter-clockwise."""

    start: Array
    end: Array
    center: Array
    normal: Array
    turn: int
    samples: Array = field(init=False)

    def __post_init__(self) -> None:
        self.samples = self.points(np.linspace(0.0, 1.0, ARC_SAMPLES))

    def points(self, shares: Array) -> Array:
        """Positions at shares, 0 to 1, of the way."""
        n = self.normal / np.linalg.norm(self.normal)
        c = np.asarray(self.center, float)
        p0, p1 = self.start[:3] - c, self.end[:3] - c
        z0, z1 = p0 @ n, p1 @ n
        f0, f1 = p0 - z0 * n, p1 - z1 * n
        r0, r1 = np.linalg.norm(f0), np.linalg.norm(f1)
        e1 = f0 / r0
        e2 = np.cross(n, e1)
        angle = math.atan2(f1 @ e2, f1 @ e1)
        if self.turn >= 0:
            angle = angle % (2 * math.pi)
            angle = (2 * math.pi if angle < 1e-9 else angle) + 2 * math.pi * self.turn
        else:
            angle = -((-angle) % (2 * math.pi))
            angle = (-2 * math.pi if angle > -1e-9 else angle) + 2 * math.pi * (self.turn + 1)
        t = shares[:, None]
        out = self.start + t * (self.end - self.start)
        r = r0 + t * (r1 - r0)
        out[:, :3] = c + r * (np.cos(angle * t) * e1 + np.sin(angle * t) * e2) + (z0 + t * (z1 - z0)) * n
        return out

    def distance(self, q: Array) -> float:
        """Distance of a point, by fine chords about the nearest sample."""
        k = int(np.argmin(np.sum((self.samples - q) ** 2, axis=1)))
        first, last = max(0, k - 1), min(ARC_SAMPLES - 1, k + 1)
        fine = self.points(np.linspace(first, last, 101) / (ARC_SAMPLES - 1))
        j = int(np.argmin(np.sum((fine - q) ** 2, axis=1)))
        near = fine[max(0, j - 1) : j + 2]
        return min(Line(near[i], near[i + 1]).distance(q) for i in range(len(near) - 1))


@dataclass
class Report:
    seconds: float
    velocity: Array  # largest share of each axis's limit
    acceleration: Array
    deviation: float  # largest distance of a commanded position from the path
    corner: float  # largest distance of a programmed end point from the commanded path
    end: float  # distance of the last position from the last end point
    jerk: Array | None = None  # largest share of each axis's limit, where there are limits

    @property
    def worst_velocity(self) -> float:
        return float(self.velocity.max())

    @property
    def worst_acceleration(self) -> float:
        return float(self.acceleration.max())

    @property
    def worst_jerk(self) -> float:
        return 0.0 if self.jerk is None else float(self.jerk.max())


def differences(positions: Array, start: Array, dt: float) -> tuple[Array, Array]:
    """Velocity and acceleration of sampled positions, at rest before and after."""
    q = np.vstack([start, start, positions, positions[-1:], positions[-1:]])
    v = np.diff(q, axis=0) / dt
    return v, np.diff(v, axis=0) / dt


def path_deviation(positions: Array, path: list[Line | Arc], tolerance: float) -> float:
    """Largest distance of the positions, in their order, from the path.

    Paths cross themselves, so a position is looked for from where the one before was found, ahead and behind (a path
    may be run back), and further away only while it is nowhere within the tolerance.
    """
    worst, at = 0.0, 0
    for q in positions:
        best, best_index = math.inf, at
        for away in range(len(path)):
            for index in {at + away, at - away}:
                d = path[index].distance(q) if 0 <= index < len(path) else math.inf
                if d < best:
                    best, best_index = d, index
            if best <= tolerance + SURE:
                break
        at = best_index
        worst = max(worst, best)
    return worst


def corner_deviation(positions: Array, path: list[Line | Arc], tolerance: float) -> float:
    """Largest distance of the programmed end points, in their order, from the polyline of the positions."""
    worst, at = 0.0, 0
    for primitive in path:
        window = POSITION_WINDOW
        distance, k = point_deviation(positions[at : at + window], primitive.end)
        while distance > tolerance + CHORD and at + window < len(positions):
            window *= 2
            distance, k = point_deviation(positions[at : at + window], primitive.end)
        at += max(0, k - 1) if distance <= tolerance + CHORD else 0
        worst = max(worst, distance)
    return worst


def point_deviation(positions: Array, point: Array) -> tuple[float, int]:
    """Distance of a point from the polyline of the positions, and the index of the nearest of them."""
    d2 = np.sum((positions - point) ** 2, axis=1)
    k = int(np.argmin(d2))
    near = positions[max(0, k - 1) : k + 2]
    pieces = [Line(near[i], near[i + 1]).distance(point) for i in range(len(near) - 1)]
    return min([math.sqrt(d2[k]), *pieces]), k


def verify(
    positions: Array, path: list[Line | Arc], vmax: Array, amax: Array, dt: float, tolerance: float, stride: int = 1,
    jmax: Array | None = None,
) -> Report:  # fmt: skip
    """Worst violations of a whole run; only every `stride`-th position and end point are compared with the path."""
    v, a = differences(positions, path[0].start, dt)
    return Report(
        seconds=len(positions) * dt,
        velocity=np.abs(v).max(axis=0) / vmax,
        acceleration=np.abs(a).max(axis=0) / amax,
        deviation=path_deviation(positions[::stride], path, tolerance),
        corner=corner_deviation(positions, path[::stride], tolerance),
        end=float(np.linalg.norm(positions[-1] - path[-1].end)),
        jerk=None if jmax is None else np.abs(np.diff(a, axis=0, prepend=0.0 * a[:1])).max(axis=0) / dt / jmax,
    )
