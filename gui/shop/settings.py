"""The INI sections [MQTT] and [OPCUA], read and checked at the start."""

from __future__ import annotations

import re
from pathlib import Path

import linuxcnc
from nml.errors import ConfigError, Place


class Section:
    """One section of an INI file; ConfigError names the entry that is wrong and what would be right."""

    def __init__(self, path: Path, name: str) -> None:
        self._path, self._name = path, name
        self._ini = linuxcnc.ini(path)

    def text(self, key: str, default: str = "") -> str:
        return self._ini.find(self._name, key) or default

    def required(self, key: str, example: str) -> str:
        value = self.text(key)
        if not value:
            raise self.wrong(key, "is missing", f"e.g. {key} = {example}")
        return value

    def real(self, key: str, default: float, low: float, high: float) -> float:
        text = self.text(key, str(default))
        try:
            value = float(text)
        except ValueError:
            value = float("nan")
        if not low <= value <= high:
            raise self.wrong(key, f"= {text}", f"a number from {low:g} to {high:g} is allowed")
        return value

    def boolean(self, key: str) -> bool:
        text = self.text(key, "no").lower()
        if text not in ("yes", "no", "true", "false", "1", "0", "on", "off"):
            raise self.wrong(key, f"= {text}", "yes or no is allowed")
        return text in ("yes", "true", "1", "on")

    def file(self, key: str) -> Path | None:
        """A file beside the INI file."""
        name = self.text(key)
        if not name:
            return None
        path = self._path.parent / name
        if not path.is_file():
            raise self.wrong(key, f"= {name}", f"there is no file {path}")
        return path

    def machine(self) -> str:
        """The machine's name as one word, for topics and addresses."""
        return re.sub(r"[^\w.-]+", "-", self._ini.find("EMC", "MACHINE") or "machine").strip("-") or "machine"

    def wrong(self, key: str, what: str, right: str) -> ConfigError:
        return ConfigError(f"[{self._name}]{key} {what}; {right}", Place(str(self._path)))
