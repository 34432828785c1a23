"""Reads INI files by LinuxCNC's rules and says where everything stands; used by every process of a controller.

The rules, as Debian's ``inivar`` shows them: section and key names are case sensitive; a line is a comment when its
first character that is not blank is ``#`` or ``;``, and there are no comments behind a value; a key without a value
counts as absent; a key may be repeated (``findall``); a backslash at the end of a line joins the next one; only the
first section of a name is searched. ``#INCLUDE file`` at the start of a line puts that file in its place.

A getter remembers what was read: ``unread()`` names the entries that nobody asked for, most often misspelt ones.
"""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeVar, overload

from nml.errors import ConfigError, Place

D = TypeVar("D")
N = TypeVar("N", int, float)

TRUE_WORDS = frozenset({"TRUE", "YES", "1", "ON"})
FALSE_WORDS = frozenset({"FALSE", "NO", "0", "OFF"})
MAX_INCLUDE_DEPTH = 16

_SECTION = re.compile(r"\[([^]]*)\]")
_INCLUDE = re.compile(r"#INCLUDE\s+(\S.*)")
_REMARK = re.compile(r"\s+[#;].*$")


class _Required:
    """Stands for 'no default': the entry must be there."""


REQUIRED: Final = _Required()


@dataclass(slots=True)
class Entry:
    """One ``KEY = value`` of the file; ``hidden`` in a second section of the same name, which is not searched."""

    section: str
    key: str
    value: str
    place: Place
    hidden: bool = False
    read: bool = False


