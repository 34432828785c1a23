"""An independent check of motion: sampled joint commands against the path that the program describes.

It knows nothing of the planner: a program is a list of straight segments (arcs given as fine chords by the test), and
the samples are what the motors were told in every servo period.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def distances_to_path(points: Array, path: Array) -> Array:
    """Distance of each point from a polyline, in the units of both; shapes (n, 3) and (m, 3)."""
    starts, vectors = path[:-1], np.diff(path, axis=0)
    lengths = np.einsum("ij,ij->i", vectors, vectors)
    best = np.full(len(points), np.inf)
    for start, vector, length in zip(starts, vectors, lengths, strict=True):
        offset = points - start
        along = np.clip(offset @ vector / length, 0.0, 1.0) if length > 0.0 else np.zeros(len(points))
        best = np.minimum(best, np.linalg.norm(offset - along[:, None] * vector, axis=1))
    return best


def path_error(points: Array, path: Array) -> float:
    """Largest distance of the sampled points from the path."""
    return float(distances_to_path(points, path).max())


def corner_errors(points: Array, path: Array) -> Array:
    """How close the samples come to each vertex of the path."""
    return np.array([np.linalg.norm(points - vertex, axis=1).min() for vertex in path])


def visits_in_order(points: Array, path: Array, tolerance: float) -> bool:
    """Whether the samples come within ``tolerance`` of every vertex, one after the other."""
    position = 0
    for vertex in path:
        near = np.flatnonzero(np.linalg.norm(points[position:] - vertex, axis=1) <= tolerance)
        if not len(near):
            return False
        position += int(near[0])
    return True


def limits_exceeded(positions: Array, period: float, velocity: Array, acceleration: Array) -> list[str]:
    """Where the commands of a joint exceed its limits: a text for each violation, none if all is well.

    Velocity and acceleration are differences of consecutive samples. A planner that computes its positions in floating
    point may exceed by rounding, so one part in a thousand is allowed.
    """
    found = []
    velocities = np.diff(positions, axis=0) / period
    accelerations = np.diff(velocities, axis=0) / period
    for name, values, limit in (("velocity", velocities, velocity), ("acceleration", accelerations, acceleration)):
        worst = np.abs(values).max(axis=0)
        for joint, (value, most) in enumerate(zip(worst, limit, strict=True)):
            if value > most * 1.001:
                at = int(np.abs(values[:, joint]).argmax())
                found.append(f"joint {joint}: {name} {value:.4f} in period {at}, limit {most:g}")
    return found


def arc(center: tuple[float, float], radius: float, start: float, sweep: float, z: tuple[float, float]) -> Array:
    """A helix about Z as chords of 0.2 degrees; angles in degrees, ``sweep`` positive counterclockwise."""
    count = max(2, round(abs(sweep) / 0.2) + 1)
    angles = np.radians(np.linspace(start, start + sweep, count))
    return np.column_stack(
        [center[0] + radius * np.cos(angles), center[1] + radius * np.sin(angles), np.linspace(*z, count)]
    )
