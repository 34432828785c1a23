#!/usr/bin/env python3
"""Draws the pictures of docs/planner.md with the planner itself; needs matplotlib."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

import tp_cost  # noqa: E402

from emcmot.tp.planner import Planner  # noqa: E402

OUT = ROOT / "docs" / "pictures"
DT = 0.001


def planner(acceleration: float = 500.0, jerk: float = 0.0) -> Planner:
    made = Planner(DT, 4000)
    for axis in range(3):
        made.set_limits(axis, 100.0, acceleration, jerk)
    made.limit_jerk(jerk > 0.0)
    return made


def cut(points, tolerance: float, feed: float = 100.0, jerk: float = 0.0) -> np.ndarray:
    """Positions of a polyline."""
    made = planner(jerk=jerk)
    for number, point in enumerate(points, 1):
        made.add_line(point, feed, tolerance=tolerance, id=number)
    return made.run_to_end()


def corner() -> Figure:
    """One corner with three tolerances: the path, and the accelerations of both axes."""
    figure = Figure(figsize=(11, 4.5), layout="constrained")
    path, acceleration = figure.subplots(1, 2)
    for tolerance in (0.05, 0.2, 0.5):
        q = cut([(10, 0, 0), (10, 10, 0)], tolerance)
        path.plot(q[:, 0], q[:, 1], label=f"P = {tolerance} mm")
    path.plot([0, 10, 10], [0, 0, 10], "k:", linewidth=0.8)
    path.set(xlim=(7.5, 10.2), ylim=(-0.2, 2.5), aspect="equal", xlabel="x, mm", ylabel="y, mm")
    path.legend()
    a = np.diff(q[:, :2], 2, axis=0) / DT**2
    acceleration.plot(np.arange(len(a)) * DT, a, label=["x", "y"])
    acceleration.set(xlabel="time, s", ylabel="acceleration, mm/s²", title="P = 0.5 mm: each axis uses its own limit")
    acceleration.legend()
    return figure


def short_moves() -> Figure:
    """Rounded coordinates: the polyline, the path that is cut, and its speed."""
    angle = np.arange(0, 1.2, 0.0015)
    points = np.round(np.column_stack([20 * np.sin(angle), 20 - 20 * np.cos(angle), 0 * angle]), 2)
    q = cut(points[1:], 0.02)
    figure = Figure(figsize=(11, 4.5), layout="constrained")
    path, speed = figure.subplots(1, 2)
    path.plot(points[:, 0], points[:, 1], "k.-", linewidth=0.6, markersize=3, label="program, rounded to 0.01 mm")
    path.plot(q[:, 0], q[:, 1], label="cut, P = 0.02 mm")
    path.set(xlim=(8, 8.6), ylim=(1.65, 1.97), xlabel="x, mm", ylabel="y, mm")
    path.legend()
    v = np.linalg.norm(np.diff(q[:, :2], axis=0), axis=1) / DT
    speed.plot(np.arange(len(v)) * DT, v)
    speed.set(xlabel="time, s", ylabel="speed, mm/s", title="cut at 100 mm/s")
    return figure


def look_ahead() -> Figure:
    """Speed along a wavy curve, and the accelerations: always one axis at its limit."""
    t = 0.002 * np.arange(1, 2500)
    r = 30 + 5 * np.sin(7 * t)
    q = cut(np.column_stack([r * np.cos(t) - 30, r * np.sin(t), -0.5 * np.sin(3 * t)]), 0.01)
    v = np.diff(q[:, :3], axis=0) / DT
    a = np.diff(v, axis=0) / DT
    figure = Figure(figsize=(11, 6), layout="constrained")
    speed, acceleration = figure.subplots(2, 1, sharex=True)
    speed.plot(np.arange(len(v)) * DT, np.linalg.norm(v, axis=1))
    speed.set(ylabel="speed, mm/s")
    acceleration.plot(np.arange(len(a)) * DT, a, linewidth=0.8, label=["x", "y", "z"])
    acceleration.set(xlabel="time, s", ylabel="acceleration, mm/s²", ylim=(-520, 520))
    acceleration.legend(ncols=3)
    return figure


def jerk() -> Figure:
    """One corner without and with jerk limits: speed, acceleration and jerk of both axes."""
    figure = Figure(figsize=(11, 6), layout="constrained")
    rows = figure.subplots(3, 2, sharex="col")
    for column, (limit, title) in enumerate(((0.0, "PLANNER_TYPE = 0"), (10_000.0, "PLANNER_TYPE = 1, 10,000 mm/s³"))):
        q = cut([(40, 0, 0), (40, 40, 0)], 0.1, jerk=limit)
        q = np.vstack([np.zeros((3, 9)), q, q[-1:], q[-1:], q[-1:]])
        rows[0, column].set_title(title)
        for row in range(3):
            values = np.diff(q[:, :2], row + 1, axis=0) / DT ** (row + 1)
            rows[row, column].plot(np.arange(len(values)) * DT, values, label=["x", "y"], linewidth=0.9)
            rows[row, column].grid(alpha=0.3)
        rows[2, column].set(xlabel="time, s", ylim=(-12_000, 12_000))
    for row, name in enumerate(("speed, mm/s", "acceleration, mm/s²", "jerk, mm/s³")):
        rows[row, 0].set_ylabel(name)
    rows[0, 0].legend()
    return figure


def cost() -> Figure:
    """What a servo period costs with 0.02 mm moves: histograms by length of the queue, and the growth with it."""
    figure = Figure(figsize=(11, 4.5), layout="constrained")
    histogram, growth = figure.subplots(1, 2)
    queues = (100, 300, 1000, 2000, 4000)
    percentiles = {"median": 50.0, "99 %": 99.0, "99.9 %": 99.9}
    shown: dict[str, list[float]] = {name: [] for name in [*percentiles, "add: median"]}
    for queue in queues:
        runs = [tp_cost.run(tp_cost.tiny, 0.0005, queue, False, 0.0) for _ in range(3)]
        periods, adds = (values / 1000.0 for values in tp_cost.least(runs))
        if queue in (100, 1000, 4000):
            edges = np.geomspace(0.05, 500.0, 60)
            histogram.hist(np.clip(periods, 0.05, 499.0), edges, histtype="step", label=f"{queue} moves in the queue")
        for name, share in percentiles.items():
            shown[name].append(float(np.percentile(periods, share)))
        shown["add: median"].append(float(np.median(adds)))
    histogram.set(xscale="log", yscale="log", xlabel="cost of a servo period, us", ylabel="periods of 8,000")
    histogram.legend()
    for name, values in shown.items():
        growth.plot(queues, values, "o-", label=name)
    growth.set(xscale="log", yscale="log", xlabel="moves in the queue", ylabel="us", title="a period; adding a move")
    growth.legend()
    return figure


def main() -> None:
    OUT.mkdir(exist_ok=True)
    for draw in (corner, short_moves, look_ahead, jerk, cost):
        draw().savefig(OUT / f"planner_{draw.__name__}.png", dpi=80)


if __name__ == "__main__":
    main()
