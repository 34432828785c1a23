"""Rules about what an INI file names: HAL files, programs, modules, the NML file, the tool table."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

from hal.session import find_hal_file
from linuxcnc.check.base import Checked, finding, nearest
from linuxcnc.motionmodules import HOMING, PLANNER
from linuxcnc.programs import Programs
from nml.check import contradictions
from nml.config import NmlConfig
from nml.errors import ConfigError, Place

HAL_FILE_KEYS = ("HALFILE", "POSTGUI_HALFILE", "POSTTASK_HALFILE", "SHUTDOWN")

_REFERENCE = re.compile(r"(?<![\w.)\]])\[(\w+)\]\(?(\w+)\)?")
"""``[SECTION]KEY`` or ``[SECTION](KEY)`` in a HAL file."""

_TOOL_WORD = re.compile(r"[TPXYZABCUVWDIJQ][-+]?(\d+\.?\d*|\.\d+)", re.IGNORECASE)


def lines(checked: Checked) -> Iterator[str]:
    """Lines that mean nothing."""
    for remark in checked.ini.remarks:
        yield f"{remark}; correct it or leave it out"


def hal_files(checked: Checked) -> Iterator[str]:
    """HAL files are there; what they use of the INI file is gathered."""
    for key in HAL_FILE_KEYS:
        for number in range(1, len(checked.ini.findall("HAL", key)) + 1):
            name = checked.ini.words("HAL", key, num=number)[0]
            path = find_hal_file(name, [checked.folder])
            if path is None:
                place = checked.ini.place("HAL", key, number)
                yield finding(
                    place, f"[HAL]{key} = {name}: no such file", f"one in {checked.folder} or the HAL library is needed"
                )
                continue
            checked.hal_files.append(path)
            yield from _gather(checked, path)


def _gather(checked: Checked, path: Path) -> Iterator[str]:
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError as reason:
        yield finding(path, f"cannot be read: {reason.strerror}", "a readable file is needed")
        return
    for number, line in enumerate(text.splitlines(), 1):
        for section, key in _REFERENCE.findall(line.partition("#")[0]):
            checked.references.setdefault((section, key), Place(str(path), number))


def references(checked: Checked) -> Iterator[str]:
    """Entries that HAL files use are in the INI file; what Tcl files do with theirs is not known."""
    for (section, key), place in checked.references.items():
        if not place.file.endswith(".hal") or checked.ini.find(section, key) is not None:
            continue
        near = nearest(key, checked.ini.keys(section))
        right = f"did you mean [{section}]{near}?" if near else f"an entry {key} in [{section}] is needed"
        yield finding(place, f"[{section}]{key} is not in {checked.ini.file}", right)


def programs(checked: Checked) -> Iterator[str]:
    """Programs are there."""
    found = Programs(checked.ini)
    for section, key, default in (
        ("TASK", "TASK", "milltask"),
        ("EMCIO", "EMCIO", "io"),
        ("DISPLAY", "DISPLAY", "linuxcncrsh"),
        ("HAL", "HALUI", "halui"),
    ):
        try:
            found.command(section, key, default)
        except ConfigError as error:
            yield str(error)


def modules(checked: Checked) -> Iterator[str]:
    """The planner and homing modules are there."""
    for part in (PLANNER, HOMING):
        try:
            part.module(checked.ini)
        except ConfigError as error:
            yield str(error)


def nml_file(checked: Checked) -> Iterator[str]:
    """The NML file is there and does not contradict itself."""
    name = checked.ini.find("EMC", "NML_FILE")
    if name is None:
        return
    path = checked.ini.resolve(name)
    if not os.path.isfile(path):
        right = "leave the entry out to use the built-in one"
        yield finding(checked.place("EMC", "NML_FILE"), f"[EMC]NML_FILE = {name}: no such file", right)
        return
    try:
        yield from contradictions(NmlConfig.load(path))
    except ConfigError as error:
        yield str(error)


def tool_table(checked: Checked) -> Iterator[str]:
    """The tool table can be read."""
    name = checked.ini.find("EMCIO", "TOOL_TABLE")
    if name is None or checked.ini.find("EMCIO", "DB_PROGRAM"):
        return
    path = checked.ini.resolve(name)
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError as reason:
        what = f"[EMCIO]TOOL_TABLE = {name}: {reason.strerror}"
        yield finding(checked.place("EMCIO", "TOOL_TABLE"), what, "a readable tool table is needed")
        return
    seen: dict[str, int] = {}
    for number, line in enumerate(text.splitlines(), 1):
        words = line.partition(";")[0].upper().split()
        place = Place(str(path), number)
        wrong = [word for word in words if not _TOOL_WORD.fullmatch(word)]
        tools = [word for word in words if word.startswith("T")]
        if wrong:
            yield finding(place, f"{wrong[0]!r} is no word of a tool table", "letter and number, like T1, are needed")
        elif words and len(tools) != 1:
            yield finding(place, f"{len(tools)} tool numbers in one line", "one, like T1, is needed")
        for tool in tools:
            if seen.setdefault(tool, number) != number:
                yield finding(place, f"{tool} is in line {seen[tool]} already", "another number is needed")
