"""Coordinate systems out of the parameter file that task keeps ([RS274NGC]PARAMETER_FILE); machine units and
degrees.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

NAMES = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
FIRST_SYSTEM, SYSTEM_STEP = 5221, 20
ROTATION = 9  # behind a system's nine offsets
G28, G30, G92_ACTIVE, G92 = 5161, 5181, 5210, 5211


def read(path: Path) -> dict[int, float]:
    """The parameters by number; what is no parameter is left out."""
    found: dict[int, float] = {}
    try:
        lines = path.read_text("ascii", "replace").splitlines()
    except OSError:
        return found
    for line in lines:
        words = line.split()
        if len(words) == 2 and words[0].isdecimal():
            try:
                found[int(words[0])] = float(words[1])
            except ValueError:
                continue
    return found


def nine(values: dict[int, float], first: int) -> list[float]:
    return [values.get(number, 0.0) for number in range(first, first + 9)]


def offsets(path: Path | None, status: dict[str, Any]) -> dict[str, Any]:
    """What ``offsets.read`` answers; the active system as the machine has it now."""
    values = read(path) if path is not None else {}
    active = int(status.get("g5x_index", 1))
    systems = []
    for index, name in enumerate(NAMES, 1):
        first = FIRST_SYSTEM + (index - 1) * SYSTEM_STEP
        offset, rotation = nine(values, first), values.get(first + ROTATION, 0.0)
        if index == active:
            offset, rotation = list(status["g5x_offset"]), status["rotation_xy"]
        systems.append({"index": index, "name": name, "offset": offset, "rotation": rotation})
    return {
        "active": active,
        "systems": systems,
        "g92": list(status["g92_offset"]),
        "g92_active": any(status["g92_offset"]),
        "g28": nine(values, G28),
        "g30": nine(values, G30),
        "tool": list(status["tool_offset"]),
    }
