"""Types of the compiled forecast canon."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from emcmot.forecast_machine import Machine
from rs274ngc.moves import MoveCanon

Shape = tuple[tuple[float, ...], tuple[tuple[float, ...], tuple[float, ...], int] | None, bool]

class ForecastCanon(MoveCanon):
    period: float
    periods: int
    move_line: list[int]
    move_section: list[int]
    sections: list[tuple[int, str]]
    pauses: list[float]
    unbounded: int
    def __init__(
        self, machine: Machine, tools: Sequence[Any] = (), tool_change_s: float = 0.0, trace: bool = False
    ) -> None: ...
    def run_out(self) -> None: ...
    def trace(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]: ...
    def times(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def reasons(self) -> list[float]: ...
    def move_reasons(self) -> NDArray[np.int8]: ...
    def moves(self) -> list[Shape]: ...
