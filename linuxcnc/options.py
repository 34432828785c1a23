"""The command line of ``linuxcnc``: LinuxCNC's options under their letters, and ours by words."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path

EPILOG = """\
Without INI, a list of the configurations in ~/linuxcnc/configs, /usr/local/etc/linuxcnc/configs and of our samples is
shown to choose from.
"""


class Talk(IntEnum):
    """How much is said while the machine starts."""

    PROBLEMS = 0
    STEPS = 1  # -v: each program that is started
    COMMANDS = 2  # -d: its command line, and every HAL command


@dataclass(frozen=True, slots=True)
class Overrides:
    """What the command line says in place of entries of the INI file; None: as the INI file says."""

    planner: str | None = None  # -t, for [TRAJ]TPMOD
    homing: str | None = None  # -m, for [EMCMOT]HOMEMOD
    hal_folders: tuple[Path, ...] = ()  # -H, searched first
    keep_going: bool = False  # -k


def parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    """The options; ends the process with code 2 where they are wrong."""
    parser = argparse.ArgumentParser(
        prog="linuxcnc", description="Start a CNC machine from an INI file.", epilog=EPILOG
    )
    parser.add_argument("ini", type=Path, nargs="?", metavar="INI", help="INI file of the machine")
    parser.add_argument("-l", dest="last", action="store_true", help="start the INI file that was started last")
    parser.add_argument("-v", dest="talk", action="store_const", const=Talk.STEPS, help="say what is started")
    parser.add_argument(
        "-d", dest="talk", action="store_const", const=Talk.COMMANDS, help="print command lines and HAL commands too"
    )
    parser.add_argument("-r", action="store_true", help="do not redirect output: it never is")
    parser.add_argument("-k", dest="keep_going", action="store_true", help="go on after errors in HAL files")
    parser.add_argument("-t", dest="planner", metavar="TPMOD", help="trajectory planner, for [TRAJ]TPMOD")
    parser.add_argument("-m", dest="homing", metavar="HOMEMOD", help="homing module, for [EMCMOT]HOMEMOD")
    parser.add_argument(
        "-H",
        dest="hal_folders",
        metavar="DIR",
        type=Path,
        action="append",
        default=[],
        help="look for HAL files here first; may be given again",
    )
    parser.add_argument("--check", action="store_true", help="check the configuration and end; starts nothing")
    parser.add_argument("--run", type=Path, metavar="FILE", help="switch on, home, run this program and end")
    parser.add_argument("--speed", type=float, metavar="N", help="simulate N times faster than real time")
    parser.add_argument("--namespace", metavar="NAME", help="name of this machine where several run on one host")
    parser.set_defaults(talk=Talk.PROBLEMS)
    options = parser.parse_args(arguments)
    if options.last and options.ini is not None:
        parser.error("either -l or an INI file")
    return options


def overrides(options: argparse.Namespace) -> Overrides:
    """What of the options replaces entries of the INI file."""
    return Overrides(options.planner, options.homing, tuple(options.hal_folders), options.keep_going)
