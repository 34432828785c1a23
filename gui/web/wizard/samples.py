"""The configurations that come with us or stand on this computer: a list, and copies that their owner may change."""

from __future__ import annotations

import re
import secrets
import shutil
from pathlib import Path
from typing import Any

from gui.web.wizard.make import check_name
from linuxcnc.check import findings
from linuxcnc.picker import folders, offers
from nml.errors import ConfigError
from nml.inifile import IniFile

KEPT_OUT = ("*.bak", "*.var.bak", "__pycache__", ".*.part")
PARENT = re.compile(r"\.\./[\w./-]+")


def listing() -> list[dict[str, Any]]:
    """Every INI file that can be chosen, with the remark at its head."""
    found = []
    for offer in offers([place for place in folders() if place.is_dir()]):
        found.append(
            {"path": str(offer.path), "name": offer.path.stem, "folder": str(offer.folder), "text": head(offer.path)}
        )
    return found


def head(path: Path) -> str:
    """The remarks at the beginning of an INI file."""
    lines = []
    for line in path.read_text("utf-8", "replace").splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# ").rstrip())
    return " ".join(lines)


def copy(path: str, name: str, place: Path) -> tuple[Path, list[str]]:
    """Copy the folder of a listed configuration; the copy's INI file and what is wrong with it."""
    check_name(name)
    if path not in {offer["path"] for offer in listing()}:
        raise ConfigError(f"{path} is none of the configurations that can be copied")
    source, folder = Path(path), place / name
    if folder.exists():
        raise ConfigError(f"{folder} is there already")
    part = place / f".{secrets.token_hex(6)}.part"
    try:
        place.mkdir(parents=True, exist_ok=True)
        shutil.copytree(source.parent, part, ignore=shutil.ignore_patterns(*KEPT_OUT))
        _bring_neighbours(source, part)
        part.rename(folder)
    except OSError as reason:
        shutil.rmtree(part, ignore_errors=True)
        raise ConfigError(f"{folder} cannot be written: {reason.strerror}") from None
    ini = folder / source.name
    return ini, findings(ini)


def _bring_neighbours(source: Path, part: Path) -> None:
    """Copy folders beside the sample that its INI file names, and name the copies."""
    ini = part / source.name
    text = ini.read_text("utf-8")
    for relative in sorted(set(PARENT.findall(_values(source)))):
        neighbour = source.parent / relative
        if neighbour.is_dir() and not (part / neighbour.name).exists():
            shutil.copytree(neighbour, part / neighbour.name, ignore=shutil.ignore_patterns(*KEPT_OUT))
            text = text.replace(relative, neighbour.name)
    ini.write_text(text, "utf-8")


def _values(source: Path) -> str:
    """All values of an INI file."""
    ini = IniFile(source)
    return "\n".join(
        value
        for section in ini.sections()
        for key in dict.fromkeys(ini.keys(section))
        for value in ini.findall(section, key)
    )
