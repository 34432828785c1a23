"""Rules about single entries: known by name, there where they must be, of their kind and within their limits."""

from __future__ import annotations

from collections.abc import Iterator

from linuxcnc.check.base import Checked, finding, nearest
from linuxcnc.inikeys import OPEN_SECTIONS, TABLE, Key, Kind, family, lookup
from nml.errors import ConfigError
from nml.inifile import IniFile

SECTIONS = [name for name in TABLE if not name.endswith(("_n", "_L"))]
SECTIONS += [f"JOINT_{number}" for number in range(16)] + [f"AXIS_{letter}" for letter in "XYZABCUVW"]


def missing(checked: Checked) -> Iterator[str]:
    """What every machine needs is there."""
    for keys in TABLE.values():
        for key in keys.values():
            if key.required and checked.ini.find(key.section, key.name) is None:
                yield finding(checked.ini.file, f"[{key.section}]{key.name} is missing", f"{key.allowed} is needed")


def sections(checked: Checked) -> Iterator[str]:
    """Sections are not misspelt; others belong to screens and HAL files."""
    used = {section for section, _ in checked.references} | OPEN_SECTIONS
    for section in checked.ini.sections():
        near = nearest(section, SECTIONS)
        if near and section not in used and family(section) not in TABLE:
            yield finding(checked.place(section), f"nobody reads section [{section}]", f"did you mean [{near}]?")


def misspelt_keys(checked: Checked) -> Iterator[str]:
    """Keys that nobody knows are not nearly the name of one that is missing."""
    for section, key, near in _unknown(checked):
        if near:
            yield finding(checked.place(section, key), f"nobody reads [{section}]{key}", f"did you mean {near}?")


def unknown_keys(checked: Checked) -> Iterator[str]:
    """Other keys are known here or used by a HAL file, but where strangers may look for some of their own."""
    for section, key, near in _unknown(checked):
        if not near and section not in OPEN_SECTIONS and not checked.scripted:
            yield finding(checked.place(section, key), f"nobody reads [{section}]{key}", "leave it out")


def _unknown(checked: Checked) -> Iterator[tuple[str, str, str | None]]:
    """Section and name of each key that nobody knows, and what was probably meant."""
    for section in checked.ini.sections():
        known = TABLE.get(family(section), {})
        there = checked.ini.keys(section)
        for key in there if known else ():
            if not lookup(section, key) and (section, key) not in checked.references:
                yield section, key, nearest(key, [name for name in known if name not in there])


def values(checked: Checked) -> Iterator[str]:
    """Values are what they must be."""
    for section in checked.ini.sections():
        for name in checked.ini.keys(section):
            key = lookup(section, name)
            if key is None:
                continue
            for number in range(1, len(checked.ini.findall(section, name)) + 1):
                try:
                    _convert(checked.ini, section, key, number)
                except ConfigError as error:
                    yield str(error)


def _convert(ini: IniFile, section: str, key: Key, number: int) -> None:
    """Read a value as what it must be; ConfigError where it is not."""
    match key.kind:
        case Kind.INTEGER:
            low, high = (None if limit is None else int(limit) for limit in (key.minimum, key.maximum))
            ini.integer(section, key.name, minimum=low, maximum=high, num=number)
        case Kind.REAL:
            ini.real(section, key.name, minimum=key.minimum, maximum=key.maximum, num=number)
        case Kind.BOOLEAN:
            ini.boolean(section, key.name, num=number)
        case Kind.CHOICE:
            ini.choice(section, key.name, dict.fromkeys(key.choices, 0), num=number)
