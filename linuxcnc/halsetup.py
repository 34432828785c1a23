"""The HAL files and commands of an INI file, executed by the launcher itself.

The first mistake ends the start, unless the person who started the machine wants to go on after mistakes.
"""

from __future__ import annotations

import contextlib
import os
import shlex
from pathlib import Path

from hal import twopass
from hal.session import Quit, Session
from linuxcnc.configuration import Configuration, HalFile
from linuxcnc.motionmodules import MotionModule
from nml.errors import Place, PyemcError


class HalFileError(PyemcError):
    """A line of a HAL file failed: ``file:line: message``."""


class SetupSession(Session):
    """A HAL session whose first error ends it, or with ``keep_going`` is only reported."""

    def report(self, error: Exception) -> None:
        if self.keep_going:
            super().report(error)
            return
        raise HalFileError(f"{self.place}: {error}") from error


def set_up(session: Session, configuration: Configuration) -> None:
    """Load motion's planner and homing, run [HAL]HALFILE in order, then [HAL]HALCMD, and start the threads.

    Relative names start at the INI file.
    """
    before = Path.cwd()
    ini, files = configuration.ini, configuration.hal_files
    os.chdir(configuration.folder)
    try:
        for module in configuration.motion_modules:
            _load(session, module)
        if ini.find("HAL", "TWOPASS"):
            if not twopass.run(session, [(file.path, file.arguments) for file in files]) and not session.keep_going:
                raise HalFileError("[HAL]TWOPASS: a HAL file failed")
        else:
            _run_in_order(session, files)
        for number, line in enumerate(ini.findall("HAL", "HALCMD"), 1):
            session.place = ini.place("HAL", "HALCMD", number)
            session.run_line(line)
        session.place = Place("<start>")
        session.run_line("start")
    finally:
        os.chdir(before)


def _load(session: Session, module: MotionModule) -> None:
    session.place = module.place
    session.run_line(shlex.join(["loadrt", *module.words]))
    if module.offers not in session.host.provided():
        raise HalFileError(f"{module.place}: {module.shown}: this module offers no {module.offers}")


def _run_in_order(session: Session, files: list[HalFile]) -> None:
    for file in files:
        with contextlib.suppress(Quit):
            if not session.run_file(file.path, file.arguments) and not session.keep_going:
                raise HalFileError(f"{file.path}: failed")
