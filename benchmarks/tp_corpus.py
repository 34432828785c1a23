#!/usr/bin/env python3
"""The trajectory planner over a corpus: machining time beside the time-optimal bound, worst violations, and cost.

    python benchmarks/tp_corpus.py [--only NAME ...] [--no-verify] [--jerk MM_PER_S3]

The bound is a linear program over the squared path speed on the ideal curve (scipy), for the jobs that have one; it
knows nothing of the planner. A planner that uses its tolerance can be a little below it: the path gets shorter.
With a limit of jerk it is a row of linear programs, each about the speeds of the one before.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from emcmot.tp.planner import Planner
from emcmot.tp.verifier import Arc, Line, verify

Array = NDArray[np.float64]
DT = 0.001
VMAX = np.array([100.0] * 3 + [90.0] * 3 + [50.0] * 3)
AMAX = np.array([500.0] * 3 + [400.0] * 3 + [250.0] * 3)
CURVE_POINTS = 4001  # of the bound's grid
JERK_PROGRAMS = 10
CHECKED_POSITIONS = 2000  # positions of a job that are compared with its path; velocity and acceleration: all


@dataclass
class Job:
    """Moves (end point, or end point with center and turn for arcs), and the curve that they stand for."""

    name: str
    moves: list[tuple]
    tolerance: float
    feed: float = 100.0
    curve: Callable[[Array], Array] | None = None  # of [0, 1]
    path: list[Line | Arc] = field(default_factory=list)


def wavy(decimals: int) -> Job:
    """The curve of the acceptance figures."""

    def curve(t: Array) -> Array:
        r = 30 + 5 * np.sin(7 * t)
        return np.column_stack([r * np.cos(t), r * np.sin(t), -1 - 0.5 * np.sin(3 * t)])

    points = np.round(curve(0.002 * np.arange(1, 20001)), decimals)
    return Job(f"wavy curve, {decimals} decimals", [(p,) for p in points], 0.01, curve=lambda s: curve(40.0 * s))


def short_circle(decimals: int) -> Job:
    def curve(t: Array) -> Array:
        return np.column_stack([100 * np.cos(t), 100 * np.sin(t), 0 * t])

    points = np.round(curve(np.arange(0, 30001) * 2e-4), decimals)
    moves: list[tuple] = [(p,) for p in points[1:]]
    return Job(f"0.02 mm on r 100, {decimals} decimals", moves, 0.005, curve=lambda s: curve(6 * s))


def surface() -> Job:
    """A raster-milled wave, 0.2 mm steps."""

    def z(x: Array, y: float) -> Array:
        return 3 * np.sin(0.11 * x) * np.cos(0.07 * y) - 3

    moves = []
    for row in range(30):
        x = np.arange(0, 100.1, 0.2)
        x = x if row % 2 == 0 else x[::-1]
        moves += [(np.array([a, 0.5 * row, b]),) for a, b in zip(x, np.round(z(x, 0.5 * row), 3), strict=True)]
    return Job("surface raster", moves, 0.01)


def zigzag(pitch: float) -> Job:
    moves, x = [], 0.0
    for k in range(100):
        x = 20.0 - x
        moves += [(np.array([x, k * pitch, 0]),), (np.array([x, (k + 1) * pitch, 0]),)]
    return Job(f"zigzag, pitch {pitch}", moves, 0.01)


def pocket() -> Job:
    """Rectangles with rounded corners, outwards."""
    moves: list[tuple] = []
    for k in range(1, 15):
        w, r = 4.0 + 3 * k, min(3.0, 1.0 + 0.3 * k)
        corner = np.array([w, -w, -0.1])  # lower right; the others by turning
        for _ in range(4):
            along = np.array([-corner[1], corner[0], 0]) - [corner[0], corner[1], 0]
            along = along / np.linalg.norm(along)
            after = np.array([-along[1], along[0], 0])
            end = np.array([-corner[1], corner[0], -0.1])
            moves += [(corner + r * along,), (end - r * along,), (end + r * after, end - r * along + r * after, 0)]
            corner = end
    return Job("pocket, lines and arcs", moves, 0.01)


def trochoid() -> Job:
    def curve(s: Array) -> Array:
        t = 2 * math.pi * 40 * s
        return np.column_stack([0.12 * t + 2.5 * np.cos(t) - 2.5, 2.5 * np.sin(t), 0 * t])

    points = np.round(curve(np.arange(1, 4001) / 4000), 3)
    return Job("trochoid", [(p,) for p in points], 0.01, curve=curve)


def text() -> Job:
    """Short strokes with corners, like engraved letters."""
    random = np.random.default_rng(3)
    moves, at, lift, step = [], np.zeros(3), np.array([0, 0, 2.0]), np.array([1.5, 0, 0])
    for _ in range(150):
        for _ in range(5):
            at = at + np.append(random.uniform(-1.5, 1.5, 2), 0)
            moves.append((at,))
        moves.append((at + lift,))
        at = at + step
        moves += [(at + lift,), (at,)]
    return Job("engraved text", moves, 0.02)


def five_axis() -> Job:
    def curve(s: Array) -> Array:
        t = 2 * math.pi * 3 * s
        return np.column_stack(
            [40 * np.cos(t) - 40, 40 * np.sin(t), 5 * np.sin(2 * t), 20 * np.sin(t), 30 * np.sin(0.5 * t)]
        )

    points = np.round(curve(np.arange(1, 3001) / 3000), 4)
    return Job("five axes", [(p,) for p in points], 0.02, curve=curve)


def polyline() -> Job:
    random = np.random.default_rng(1)
    return Job("random polyline", [(random.uniform(-20, 20, 3),) for _ in range(300)], 0.05)


def needles() -> Job:
    moves = [(np.array([0.0, 10.0 * (k % 2), 0.001 * k]),) for k in range(1, 200)]
    return Job("needles", moves, 0.01)


CORPUS = [
    lambda: wavy(5), lambda: wavy(3), lambda: short_circle(6), lambda: short_circle(4), lambda: zigzag(0.5),
    lambda: zigzag(1.0), surface, pocket, trochoid, text, five_axis, polyline, needles,
]  # fmt: skip


def bound(job: Job, jerk: float = 0.0) -> float:
    """Least time on the ideal curve, from rest to rest; lead-ins as straight moves at rest."""
    from scipy.optimize import linprog
    from scipy.sparse import diags, vstack

    assert job.curve is not None
    n = CURVE_POINTS
    s = np.linspace(0, 1, n)
    q = job.curve(s)
    h = s[1] - s[0]
    axes = q.shape[1]
    d1 = np.gradient(q, h, axis=0, edge_order=2)
    d2 = np.gradient(d1, h, axis=0, edge_order=2)
    d3 = np.gradient(d2, h, axis=0, edge_order=2)
    speed = np.linalg.norm(d1[:, :3], axis=1)
    cap = np.minimum((job.feed / speed) ** 2, np.min((VMAX[:axes] / np.maximum(np.abs(d1), 1e-12)) ** 2, axis=1))
    cap[0] = cap[-1] = 0.0
    scale = cap.max()
    between = (0.5 * (d1[:-1] + d1[1:]), 0.5 * (d2[:-1] + d2[1:]))
    mean = diags([0.5, 0.5], [0, 1], shape=(n - 1, n))
    slope = diags([-0.5 / h, 0.5 / h], [0, 1], shape=(n - 1, n))
    rows = vstack([diags(between[0][:, a]) @ slope + diags(between[1][:, a]) @ mean for a in range(axes)])
    here = diags([1.0], [1], shape=(n - 2, n))
    first = diags([-0.5 / h, 0.5 / h], [0, 2], shape=(n - 2, n))
    second = diags([1 / h**2, -2 / h**2, 1 / h**2], [0, 1, 2], shape=(n - 2, n))
    inner = slice(1, -1)
    bends = vstack(
        [
            diags(d3[inner, a]) @ here + diags(1.5 * d2[inner, a]) @ first + diags(0.5 * d1[inner, a]) @ second
            for a in range(axes)
        ]
    )
    most = np.repeat(AMAX[:axes], n - 1) / scale
    matrix, limits, cost, best = vstack([rows, -rows]), np.tile(most, 2), -np.ones(n), math.inf
    for number in range(JERK_PROGRAMS if jerk else 1):
        box = np.column_stack([0 * cap, cap / scale])
        solved = linprog(cost, A_ub=matrix.tocsr(), b_ub=limits, bounds=box, method="highs-ipm")
        if solved.x is None:
            break
        w = np.maximum(solved.x, 0) * scale
        v = np.sqrt(w)
        seconds = float(np.sum(2 * h / np.maximum(v[1:] + v[:-1], 1e-9)))
        if number > 0 or not jerk:  # the first knows no jerk
            best = min(best, seconds)
        w = np.maximum(w, 1e-5 * scale)
        near = w[inner]
        leaning = vstack([diags(0.5 * jerk / near**1.5) @ here] * axes)
        matrix = vstack([rows, -rows, bends + leaning, leaning - bends])
        limits = np.concatenate([most, most, np.tile(1.5 * jerk / np.sqrt(near) / scale, 2 * axes)])
        cost = -1 / np.maximum(w / scale, 1e-4) ** 1.5
    return best + lead_in(q[0])


def lead_in(to: Array) -> float:
    """Rest to rest on the straight move from the origin."""
    length = float(np.linalg.norm(to[:3]))
    if length == 0.0:
        return 0.0
    t = np.abs(to) / length
    a = float(np.min(AMAX[: len(to)] / np.maximum(t, 1e-12)))
    v = float(np.min(VMAX[: len(to)] / np.maximum(t, 1e-12)))
    v = min(v, 100.0)
    return length / v + v / a if length > v * v / a else 2 * math.sqrt(length / a)


def run(job: Job, jerk: float = 0.0) -> tuple[Array, float, float]:
    """Positions, and seconds of processor time for adding and for the periods; `jerk` in mm/s^3, 0: no limit."""
    planner = Planner(DT)
    planner.limit_jerk(jerk > 0.0)
    for axis in range(9):
        planner.set_limits(axis, VMAX[axis], AMAX[axis], jerk)
    at = np.zeros(9)
    calls = []
    for number, move in enumerate(job.moves, 1):
        end = np.zeros(9)
        end[: len(move[0])] = move[0]
        if len(move) == 1:
            calls.append((planner.add_line, (end.tolist(), job.feed), number))
            job.path.append(Line(at, end))
        else:
            calls.append((planner.add_arc, (end.tolist(), move[1].tolist(), (0, 0, 1), move[2], job.feed), number))
            job.path.append(Arc(at, end, move[1], np.array([0.0, 0, 1]), move[2]))
        at = end
    parts, next_call, adding, stepping = [], 0, 0.0, 0.0
    while True:
        start = time.perf_counter()
        while next_call < len(calls):
            add, arguments, number = calls[next_call]
            if not add(*arguments, tolerance=job.tolerance, id=number):
                break
            next_call += 1
        middle = time.perf_counter()
        parts.append(planner.step_until_done(20))
        stepping += time.perf_counter() - middle
        adding += middle - start
        if next_call == len(calls) and len(parts[-1]) < 20:
            return np.concatenate(parts), adding, stepping


def main() -> None:
    options = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    options.add_argument("--only", nargs="*", default=[], help="names, or parts of them")
    options.add_argument("--jerk", type=float, default=0.0, help="limit of the third derivative, of each axis")
    options.add_argument("--no-verify", action="store_true", help="times and costs only")
    chosen = options.parse_args()
    table = Table(
        "job", "moves", "time s", "bound s", "of bound", "velocity", "acceleration", "jerk", "error / P",
        "us/period", "us/add",
    )  # fmt: skip
    for make in CORPUS:
        job = make()
        if chosen.only and not any(part in job.name for part in chosen.only):
            continue
        positions, adding, stepping = run(job, chosen.jerk)
        seconds = len(positions) * DT
        best = bound(job, chosen.jerk) if job.curve else 0.0
        checked = ["", "", "", ""]
        if not chosen.no_verify:
            stride = max(1, len(positions) // CHECKED_POSITIONS)
            jmax = np.full(9, chosen.jerk or math.inf)
            r = verify(positions, job.path, VMAX, AMAX, DT, job.tolerance, stride, jmax)
            worst = (r.worst_velocity, r.worst_acceleration, r.worst_jerk)
            checked = [*(f"{share:.6f}" for share in worst), f"{r.deviation / job.tolerance:.3f}"]
        compared = [f"{best:.3f}", f"{seconds / best:.3f}"] if best else ["", ""]
        table.add_row(
            job.name, str(len(job.moves)), f"{seconds:.3f}", *compared, *checked,
            f"{stepping / len(positions) * 1e6:.2f}", f"{adding / len(job.moves) * 1e6:.2f}",
        )  # fmt: skip
    Console(width=140).print(table)


if __name__ == "__main__":
    main()
