#!/usr/bin/env python3
"""What a servo period of the trajectory planner and adding a move to it cost, also with a long queue: histograms.

    python benchmarks/tp_cost.py [--queue N ...] [--runs N]

The planner does the same work in each run of a job, so the least of several runs is what the work itself costs; the
rest is the host. The queue is kept full; each job is run plain, with a feed override that changes all the time, and
with limited jerk.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from emcmot.tp.planner import Planner

Array = NDArray[np.float64]
DT = 0.001
FEED = 100.0
PERIODS = 8000
PERIODS_PER_FEED = 20  # between two looks at the queue
PERIODS_PER_OVERRIDE = 100
JERK = 10_000.0
VARIANTS = {"": (False, 0.0), ", overrides": (True, 0.0), ", jerk": (False, JERK)}  # overrides, jerk limit
BAR = 40  # characters of the longest bar
EDGES = 1000.0 * 2.0 ** np.arange(-4, 11)  # ns


def tiny(k: Array) -> Array:
    """0.02 mm moves on a radius of 100 mm, as exact as can be: they are not merged."""
    return np.column_stack([100 * np.cos(2e-4 * k) - 100, 100 * np.sin(2e-4 * k), 0 * k])


def rounded(k: Array) -> Array:
    """The same with coordinates to 0.001 mm: merged to chords."""
    return np.round(tiny(k), 3)


def zigzag(k: Array) -> Array:
    """20 mm to and fro, 1 mm apart."""
    return np.column_stack([20.0 * ((k + 1) // 2 % 2), k // 2, 0 * k])


JOBS: dict[str, tuple[Callable[[Array], Array], float]] = {
    "0.02 mm moves": (tiny, 0.0005),
    "0.02 mm moves, rounded": (rounded, 0.005),
    "zigzag": (zigzag, 0.01),
}


def run(
    curve: Callable[[Array], Array], tolerance: float, queue: int, overrides: bool, jerk: float
) -> tuple[Array, Array]:
    """Nanoseconds of every period and of every move added."""
    planner = Planner(DT, queue)
    for axis in range(9):
        planner.set_limits(axis, FEED, 500.0, jerk)
    planner.limit_jerk(jerk > 0.0)
    points = curve(np.arange(1.0, 20.0 * PERIODS)).tolist()
    periods: list[Array] = []
    adds: list[int] = []
    for step in range(PERIODS // PERIODS_PER_FEED):
        for _ in range(planner.status()["free"]):
            point = points[len(adds)]
            before = time.perf_counter_ns()
            planner.add_line(point, FEED, tolerance=tolerance, id=len(adds) + 1)
            adds.append(time.perf_counter_ns() - before)
        if overrides and step % (PERIODS_PER_OVERRIDE // PERIODS_PER_FEED) == 0:
            planner.feed_scale(1.0 - 0.5 * (step % 2))
        periods.append(planner.time_periods(PERIODS_PER_FEED))
    return np.concatenate(periods), np.array(adds, dtype=float)


def least(runs: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    """The least cost of each period and of each move."""
    return np.min([periods for periods, _ in runs], axis=0), np.min([adds for _, adds in runs], axis=0)


def row(values: Array) -> list[str]:
    """Median, two percentiles and the largest, in microseconds."""
    return [f"{v / 1000:.2f}" for v in (*np.percentile(values, (50, 99, 99.9)), values.max())]


def histogram(title: str, values: Array, console: Console) -> None:
    counts, _ = np.histogram(np.clip(values, EDGES[0], EDGES[-1] * 0.999), EDGES)
    console.print(f"\n{title}")
    for k in np.flatnonzero(counts):
        bar = "#" * int(np.ceil(BAR * counts[k] / counts.max()))
        console.print(f"  {EDGES[k] / 1000:8.3f} to {EDGES[k + 1] / 1000:8.3f} us {counts[k]:8d} {bar}")


def main() -> None:
    options = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    options.add_argument("--queue", type=int, nargs="*", default=[100, 1000, 4000], help="moves in the queue")
    options.add_argument("--runs", type=int, default=3, help="runs of each job")
    chosen = options.parse_args()
    console = Console(width=140)
    percentiles = ("median", "99 %", "99.9 %", "largest")
    table = Table("job", "queue", *(f"{what} us: {p}" for what in ("period", "add") for p in percentiles))
    shown: dict[str, tuple[Array, Array]] = {}
    for name, (curve, tolerance) in JOBS.items():
        for queue in chosen.queue:
            for variant, (overrides, jerk) in VARIANTS.items():
                costs = least([run(curve, tolerance, queue, overrides, jerk) for _ in range(chosen.runs)])
                job = name + variant
                table.add_row(job, str(queue), *row(costs[0]), *row(costs[1]))
                shown[f"{job}, queue {queue}"] = costs
    console.print(table)
    for title, (periods, adds) in shown.items():
        if title.endswith(f"queue {max(chosen.queue)}"):
            histogram(f"servo period: {title}", periods, console)
            histogram(f"adding a move: {title}", adds, console)


if __name__ == "__main__":
    main()