class IniFile:
    """An INI file with all that it includes. ConfigError when a file cannot be read."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.file = Path(path)
        self.remarks: list[str] = []
        """Lines that mean nothing, as ``file:line: what is wrong``."""
        self._entries: dict[str, dict[str, list[Entry]]] = {}
        self._hidden: list[Entry] = []
        self._parse()

    @overload
    def find(self, section: str, key: str, default: None = None, num: int = 1) -> str | None: ...
    @overload
    def find(self, section: str, key: str, default: str, num: int = 1) -> str: ...
    def find(self, section: str, key: str, default: str | None = None, num: int = 1) -> str | None:
        """The value of the ``num``-th ``key`` of ``section``, counted from 1."""
        entry = self._entry(section, key, num)
        return entry.value if entry else default

    def findall(self, section: str, key: str) -> list[str]:
        """The values of every ``key`` of ``section``, in order."""
        entries = self._entries.get(section, {}).get(key, [])
        for entry in entries:
            entry.read = True
        return [entry.value for entry in entries]

    def sections(self) -> list[str]:
        """The section names in the order of the file."""
        return list(self._entries)

    def keys(self, section: str) -> list[str]:
        """The different keys of ``section`` in the order of the file."""
        return list(self._entries.get(section, {}))

    def place(self, section: str, key: str, num: int = 1) -> Place:
        """Where an entry stands; the file alone where there is none."""
        entries = self._entries.get(section, {}).get(key, [])
        return entries[num - 1].place if 0 < num <= len(entries) else Place(str(self.file))

    def unread(self) -> list[Entry]:
        """Entries that nobody asked for, in the order of the file; hidden ones are always among them."""
        visible = (entry for keys in self._entries.values() for group in keys.values() for entry in group)
        return [entry for entry in visible if not entry.read] + self._hidden

    @overload
    def integer(
        self, section: str, key: str, *, minimum: int | None = None, maximum: int | None = None, num: int = 1
    ) -> int: ...
    @overload
    def integer(
        self,
        section: str,
        key: str,
        default: D,
        *,
        minimum: int | None = None,
        maximum: int | None = None,
        num: int = 1,
    ) -> int | D: ...
    def integer(
        self,
        section: str,
        key: str,
        default: Any = REQUIRED,
        *,
        minimum: int | None = None,
        maximum: int | None = None,
        num: int = 1,
    ) -> Any:
        """A whole number, decimal or with ``0x``; ConfigError names file, line, key and limits."""
        return self._typed(section, key, default, num, _integer, "a whole number", minimum, maximum)

    @overload
    def real(
        self, section: str, key: str, *, minimum: float | None = None, maximum: float | None = None, num: int = 1
    ) -> float: ...
    @overload
    def real(
        self,
        section: str,
        key: str,
        default: D,
        *,
        minimum: float | None = None,
        maximum: float | None = None,
        num: int = 1,
    ) -> float | D: ...
    def real(
        self,
        section: str,
        key: str,
        default: Any = REQUIRED,
        *,
        minimum: float | None = None,
        maximum: float | None = None,
        num: int = 1,
    ) -> Any:
        """A number."""
        return self._typed(section, key, default, num, _real, "a number", minimum, maximum)

    @overload
    def boolean(self, section: str, key: str, *, num: int = 1) -> bool: ...
    @overload
    def boolean(self, section: str, key: str, default: D, *, num: int = 1) -> bool | D: ...
    def boolean(self, section: str, key: str, default: Any = REQUIRED, *, num: int = 1) -> Any:
        """TRUE, YES, ON, 1 or FALSE, NO, OFF, 0, in any case."""
        return self._typed(section, key, default, num, _boolean, "TRUE, YES, ON, 1, FALSE, NO, OFF or 0")

    @overload
    def path(self, section: str, key: str, *, num: int = 1) -> Path: ...
    @overload
    def path(self, section: str, key: str, default: D, *, num: int = 1) -> Path | D: ...
    def path(self, section: str, key: str, default: Any = REQUIRED, *, num: int = 1) -> Any:
        """A file name; ``~`` is the home folder, a relative one starts at the INI file's folder."""
        return self._typed(section, key, default, num, self.resolve, "a file name")

    @overload
    def choice(self, section: str, key: str, table: Mapping[str, N], *, num: int = 1) -> N: ...
    @overload
    def choice(self, section: str, key: str, table: Mapping[str, N], default: D, *, num: int = 1) -> N | D: ...
    def choice(
        self, section: str, key: str, table: Mapping[str, Any], default: Any = REQUIRED, *, num: int = 1
    ) -> Any:
        """What ``table`` has for the word of the file, whatever its case."""
        words = {word.upper(): meaning for word, meaning in table.items()}
        return self._typed(section, key, default, num, lambda text: words[text.upper()], f"one of {', '.join(table)}")

    def words(self, section: str, key: str, default: str = "", *, num: int = 1) -> list[str]:
        """A command line or a file name with arguments, split as a shell does; ConfigError where a quote stays open."""
        try:
            return shlex.split(self.find(section, key, default, num))
        except ValueError:
            raise self.error(section, key, f"{self.find(section, key)}: a quote stays open; close it", num) from None

    def resolve(self, name: str) -> Path:
        """The path that a file name in this INI file means."""
        return (self.file.parent / os.path.expanduser(name)).absolute()

    def error(self, section: str, key: str, message: str, num: int = 1) -> ConfigError:
        """An error about an entry, to raise: names the place and the entry."""
        return ConfigError(f"[{section}]{key}: {message}", self.place(section, key, num))

    def _entry(self, section: str, key: str, num: int) -> Entry | None:
        entries = self._entries.get(section, {}).get(key, [])
        if not 0 < num <= len(entries):
            return None
        entry = entries[num - 1]
        entry.read = True
        return entry

    def _typed(
        self,
        section: str,
        key: str,
        default: Any,
        num: int,
        convert: Callable[[str], Any],
        wanted: str,
        minimum: float | None = None,
        maximum: float | None = None,
    ) -> Any:
        limits = _limits(minimum, maximum)
        entry = self._entry(section, key, num)
        if entry is None:
            if default is REQUIRED:
                raise self.error(section, key, f"missing; {wanted}{limits} is needed")
            return default
        try:
            value = convert(entry.value)
        except (ValueError, KeyError):
            raise self.error(section, key, f"{entry.value!r} is not {wanted}{limits}", num) from None
        if (minimum is not None and value < minimum) or (maximum is not None and value > maximum):
            raise self.error(section, key, f"{entry.value} is out of range; {wanted}{limits} is allowed", num)
        return value

    def _parse(self) -> None:
        closed: set[str] = set()
        section: str | None = ""
        hidden = False
        self._entries[""] = {}
        for text, place in _logical_lines(self.file, self.remarks):
            if heading := _SECTION.match(text):
                closed.add(section or "")
                section = heading[1]
                hidden = section in closed
                if hidden:
                    self.remarks.append(f"{place}: a second section [{section}] is not searched")
                else:
                    self._entries.setdefault(section, {})
                continue
            key, equals, value = text.partition("=")
            key, value = key.strip(), value.strip()
            if not equals or not key:
                self.remarks.append(f"{place}: {text!r} is no section, comment or KEY = value")
                continue
            if not value:
                continue
            entry = Entry(section or "", key, value, place, hidden)
            if hidden:
                self._hidden.append(entry)
            else:
                self._entries[entry.section].setdefault(key, []).append(entry)
        if not self._entries[""]:
            del self._entries[""]


