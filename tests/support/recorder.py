"""A realtime component for tests, written in Python: writes some float pins to a file in every servo period.

The file is mapped into memory, so it is complete to the last period even if the host is killed. It begins with the
number of rows (as a double); each row holds one value for each pin.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

ROWS = 400_000


def load(host, args):
    """``loadrt recorder.py file=PATH pins=N``: pins recorder.0 .. recorder.N-1, function recorder."""
    from hal.realtime import HAL_FLOAT, HAL_IN

    count = int(args["pins"])
    table = np.memmap(args["file"], dtype=np.float64, mode="w+", shape=(1 + ROWS * count,))
    comp = host.component("recorder")
    pins = [comp.pin(f"recorder.{index}", HAL_FLOAT, HAL_IN) for index in range(count)]
    getters = [pin.get for pin in pins]
    rows = 0

    def record(period_ns):
        nonlocal rows
        if rows < ROWS:
            at = 1 + rows * count
            for index, get in enumerate(getters):
                table[at + index] = get()
            rows += 1
            table[0] = rows

    comp.python_function("recorder", record)
    comp.ready()


def hal_text(file: Path, signals: tuple[str, ...] = ("x-position", "y-position", "z-position")) -> str:
    """HAL commands that record some signals of the simulated mill."""
    nets = [f"net {signal} => recorder.{index}" for index, signal in enumerate(signals)]
    return "\n".join([f"loadrt {__file__} file={file} pins={len(signals)}", *nets, "addf recorder servo-thread", ""])


def recorded(file: Path, pins: int = 3) -> np.ndarray:
    """The rows written so far."""
    data = np.fromfile(file, dtype=np.float64)
    rows = int(data[0]) if data.size else 0  # the file is empty until the recorder has made room in it
    return data[1 : 1 + rows * pins].reshape(rows, pins)
