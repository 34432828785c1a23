"""inivar -var KEY [-sec SECTION] [-num N] [-ini FILE]: prints one value of an INI file, for scripts.

Exit code 0: found; 1: not found; 255: the file cannot be read. Without -sec all sections are searched.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from nml.errors import ConfigError
from nml.inifile import IniFile

NOT_FOUND, UNREADABLE = 1, 255


def main(argv: list[str] | None = None) -> int:
    """Print one value."""
    parser = argparse.ArgumentParser(prog="inivar", description="Print one value of an INI file.", allow_abbrev=False)
    parser.add_argument("-var", metavar="KEY", required=True)
    parser.add_argument("-sec", metavar="SECTION", help="only in this section")
    parser.add_argument("-num", metavar="N", type=int, default=1, help="the N-th of a repeated key, from 1")
    parser.add_argument("-ini", metavar="FILE", default="emc.ini", help="default: emc.ini")
    parser.add_argument("-tildeexpand", action="store_true", help="replace ~ at the start of the value")
    arguments = parser.parse_args(argv)
    try:
        ini = IniFile(arguments.ini)
    except ConfigError as error:
        print(f"inivar: {error}", file=sys.stderr)
        return UNREADABLE
    sections = ini.sections() if arguments.sec is None else [arguments.sec]
    values = [value for section in sections for value in ini.findall(section, arguments.var)]
    if not 0 < arguments.num <= len(values):
        where = "" if arguments.sec is None else f"-sec {arguments.sec} "
        print(f"Can not find {where}-var {arguments.var} -num {arguments.num}", file=sys.stderr)
        return NOT_FOUND
    value = values[arguments.num - 1]
    print(Path(value).expanduser() if arguments.tildeexpand and value.startswith("~") else value)
    return 0


if __name__ == "__main__":
    sys.exit(main())
