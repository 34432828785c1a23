"""A folder with all files of a machine: made whole, or not at all."""

from __future__ import annotations

import re
import secrets
import shutil
from importlib import resources
from pathlib import Path
from typing import Any

from gui.web.wizard import answers, halfile, inifile
from gui.web.wizard.answers import Machine
from linuxcnc.check import findings
from nml.errors import ConfigError

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,39}")
TOOLS = {"mm": ("T1 P1 D6 ;6 mm end mill", "T2 P2 D10 ;10 mm end mill"), "inch": ("T1 P1 D0.25 ;1/4 in end mill",)}
WELCOME = "(moves each axis a little, in the air)\n{unit} G90 G94\nF{feed:g}\nG91\n{moves}\nG90\nM2\n"


def check_name(name: str) -> None:
    """ConfigError for a name that no folder and no INI file should bear."""
    if not NAME.fullmatch(name):
        raise ConfigError("the name must begin with a letter; letters, digits, _ and - may follow, 40 in all")


def generate(given: dict[str, Any], name: str, place: Path) -> tuple[Path, list[str]]:
    """Write ``place``/``name``; its INI file, and what ``linuxcnc --check`` finds wrong with it."""
    check_name(name)
    wrong = answers.errors(given)
    if wrong:
        raise ConfigError(f"{wrong[0]['key']}: {wrong[0]['text']}")
    machine = answers.machine_of(name, given)
    folder = place / name
    if folder.exists():
        raise ConfigError(f"{folder} is there already")
    part = place / f".{secrets.token_hex(6)}.part"
    try:
        (part / "nc_files").mkdir(parents=True)
        for file, text in files(machine).items():
            (part / file).write_text(text, encoding="utf-8")
        part.rename(folder)
    except OSError as reason:
        shutil.rmtree(part, ignore_errors=True)
        raise ConfigError(f"{folder} cannot be written: {reason.strerror}") from None
    ini = folder / f"{name}.ini"
    return ini, findings(ini)


def files(machine: Machine) -> dict[str, str]:
    """Every file by its name in the folder."""
    name = machine.name
    return {
        f"{name}.ini": inifile.text(machine),
        f"{name}.hal": halfile.text(machine),
        f"{name}.nml": resources.files("nml").joinpath("linuxcnc.nml").read_text("utf-8"),
        f"{name}.var": "",
        "tool.tbl": "".join(f"{line}\n" for line in TOOLS[machine.units]),
        "nc_files/welcome.ngc": welcome(machine),
    }


def welcome(machine: Machine) -> str:
    """A first program: each axis a little way and back."""
    moves = []
    for axis in machine.axes:
        step = min(1.0 if axis.rotary else 5.0 / machine.mm, (axis.max - axis.home) / 2.0)
        if step > 0.0:
            moves += [f"G1 {axis.letter}{step:.4f}", f"G1 {axis.letter}{-step:.4f}"]
    slowest = min(axis.velocity for axis in machine.axes)
    return WELCOME.format(
        unit="G21" if machine.units == "mm" else "G20", feed=round(slowest * 30.0, 3), moves="\n".join(moves)
    )
