"""Reading HAL commands: lines of a file, continuations, comments, substitution of INI and environment values, words.

``hal.session`` executes what comes out of here. Nothing here touches the HAL.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator

from nml.errors import HalError
from nml.inifile import IniFile

ARROWS = frozenset({"=>", "<=", "<=>", "==>", "<==", "<==>"})

_WORD = re.compile(r"""(?:"[^"]*"|'[^']*'|[^\s])+""")
_QUOTED_OR_COMMENT = re.compile(r""""[^"]*"|'[^']*'|(#.*)""")
_QUOTED = re.compile(r""""[^"]*"|'[^']*'""")
# An INI variable begins with its section, one of the environment with a dollar; then a name in brackets or a bare one.
_VARIABLE = re.compile(
    r"(?:\[(?P<section>[^\]]*)(?P<closed>\]?)|\$)(?:\((?P<bracketed>[^)]*)(?P<ended>\)?)|(?P<bare>[A-Za-z0-9_.-]*))"
)


def logical_lines(lines: Iterable[str]) -> Iterator[tuple[int, str]]:
    """(number of the last physical line, text) with continued lines joined."""
    held = ""
    number = 0
    for number, line in enumerate(lines, 1):
        text = line.rstrip("\r\n")
        if text.endswith("\\"):
            held += text[:-1]
            continue
        yield number, held + text
        held = ""
    if held:
        yield number, held


def strip_comment(line: str) -> str:
    """The line up to a ``#`` that is not in quotes."""
    for match in _QUOTED_OR_COMMENT.finditer(line):
        if match.group(1) is not None:
            return line[: match.start()]
    return line


def substitute(line: str, ini: IniFile | None) -> str:
    """Replace ``[SECTION]KEY``, ``[SECTION](KEY)``, ``$NAME`` and ``$(NAME)``; HalError for an unknown one."""

    def value(match: re.Match[str]) -> str:
        section, closed, bracketed, ended, bare = match.groups()
        if section is not None and not closed:
            raise HalError("Missing close square bracket.")
        if bracketed is not None and not ended:
            raise HalError("Missing close parenthesis.")
        name = bracketed or bare
        if not name:
            raise HalError(f"Empty variable name after '{match.group()}'.")
        if section is not None:
            return _ini_value(ini, section, name)
        found = os.environ.get(name)
        if found is None:
            raise HalError(f"Environment variable '{name}' not found.")
        return found

    return _VARIABLE.sub(value, line)


def _ini_value(ini: IniFile | None, section: str, key: str) -> str:
    if ini is None:
        raise HalError(f"Ini variable '[{section}]{key}' not found: no INI file was given with -i.")
    found = ini.find(section, key)
    if found is None:
        raise HalError(f"Ini variable '[{section}]{key}' not found.")
    return found


def split(line: str) -> list[str]:
    """The words of a line. Quotes hold a word together and stay in it, as LinuxCNC leaves them; HalError if open."""
    rest = _QUOTED.sub("", line)
    if '"' in rest or "'" in rest:
        raise HalError("unterminated quoted string")
    return _WORD.findall(line)


def words(line: str, ini: IniFile | None) -> list[str]:
    """The words of a command line, ready to execute; empty for a blank or comment line."""
    return split(substitute(strip_comment(line), ini))


def without_arrows(args: list[str]) -> list[str]:
    """Arrows show a reader where data flow; they mean nothing."""
    return [word for word in args if word not in ARROWS]
