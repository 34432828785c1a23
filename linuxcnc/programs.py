"""The programs that an INI file names: ours by LinuxCNC's names, or executables; for the launcher."""

from __future__ import annotations

import importlib.util
import os
import shlex
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

from nml.errors import ConfigError
from nml.inifile import IniFile

# Programs of ours by the names that INI files use
MODULES = {
    "milltask": "emctask",
    "linuxcnctask": "emctask",
    "io": "emcio",
    "iov2": "emcio",
    "halui": "gui.halui",
    "linuxcncrsh": "gui.linuxcncrsh",
    "linuxcncsvr": "nml.net.server",
    "web": "gui.web",
}
# Options of those names that share a program with another
VARIANTS = {"iov2": ("-v2",)}
# Programs of ours that run beside the machine where the INI file has their section
SERVICES = {"MQTT": "gui.shop.mqtt", "OPCUA": "gui.shop.opcua"}


@dataclass(frozen=True, slots=True)
class Command:
    """A program and its arguments: a module of ours, or an executable by its path."""

    name: str
    arguments: list[str]
    module: str | None = None

    @property
    def words(self) -> list[str]:
        """As a person would type it."""
        return [self.name, *self.arguments]


class Programs:
    """Finds the programs of one INI file."""

    def __init__(self, ini: IniFile) -> None:
        self._ini = ini
        self._path = ini.file.absolute()
        self._folder = self._path.parent

    def ours(self, name: str, module: str, *arguments: str) -> Command:
        """A program of ours, told the INI file."""
        return Command(name, ["-ini", str(self._path), *arguments], module)

    def command(self, section: str, key: str, default: str) -> Command:
        """The command line of the program that an entry names; ConfigError where there is none."""
        words = self._ini.words(section, key, default)
        module = MODULES.get(words[0]) if words else None
        if module is not None and importlib.util.find_spec(module) is not None:
            return self.ours(words[0], module, *VARIANTS.get(words[0], ()), *words[1:])
        executable = words and self._executable(words[0])
        if executable:
            return Command(executable, ["-ini", str(self._path), *words[1:]])
        raise ConfigError(
            f"[{section}]{key} = {' '.join(words)}: no such program; "
            f"one of {', '.join(sorted(MODULES))} or an executable is allowed",
            self._ini.place(section, key),
        )

    def application(self, number: int) -> Command:
        """The command line of the n-th [APPLICATIONS]APP, counted from 1; ConfigError where there is none."""
        words = self._ini.words("APPLICATIONS", "APP", num=number)
        executable = self._executable(os.path.expanduser(words[0])) if words else None
        if executable is None:
            place = self._ini.place("APPLICATIONS", "APP", number)
            raise ConfigError(f"[APPLICATIONS]APP = {shlex.join(words)}: no such program", place)
        return Command(executable, words[1:])

    def _executable(self, name: str) -> str | None:
        """Where a program is: a path relative to the INI file, or a name on the search path."""
        if os.sep in name:
            return shutil.which(str(self._folder / name))
        return shutil.which(name, path=f"{self._folder}{os.pathsep}{self.search_path()}")

    def search_path(self) -> str:
        """The machine's own programs, ours beside this Python, then everybody's."""
        beside = str(Path(sys.executable).parent)
        return os.pathsep.join([str(self._folder / "bin"), beside, os.environ.get("PATH", os.defpath)])
