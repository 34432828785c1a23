"""How far commanded positions are from the moves of their program: the forecast's worst path error.

Geometry only, apart from the planner: every position is measured against the moves about the one that it was reported
with. Moves without a tolerance (G64 without P), and blends with them, have no error to speak of and are left out.
Distances are in xyz, plus the rotary and uvw axes, a degree counting as one length unit. Used by ``emcmot.forecast``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Arc = tuple[tuple[float, ...], tuple[float, ...], int]  # center, normal, turns
Shape = tuple[tuple[float, ...], Arc | None, bool]  # end, what makes it an arc, and whether its path is bounded

NEIGHBOURS = 12  # moves before and after the reported one: blends and merged moves reach across some
SHORTEST = 1e-30


def path_error(
    moves: Sequence[Shape], start: Sequence[float], positions: Array, ids: NDArray[np.int64]
) -> float | None:
    """Largest distance of the positions from the path of the moves; `ids` names the move of each, from 1, 0: none.

    None where no move has a bounded path.
    """
    if not moves or not np.any(ids):
        return 0.0
    ends = np.array([start, *(move[0] for move in moves)], dtype=float)
    arcs = {k: shape for k, (_, shape, _) in enumerate(moves) if shape is not None}
    bounded = np.array([move[2] for move in moves])
    bounded[1:] &= bounded[:-1].copy()  # the blend with the move before is half its own
    moving = (ids > 0) & bounded[np.maximum(ids - 1, 0)]
    if not np.any(moving):
        return None
    points, reported = positions[moving], ids[moving] - 1
    best = np.full(len(points), math.inf)
    for offset in range(-NEIGHBOURS, NEIGHBOURS + 1):
        move = np.clip(reported + offset, 0, len(moves) - 1)
        distance = to_lines(points, ends[move], ends[move + 1])
        for k in np.intersect1d(move, list(arcs)):
            chosen = move == k
            distance[chosen] = to_arc(points[chosen], ends[k], ends[k + 1], arcs[k])
        best = np.minimum(best, distance)
    return float(best.max())


def to_lines(points: Array, starts: Array, ends: Array) -> Array:
    """Distance of each point from its own straight move."""
    way = ends - starts
    share = np.einsum("ij,ij->i", points - starts, way) / np.maximum(np.einsum("ij,ij->i", way, way), SHORTEST)
    return np.linalg.norm(points - starts - np.clip(share, 0.0, 1.0)[:, None] * way, axis=1)


def to_arc(points: Array, start: Array, end: Array, arc: Arc) -> Array:
    """Distance of the points from the place of an arc, helix or spiral in their direction from its axis."""
    center, normal, turn = np.array(arc[0]), np.array(arc[1]) / np.linalg.norm(arc[1]), arc[2]

    def flat(q: Array) -> tuple[Array, Array]:
        height = (q[..., :3] - center) @ normal
        return q[..., :3] - center - height[..., None] * normal, height

    (first, low), (last, high), (radial, _) = flat(start), flat(end), flat(points)
    radius = float(np.linalg.norm(first))
    along = first / radius
    across = np.cross(normal, along)
    total = swept(math.atan2(last @ across, last @ along), turn)
    angle = np.arctan2(radial @ across, radial @ along)
    turns = np.arange(-abs(turn) - 2, abs(turn) + 3) * 2.0 * math.pi
    best = np.full(len(points), math.inf)
    for whole in turns:
        share = np.clip((angle + whole) / total, 0.0, 1.0)[:, None]
        size = radius + share * (np.linalg.norm(last) - radius)
        place = start + share * (end - start)
        place[:, :3] = center + size * (np.cos(share * total) * along + np.sin(share * total) * across)
        place[:, :3] += (low + share * (high - low)) * normal
        best = np.minimum(best, np.linalg.norm(points - place, axis=1))
    return best


def swept(angle: float, turn: int) -> float:
    """Angle of an arc whose end lies at `angle` from its start: turn >= 0 counter-clockwise plus whole turns."""
    if turn < 0:
        return -swept(-angle, -turn - 1)
    angle %= 2.0 * math.pi
    return (angle if angle > 1e-7 else 2.0 * math.pi) + 2.0 * math.pi * turn
