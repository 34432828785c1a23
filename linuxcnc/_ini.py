"""``linuxcnc.ini``: values of an INI file by section and key."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import Any

from linuxcnc._connection import error
from nml.errors import ConfigError
from nml.inifile import IniFile

WORD = 1 << 64
"""An unsigned number that is written with a minus sign is this much larger."""


class ini:
    """An INI file that was read; every method takes the section first, then the key.

    The typed getters count repeated keys from 1 with ``num``. They return ``fallback`` for an entry that is not there,
    and for one that is not of the type, which is told on standard error.
    """

    def __init__(self, filename: str | os.PathLike[str]) -> None:
        try:
            self._file = IniFile(os.fspath(filename))
        except (ConfigError, OSError) as reason:
            raise error(f"inifile.open() failed: {reason}") from reason

    def find(self, section: str, key: str) -> str | None:
        """The first value of ``key``, None if there is none."""
        return self._file.find(section, key)

    def findall(self, section: str, key: str) -> list[str]:
        """All values of a repeated ``key`` in the order of the file; of all keys of the section if it is empty."""
        if key:
            return self._file.findall(section, key)
        return [value for name in self._file.keys(section) for value in self._file.findall(section, name)]

    def hassection(self, section: str) -> bool:
        """Is there a section of that name?"""
        return section in self._file.sections()

    def hasvariable(self, section: str, key: str) -> bool:
        """Has the section such a key with a value?"""
        return self._file.find(section, key) is not None

    def getsections(self) -> list[str]:
        """The names of all sections in the order of the file."""
        return self._file.sections()

    def getvariables(self, section: str | None = None) -> list[tuple[str, str]]:
        """Key and value of each entry of a section, or of all; the keys as they first come in the file."""
        return [
            (key, value)
            for name in (self._file.sections() if section is None else [section])
            for key in self._file.keys(name)
            for value in self._file.findall(name, key)
        ]

    def lineof(self, section: str, key: str, num: int = 1) -> tuple[str, int] | tuple[None, None]:
        """The file and the line where an entry stands."""
        place = self._file.place(section, key, num)
        return (place.file, place.line) if place.line else (None, None)

    def getstring(self, section: str, key: str, num: int = 1, fallback: Any = None) -> Any:
        """The value as it stands there."""
        return self._file.find(section, key, fallback, num)

    def getbool(self, section: str, key: str, num: int = 1, fallback: Any = None) -> Any:
        """True for true, yes, on and 1, False for false, no, off and 0, in any case."""
        return self._get(lambda: self._file.boolean(section, key, fallback, num=num), fallback)

    def getsint(self, section: str, key: str, num: int = 1, fallback: Any = None) -> Any:
        """A whole number: decimal, or with 0x, 0o or 0b."""
        return self._get(lambda: self._file.integer(section, key, fallback, num=num), fallback)

    def getuint(self, section: str, key: str, num: int = 1, fallback: Any = None) -> Any:
        """A whole number that is not negative."""
        value = self.getsint(section, key, num, fallback)
        if value is fallback or value >= 0:
            return value
        print(f"{self._file.place(section, key, num)}: [{section}]{key}: a minus sign is wrong here", file=sys.stderr)
        return value % WORD

    def getreal(self, section: str, key: str, num: int = 1, fallback: Any = None) -> Any:
        """A number."""
        return self._get(lambda: self._file.real(section, key, fallback, num=num), fallback)

    getint, getfloat = getsint, getreal

    @staticmethod
    def _get(read: Callable[[], Any], fallback: Any) -> Any:
        try:
            return read()
        except ConfigError as reason:
            print(reason, file=sys.stderr)
            return fallback
