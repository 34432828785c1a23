"""The parameter file: numbered parameters that outlive the program.

Two columns, number and value, numbers ascending; the file that was there stays as ``.bak``. Writing is atomic: whoever
reads sees the old file or the new one, also after a power cut.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path

from nml.errors import ConfigError, Place

REQUIRED = (
    *range(5161, 5170),
    *range(5181, 5190),
    *range(5210, 5220),
    5220,
    *(first + k for first in range(5221, 5400, 20) for k in range(10)),
)
"""Parameters that are in every file."""


def load(path: str | Path, highest: int) -> dict[int, float]:
    """The parameters of a file; lines that are not two numbers are skipped, numbers must ascend."""
    values: dict[int, float] = {}
    last = 0
    try:
        with open(path, encoding="utf-8", errors="replace") as lines:
            for line_number, line in enumerate(lines, 1):
                words = line.split()
                try:
                    number, value = int(words[0]), float(words[1])
                except (IndexError, ValueError):
                    continue
                place = Place(str(path), line_number)
                if not 0 < number < highest:
                    raise ConfigError(f"Parameter number out of range: {number}, greatest is {highest - 1}", place)
                if number <= last:
                    raise ConfigError(f"Parameter file out of order: {number} after {last}", place)
                values[number] = value
                last = number
    except OSError as error:
        raise ConfigError(f"Unable to open parameter file: '{path}' ({error.strerror})", Place(str(path))) from error
    return values


def save(path: str | Path, numbers: Iterable[int], value: Callable[[int], float]) -> None:
    """Replace the file by one with these parameters."""
    target = Path(path)
    text = "".join(f"{number}\t{value(number):.6f}\n" for number in sorted(numbers))
    fresh = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        with open(fresh, "w", encoding="ascii") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            backup = target.with_name(target.name + ".bak")
            backup.unlink(missing_ok=True)
            try:
                os.link(target, backup)
            except OSError:
                backup.write_bytes(target.read_bytes())
        os.replace(fresh, target)
    except OSError as error:
        fresh.unlink(missing_ok=True)
        raise ConfigError(f"the parameter file cannot be written: {error.strerror}", Place(str(path))) from error
