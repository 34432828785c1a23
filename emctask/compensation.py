"""Screw compensation files ([JOINT_n]COMP_FILE): rows of nominal position and what to correct on the way up and down.

Type 0 rows hold the measured positions, type 1 rows the corrections themselves; what comes out are corrections to add.
"""

from __future__ import annotations

from pathlib import Path

from nml.errors import ConfigError, Place

MAX_ROWS = 256


def read_compensation(path: Path, kind: int) -> list[tuple[float, float, float]]:
    """Rows (nominal, forward, reverse) in machine units with rising nominal; ConfigError names the wrong line."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise ConfigError(f"the compensation file cannot be read: {error.strerror}", Place(str(path))) from None
    rows: list[tuple[float, float, float]] = []
    for number, line in enumerate(lines, 1):
        text = line.partition("#")[0].partition(";")[0].strip()
        if not text:
            continue
        place = Place(str(path), number)
        try:
            nominal, forward, reverse = (float(word) for word in text.split())
        except ValueError:
            raise ConfigError(f"{text!r}: three numbers are needed: nominal, forward, reverse", place) from None
        if kind == 0:
            forward, reverse = nominal - forward, nominal - reverse
        if rows and nominal <= rows[-1][0]:
            raise ConfigError(f"{nominal:g} does not rise; nominal positions must rise from line to line", place)
        rows.append((nominal, forward, reverse))
        if len(rows) > MAX_ROWS:
            raise ConfigError(f"more than {MAX_ROWS} rows", place)
    return rows
