"""Which INI file was started last: [PICKCONFIG]LAST_CONFIG in ``~/.linuxcncrc``, LinuxCNC's own note."""

from __future__ import annotations

import re
from pathlib import Path

from nml.errors import ConfigError, Place
from nml.inifile import IniFile

SECTION, KEY = "PICKCONFIG", "LAST_CONFIG"
_ENTRY = re.compile(rf"^{KEY}\s*=.*$", re.MULTILINE)


def note() -> Path:
    """The file of the person who runs this."""
    return Path.home() / ".linuxcncrc"


def recall() -> Path | None:
    """The INI file started last, whether or not it is still there; None where none was noted."""
    if not note().is_file():
        return None
    name = IniFile(note()).find(SECTION, KEY)
    return Path(name) if name else None


def recall_or_refuse() -> Path:
    """What ``linuxcnc -l`` starts; ConfigError where that cannot be."""
    path = recall()
    if path is None:
        raise ConfigError("no INI file was started before; name one: linuxcnc INI", Place(str(note())))
    if not path.is_file():
        raise ConfigError(f"the INI file started last, {path}, is gone; name another: linuxcnc INI", Place(str(note())))
    return path


def remember(ini: Path) -> None:
    """Note an INI file; everything else in the note stays. A home folder that cannot be written keeps no note."""
    entry = f"{KEY} = {ini.resolve()}"
    try:
        text = note().read_text() if note().is_file() else ""
        if _ENTRY.search(text):
            text = _ENTRY.sub(lambda _: entry, text, count=1)
        elif f"[{SECTION}]" in text:
            text = text.replace(f"[{SECTION}]", f"[{SECTION}]\n{entry}", 1)
        else:
            text += f"[{SECTION}]\n{entry}\n"
        note().write_text(text)
    except OSError:
        return
