"""The programs that an INI file names: ours by LinuxCNC's names, or executables; for the launcher."""

from __future__ import annotations

import importlib.util
import os
import shlex
import shutil
import sys
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
# Programs of ours that run beside the machine where the INI file has their section
SERVICES = {"MQTT": "gui.shop.mqtt", "OPCUA": "gui.shop.opcua"}


class Programs:
    """Finds the programs of one INI file."""

    def __init__(self, ini: IniFile) -> None:
        self._ini = ini
        self._path = ini.file.resolve()
        self._folder = self._path.parent

    def command(self, section: str, key: str, default: str) -> list[str]:
        """The command line of the program that an entry names; ConfigError where there is none."""
        words = shlex.split(self._ini.find(section, key, default))
        module = MODULES.get(words[0]) if words else None
        if module is not None and importlib.util.find_spec(module) is not None:
            return [*python_module(module), "-ini", str(self._path), *words[1:]]
        executable = words and self._executable(words[0])
        if executable:
            return [executable, "-ini", str(self._path), *words[1:]]
        raise ConfigError(
            f"[{section}]{key} = {' '.join(words)}: no such program; "
            f"one of {', '.join(sorted(MODULES))} or an executable is allowed",
            self._ini.place(section, key),
        )

    def _executable(self, name: str) -> str | None:
        """Where a program is: a path relative to the INI file, or a name on the search path."""
        if os.sep in name:
            return shutil.which(str(self._folder / name))
        return shutil.which(name, path=f"{self._folder}{os.pathsep}{self.search_path()}")

    def search_path(self) -> str:
        """The machine's own programs, ours beside this Python, then everybody's."""
        beside = str(Path(sys.executable).parent)
        return os.pathsep.join([str(self._folder / "bin"), beside, os.environ.get("PATH", os.defpath)])


def python_module(module: str) -> list[str]:
    """Command line that runs one of our modules; ``-P`` keeps the working folder out of the import path."""
    return [sys.executable, "-P", "-m", module]