def _logical_lines(path: Path, remarks: list[str], depth: int = 0) -> Iterator[tuple[str, Place]]:
    """Lines that mean something: continuations joined, included files in their place, comments and blanks dropped."""
    if depth > MAX_INCLUDE_DEPTH:
        message = f"#INCLUDE goes {MAX_INCLUDE_DEPTH} files deep; does a file include itself?"
        raise ConfigError(message, Place(str(path)))
    joined, start = "", 0
    for number, line in enumerate(_lines(path), 1):
        if not joined:
            start = number
            if include := _INCLUDE.match(line):
                included = path.parent / os.path.expanduser(os.path.expandvars(include[1].strip()))
                if os.path.isfile(included):
                    yield from _logical_lines(included, remarks, depth + 1)
                else:
                    remarks.append(f"{path}:{number}: #INCLUDE of a missing file: {included}")
                continue
            if line.lstrip()[:1] in ("", "#", ";"):
                continue
        if line.endswith("\\"):
            joined += line[:-1]
            continue
        yield (joined + line).strip(), Place(str(path), start)
        joined = ""
    if joined.strip():
        yield joined.strip(), Place(str(path), start)


def _lines(path: Path) -> list[str]:
    """Lines end with LF or CR LF; any other character, a lone CR too, is part of one, as for LinuxCNC."""
    try:
        with path.open(encoding="utf-8", errors="surrogateescape", newline="") as file:
            lines = [line.removesuffix("\r") for line in file.read().split("\n")]
    except OSError as error:
        raise ConfigError(f"cannot read the INI file: {error.strerror}", Place(str(path))) from None
    for number, line in enumerate(lines, 1):
        if "\0" in line:
            wrong = "a zero byte, so this is no INI file; one is plain text, in UTF-8"
            raise ConfigError(wrong, Place(str(path), number))
    return lines


def _number(text: str) -> str:
    """The number in a value that a remark follows; LinuxCNC's own files have such lines."""
    return _REMARK.sub("", text)


def _integer(text: str) -> int:
    digits = _number(text)
    try:
        return int(digits, 0)
    except ValueError:
        return int(digits)


def _real(text: str) -> float:
    value = float(_number(text))
    if value != value or value in (float("inf"), float("-inf")):
        raise ValueError(text)
    return value


def _boolean(text: str) -> bool:
    word = _number(text).upper()
    if word in TRUE_WORDS:
        return True
    if word in FALSE_WORDS:
        return False
    raise ValueError(text)


def _limits(minimum: float | None, maximum: float | None) -> str:
    if minimum is not None and maximum is not None:
        return f" from {minimum} to {maximum}"
    if minimum is not None:
        return f", at least {minimum}"
    if maximum is not None:
        return f", at most {maximum}"
    return ""
