"""What an INI file asks the launcher to start: files that must exist, programs by LinuxCNC's names, environment."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from hal.session import find_hal_file
from linuxcnc import systempython
from linuxcnc._constants import version
from linuxcnc.motionmodules import HOMING, PLANNER
from linuxcnc.options import Overrides
from linuxcnc.programs import MODULES, SERVICES, Command, Programs
from nml import clock, namespace
from nml.config import NmlConfig
from nml.errors import ConfigError, Place
from nml.inifile import IniFile

HALLIB = Path("/usr/share/linuxcnc/hallib")
NC_FILES = Path("/usr/share/linuxcnc/ncfiles")
FOR_DISPLAYS = {
    "LINUXCNC_HOME": "/usr",
    "LINUXCNC_TCL_DIR": "/usr/lib/tcltk/linuxcnc",
    "LINUXCNC_LANG_DIR": "/usr/lib/tcltk/linuxcnc/msgs",
    "LINUXCNC_HELP_DIR": "/usr/share/doc/linuxcnc",
    "LINUXCNC_NCFILES_DIR": str(NC_FILES),
    "LINUXCNC_EMCSH": "/usr/bin/wish8.6",
    "LINUXCNCVERSION": version,
    "HALCMD": "halcmd",
}
"""What LinuxCNC's displays expect of the environment: where Debian's package has their parts."""


@dataclass(frozen=True, slots=True)
class HalFile:
    """One [HAL]HALFILE: the file, and the arguments that a Tcl file gets."""

    path: Path
    arguments: list[str]


class Configuration:
    """A checked INI file: everything it names exists, or ConfigError says what does not."""

    def __init__(self, path: Path, overrides: Overrides | None = None) -> None:
        self.path = path.absolute()
        self.folder = self.path.parent
        self.overrides = overrides or Overrides()
        self.ini = IniFile(self.path)
        if not any(self.ini.sections()):
            wrong = "no [SECTION] in it, so this is no INI file; name the INI file of a machine"
            raise ConfigError(wrong, Place(str(self.path)))
        self.programs = Programs(self.ini)
        self.ini.integer("KINS", "JOINTS", minimum=1, maximum=16)
        self.ini.find("TRAJ", "COORDINATES")
        named = (PLANNER, self.overrides.planner), (HOMING, self.overrides.homing)
        self.motion_modules = [part.module(self.ini, given) for part, given in named]
        self.nml_file = self._nml_file()
        self._hal_folders = self._existing(self.overrides.hal_folders)
        self.hal_files = self._hal_files()
        self.shutdown = self._shutdown()
        self.application_delay = self.ini.real("APPLICATIONS", "DELAY", 0.0, minimum=0.0)
        self.task = self.programs.command("TASK", "TASK", "milltask")
        self.io = self.programs.command("EMCIO", "EMCIO", "io")
        self.server = self._server()
        self.halui = self.programs.command("HAL", "HALUI", "halui") if self.ini.find("HAL", "HALUI") else None

    def services(self) -> dict[str, Command]:
        """Command lines of the programs beside the machine, by name."""
        wanted = {section.lower(): module for section, module in SERVICES.items() if section in self.ini.sections()}
        return {name: self.programs.ours(name, module) for name, module in wanted.items()}

    def display(self) -> Command:
        """Command line of the display; only asked for when one is to be started."""
        if self.ini.find("DISPLAY", "DISPLAY") is None:
            raise ConfigError("[DISPLAY]DISPLAY is missing; name a display, e.g. linuxcncrsh", Place(str(self.path)))
        return self.programs.command("DISPLAY", "DISPLAY", "linuxcncrsh")

    def _existing(self, folders: tuple[Path, ...]) -> list[Path]:
        for folder in folders:
            if not folder.is_dir():
                raise ConfigError(f"-H {folder}: there is no such folder", Place("<command line>"))
        return [folder.resolve() for folder in folders]

    def _server(self) -> Command | None:
        """The NML server, where a buffer is to be reached from elsewhere.

        Side by side with another machine, in a namespace of its own, it may go without a port that is taken.
        """
        buffers = NmlConfig.load(self.nml_file).buffer_lines
        if not any(one.tcp or one.udp or one.stcp or one.serial_port for one in buffers):
            return None
        optional = ["--optional"] if namespace.VARIABLE in os.environ else []
        return self.programs.ours("linuxcncsvr", MODULES["linuxcncsvr"], *optional)

    def _nml_file(self) -> Path | None:
        name = self.ini.find("EMC", "NML_FILE")
        if name is None:
            return None
        path = self.folder / name
        if not os.path.isfile(path):
            raise ConfigError(
                f"[EMC]NML_FILE = {name}: there is no file {path}; leave the entry out to use the built-in one",
                self.ini.place("EMC", "NML_FILE"),
            )
        NmlConfig.load(path)
        return path

    def _hal_files(self) -> list[HalFile]:
        names = self.ini.findall("HAL", "HALFILE")
        return [self._hal_file(name, number) for number, name in enumerate(names, 1)]

    def _hal_file(self, name: str, number: int, key: str = "HALFILE") -> HalFile:
        """A HAL file beside the INI file, or in the library (``LIB:name``, or not found beside it)."""
        words = self.ini.words("HAL", key, num=number)
        place = self.ini.place("HAL", key, number)
        path = find_hal_file(words[0], [*self._hal_folders, self.folder])
        if path is None:
            folders = ", ".join(map(str, [*self._hal_folders, self.folder]))
            raise ConfigError(f"[HAL]{key} = {name}: no such file in {folders} or the HAL library", place)
        return HalFile(path, words[1:])

    def _shutdown(self) -> HalFile | None:
        """[HAL]SHUTDOWN, the HAL file that is executed when the machine is at rest and about to end."""
        name = self.ini.find("HAL", "SHUTDOWN")
        return self._hal_file(name, 1, "SHUTDOWN") if name else None

    def environment(self) -> dict[str, str]:
        """The environment of every process of this machine."""
        variables = FOR_DISPLAYS | dict(os.environ)
        if variables.get("LINUXCNC_OPENGL_PLATFORM", "glx") == "glx":
            variables["PYOPENGL_PLATFORM"] = "x11"
        variables |= {
            namespace.VARIABLE: namespace.namespace(),
            clock.VARIABLE: repr(clock.speed()),
            "INI_FILE_NAME": str(self.path),
            "CONFIG_DIR": str(self.folder),
            "HALLIB_DIR": str(HALLIB),
            "HALLIB_PATH": os.pathsep.join([*map(str, self._hal_folders), ".", str(HALLIB)]),
            "TRAJ_COORDINATES": self.ini.find("TRAJ", "COORDINATES") or "",
            "KINS_KINEMATICS": self.ini.find("KINS", "KINEMATICS") or "",
            "PATH": self.programs.search_path(),
            **systempython.environment(),
        }
        if self.nml_file is not None:
            variables["NMLFILE"] = str(self.nml_file)
        return variables
