"""inivalue --var=KEY [--sec=SECTION] [options] FILE: values of an INI file with their type, for scripts; also lists.

``inivalue --sections FILE`` and ``inivalue --variables FILE`` list what the file has. Exit code 0: found; 1: wrong
options, or the file cannot be read; 2: not found; 3: not of the type, or out of range.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator
from typing import NoReturn

from nml.errors import ConfigError
from nml.inifile import IniFile

WRONG, NOT_FOUND, NOT_VALID = 1, 2, 3
WORD = 1 << 64
"""An unsigned number that is written with a minus sign is this much larger."""


class Parser(argparse.ArgumentParser):
    """Wrong options end with 1: 2 says that there is no such entry."""

    def error(self, message: str) -> NoReturn:
        self.print_usage(sys.stderr)
        self.exit(WRONG, f"{self.prog}: {message}\n")


class Absent(Exception):
    """There is no such entry."""


def main(argv: list[str] | None = None) -> int:
    """Print values or names."""
    parser = _parser()
    arguments = parser.parse_args(argv)
    kind = arguments.type[:1].lower()
    if kind not in "iursb" or not kind:
        parser.error(f"--type is i, u, r, s or b, not {arguments.type!r}")
    if not (arguments.sections or arguments.variables or arguments.var):
        parser.error("--var, --sections or --variables is needed")
    try:
        ini = IniFile(arguments.file)
    except ConfigError as error:
        return _fail(error, WRONG)
    try:
        names = arguments.sections or arguments.variables
        lines = list(_listed(ini, arguments) if names else _asked(ini, arguments, kind))
    except Absent as error:
        return NOT_FOUND if arguments.quiet else _fail(error, NOT_FOUND)
    except ConfigError as error:
        return _fail(error, NOT_VALID)
    except (LookupError, ValueError) as error:
        return _fail(error, WRONG)
    for line in lines:
        print(line)
    return 0


def _parser() -> Parser:
    parser = Parser(prog="inivalue", description="Print values of an INI file, or the names that are in it.")
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("-V", "--var", metavar="KEY")
    parser.add_argument("-S", "--sec", metavar="SECTION", default="", help="only in this section")
    parser.add_argument("-N", "--num", metavar="N", type=_count, help="the N-th of a repeated key, from 1")
    parser.add_argument("-a", "--all", action="store_true", help="all values of the key, from the N-th")
    parser.add_argument(
        "-y", "--type", default="s", help="i: whole number, u: without sign, r: real, b: yes or no, s: text"
    )
    parser.add_argument("-m", "--minimum", metavar="VALUE", help="the smallest number that is right")
    parser.add_argument("-M", "--maximum", metavar="VALUE", help="the greatest number that is right")
    parser.add_argument("-b", "--boolnum", action="store_true", help="1 and 0 for true and false")
    parser.add_argument("-B", "--boolpy", action="store_true", help="True and False, as in Python")
    parser.add_argument("-T", "--tildeexpand", action="store_true", help="put the home directory for ~ at the start")
    parser.add_argument("-q", "--quiet", action="store_true", help="no message for an entry that is not there")
    parser.add_argument("-e", "--sections", action="store_true", help="list the sections")
    parser.add_argument("-o", "--variables", action="store_true", help="list the keys, only those of --sec if given")
    parser.add_argument("-c", "--content", action="store_true", help="with -o: the values too")
    parser.add_argument("-p", "--prefix", action="store_true", help="with -o: the section before each key")
    return parser


def _count(text: str) -> int:
    number = int(text, 0)
    if number < 1:
        raise ValueError(text)
    return number


def _fail(reason: Exception, code: int) -> int:
    print(f"inivalue: {reason}", file=sys.stderr)
    return code


def _listed(ini: IniFile, arguments: argparse.Namespace) -> Iterator[str]:
    if arguments.sections:
        yield from ini.sections()
        return
    for section in [arguments.sec] if arguments.sec else ini.sections():
        for key in ini.keys(section):
            for value in ini.findall(section, key):
                prefix = f"[{section}]" if arguments.prefix else ""
                yield f"{prefix}{key}={value}" if arguments.content else f"{prefix}{key}"


def _asked(ini: IniFile, arguments: argparse.Namespace, kind: str) -> Iterator[str]:
    sections = [arguments.sec] if arguments.sec else ini.sections()
    entries = [(name, num) for name in sections for num in range(1, len(ini.findall(name, arguments.var)) + 1)]
    first = arguments.num or 1
    if len(entries) < first and not (arguments.all and arguments.num is None):
        raise Absent(f"[{arguments.sec}]{arguments.var}: there are {len(entries)} of them in {ini.file}, not {first}")
    for section, num in entries[first - 1 :] if arguments.all else entries[first - 1 : first]:
        yield _text(ini, section, num, arguments, kind)


def _text(ini: IniFile, section: str, num: int, arguments: argparse.Namespace, kind: str) -> str:
    """One value as its type is printed; ConfigError if it is not of the type."""
    key: str = arguments.var
    if kind == "b":
        yes = ini.boolean(section, key, num=num)
        return str(int(yes)) if arguments.boolnum else str(yes) if arguments.boolpy else str(yes).lower()
    if kind == "r":
        real = ini.real(section, key, minimum=_real(arguments.minimum), maximum=_real(arguments.maximum), num=num)
        return f"{real:.15g}" if arguments.all else f"{real:.15e}"
    if kind in "iu":
        low, high = _whole(arguments.minimum), _whole(arguments.maximum)
        if kind == "i":
            return str(ini.integer(section, key, minimum=low, maximum=high, num=num))
        return str(_unsigned(ini, section, key, num, low, high))
    value = ini.find(section, key, "", num)
    if arguments.tildeexpand and value.startswith("~/"):
        if "HOME" not in os.environ:
            raise LookupError(f"{value}: HOME is not set")
        return os.environ["HOME"] + value[1:]
    return value


def _unsigned(ini: IniFile, section: str, key: str, num: int, low: int | None, high: int | None) -> int:
    value = ini.integer(section, key, num=num)
    if value < 0:
        print(ini.error(section, key, "a minus sign is wrong here", num), file=sys.stderr)
    value %= WORD
    least, most = ((limit % WORD if limit is not None else other) for limit, other in ((low, 0), (high, WORD - 1)))
    if not least <= value <= most:
        raise ini.error(section, key, f"{value} is out of range; from {least} to {most} is allowed", num)
    return value


def _whole(text: str | None) -> int | None:
    return None if text is None else int(text, 0)


def _real(text: str | None) -> float | None:
    return None if text is None else float(text)


if __name__ == "__main__":
    sys.exit(main())
