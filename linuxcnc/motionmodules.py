"""The planner and the homing module that motion is given: named in the INI file or on the command line, else ours.

A module is a realtime module by its name, or a file of one (``.py``, ``.so``) with a path from the INI file's folder.
The launcher loads both before the HAL files; ``docs/motion-modules.md`` says how one is made.
"""

from __future__ import annotations

import os
import shlex
from dataclasses import dataclass
from pathlib import Path

from hal.finder import is_file, realtime_modules
from nml.errors import ConfigError, Place
from nml.inifile import IniFile


@dataclass(frozen=True, slots=True)
class MotionModule:
    """A module to be loaded."""

    words: list[str]
    """The module and its arguments, for ``loadrt``."""
    offers: str
    """What it must provide in the realtime host."""
    shown: str
    """How it was named."""
    place: Place


@dataclass(frozen=True, slots=True)
class Part:
    """A part of motion that a module may replace: where the module is named, and the name of ours."""

    section: str
    key: str
    ours: str
    option: str
    offers: str

    def module(self, ini: IniFile, given: str | None = None) -> MotionModule:
        """The module that the command line (``given``), else the INI file, names; ConfigError where there is none."""
        text = given or ini.find(self.section, self.key, self.ours)
        place = Place("<command line>") if given else ini.place(self.section, self.key)
        shown = f"{self.option} {text}" if given else f"[{self.section}]{self.key} = {text}"
        try:
            name, *arguments = shlex.split(text) or [self.ours]
        except ValueError:
            raise ConfigError(f"{shown}: a quote stays open; close it", place) from None
        if os.sep in name or is_file(name):
            path = Path.cwd() / name if given else ini.resolve(name)
            if not os.path.isfile(path):
                raise ConfigError(f"{shown}: there is no file {path}; use {self.ours} or a module that is there", place)
            name = str(path)
        elif name != self.ours and name not in realtime_modules():
            right = f"use {self.ours}, an installed module or a file with its path"
            raise ConfigError(f"{shown}: no such module; {right}", place)
        return MotionModule([name, *arguments], self.offers, shown, place)


PLANNER = Part("TRAJ", "TPMOD", "tpmod", "-t", "planner")
HOMING = Part("EMCMOT", "HOMEMOD", "homemod", "-m", "homing")
