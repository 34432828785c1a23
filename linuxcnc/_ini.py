"""``linuxcnc.ini``: values of an INI file by section and key."""

from __future__ import annotations

import os

from linuxcnc._connection import error
from nml.errors import ConfigError
from nml.inifile import IniFile


class ini:
    """An INI file that was read; ``find`` and ``findall`` take the section first, then the key."""

    def __init__(self, filename: str | os.PathLike[str]) -> None:
        try:
            self._file = IniFile(os.fspath(filename))
        except (ConfigError, OSError) as reason:
            raise error(f"inifile.open() failed: {reason}") from reason

    def find(self, section: str, key: str) -> str | None:
        """The first value of ``key``, None if there is none."""
        return self._file.find(section, key)

    def findall(self, section: str, key: str) -> list[str]:
        """All values of a repeated ``key`` in the order of the file."""
        return self._file.findall(section, key)
