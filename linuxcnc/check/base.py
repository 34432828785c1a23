"""A configuration under examination, and how the rules say what they find in it."""

from __future__ import annotations

import difflib
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from nml.errors import ConfigError, Place
from nml.inifile import IniFile


@dataclass(slots=True)
class Checked:
    """The INI file, and what the rule about HAL files has gathered for those that follow."""

    ini: IniFile
    hal_files: list[Path] = field(default_factory=list)
    references: dict[tuple[str, str], Place] = field(default_factory=dict)
    """Entries that HAL files use, and where first."""

    @property
    def folder(self) -> Path:
        return self.ini.file.resolve().parent

    @property
    def scripted(self) -> bool:
        """Whether a Tcl file, which may read any entry, is among the HAL files."""
        return any(path.suffix == ".tcl" for path in self.hal_files)

    def number(self, section: str, key: str, default: float | None = None) -> float | None:
        """A number, ``default`` where it is missing or no number: another rule says so."""
        try:
            return self.ini.real(section, key, default)
        except ConfigError:
            return default

    def joints(self) -> range:
        """The joints' numbers; none where their count is wrong."""
        count = int(self.number("KINS", "JOINTS") or 0)
        return range(count if 0 < count <= 16 else 0)

    def axes(self) -> str:
        """The axis letters of [TRAJ]COORDINATES, each as often as it stands there."""
        return "".join(letter for letter in self.ini.find("TRAJ", "COORDINATES", "").upper() if letter.isalpha())

    def place(self, section: str, key: str = "") -> Place:
        """Where an entry stands, or else the section's first one."""
        keys = self.ini.keys(section)
        return self.ini.place(section, key if key in keys else next(iter(keys), ""))


def finding(place: Place | Path, what: str, right: str) -> str:
    """One line: where, what is wrong, what would be right."""
    return f"{place}: {what}; {right}"


def listed_coordinates(kinematics: str) -> str:
    """The letters of ``coordinates=`` in a KINEMATICS entry; empty where it has none."""
    match = re.search(r"coordinates=(\w+)", kinematics, re.IGNORECASE)
    return match[1].upper() if match else ""


def nearest(word: str, known: Sequence[str]) -> str | None:
    """The known word that was probably meant."""
    folded = {name.upper(): name for name in known}
    close = difflib.get_close_matches(word.upper(), folded, 1, 0.8)
    return folded[close[0]] if close else None
