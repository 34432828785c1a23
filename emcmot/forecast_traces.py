"""The trace of a forecast: where the machine is in every servo period, and what follows, as arrays and as a picture.

``emcmot.forecast`` makes one where it is asked for; without it a forecast needs no numpy.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from emcmot.forecast_canon import ForecastCanon
from emcmot.forecast_error import path_error
from emcmot.forecast_machine import AXES
from nml.errors import ConfigError


@dataclass(frozen=True)
class Trace:
    """Positions of a job, in machine units and degrees."""

    positions: NDArray[np.float64]  # of every servo period, shape (periods, 9)
    lines: NDArray[np.int64]  # program line of every servo period
    start: tuple[float, ...]
    period: float  # s
    path_error: float | None  # lu: largest distance from the program's path, where that is bounded

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Position, velocity, acceleration and jerk of every servo period by name, with time and program line."""
        rest = np.zeros((1, len(AXES)))
        velocity = np.diff(self.positions, axis=0, prepend=[self.start]) / self.period
        acceleration = np.diff(velocity, axis=0, prepend=rest) / self.period
        return {
            "time": (np.arange(len(self.positions)) + 1) * self.period,
            "position": self.positions,
            "velocity": velocity,
            "acceleration": acceleration,
            "jerk": np.diff(acceleration, axis=0, prepend=rest) / self.period,
            "line": self.lines,
        }

    def save(self, path: Path) -> None:
        """Write the arrays as a numpy file."""
        np.savez_compressed(path, **self.arrays())  # type: ignore[arg-type]

    def draw(self, path: Path) -> None:
        """A picture of the axes that move. ConfigError without matplotlib."""
        try:
            from matplotlib.figure import Figure
        except ImportError:
            raise ConfigError("pictures need the package matplotlib: pip install matplotlib") from None
        arrays = self.arrays()
        moving = [axis for axis in range(9) if np.ptp(self.positions[:, axis]) > 0]
        figure = Figure(figsize=(12, 9), layout="constrained")
        rows = figure.subplots(4, 1, sharex=True)
        for row, name in zip(rows, ("position", "velocity", "acceleration", "jerk"), strict=True):
            for axis in moving:
                row.plot(arrays["time"], arrays[name][:, axis], label=AXES[axis], linewidth=0.8)
            row.set_ylabel(name)
            row.grid(alpha=0.3)
        rows[0].legend(loc="upper right", ncols=9)
        rows[-1].set_xlabel("time, s")
        figure.savefig(path, dpi=100)


def trace_of(canon: ForecastCanon, start: tuple[float, ...]) -> Trace:
    """What the canon has recorded of a program that began at ``start``."""
    parts, numbers = canon.trace()
    positions = np.concatenate([np.empty((0, len(AXES))), *parts])
    ids = np.concatenate([np.empty(0, dtype=np.int64), *numbers])
    error = path_error(canon.moves(), start, positions, ids) if len(positions) else None
    return Trace(positions, np.array(canon.lines())[ids], start, canon.period, error)
