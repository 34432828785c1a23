"""Reads and writes LinuxCNC's tool table files without losing a comment, an order or an unknown word.

One line is one tool: words of a letter and a number (T tool, P pocket, X to W offsets, D diameter, I and J lathe
angles, Q orientation), then a remark behind a semicolon. A ``ToolFile`` keeps every line as it was written; saving
changes only the words whose value changed, appends words that were not there, and replaces the file in one step.
Lengths in machine units.
"""

from __future__ import annotations

import os
import re
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from nml.errors import ConfigError, Place

AXIS_LETTERS = "XYZABCUVW"
_WORD = re.compile(r"([A-Za-z])\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?=\s|$|[A-Za-z])")


@dataclass(slots=True)
class Tool:
    """What the table knows of one tool."""

    toolno: int = -1
    pocketno: int = 0
    offset: list[float] = field(default_factory=lambda: [0.0] * 9)
    diameter: float = 0.0
    frontangle: float = 0.0
    backangle: float = 0.0
    orientation: int = 0
    remark: str = ""

    def copy(self) -> Tool:
        """An independent copy."""
        return Tool(
            self.toolno,
            self.pocketno,
            list(self.offset),
            self.diameter,
            self.frontangle,
            self.backangle,
            self.orientation,
            self.remark,
        )

    def words(self) -> dict[str, float]:
        """All values by the letter of their word, in the order of the manual's table."""
        values: dict[str, float] = {"T": self.toolno, "P": self.pocketno}
        values.update(zip(AXIS_LETTERS, self.offset, strict=True))
        values.update(D=self.diameter, I=self.frontangle, J=self.backangle, Q=self.orientation)
        return values

    def set_word(self, letter: str, value: float) -> None:
        """Take one word of a line; KeyError for a letter that the table does not know."""
        if letter in AXIS_LETTERS:
            self.offset[AXIS_LETTERS.index(letter)] = value
        else:
            name = _ATTRIBUTES[letter]
            setattr(self, name, int(value) if letter in _INTEGERS else value)


_ATTRIBUTES = {
    "T": "toolno",
    "P": "pocketno",
    "D": "diameter",
    "I": "frontangle",
    "J": "backangle",
    "Q": "orientation",
}
_INTEGERS = frozenset("TPQ")


def parse_line(text: str, place: Place | None = None) -> Tool | None:
    """The tool of one line; None for a line without one. ConfigError for a number that is none."""
    body, _, remark = text.partition(";")
    if not body.strip():
        return None
    tool = Tool(remark=remark.strip())
    seen: set[str] = set()
    for letter, value in _words(body, place):
        if letter in _ATTRIBUTES or letter in AXIS_LETTERS:
            tool.set_word(letter, value)
            seen.add(letter)
    for letter, name in (("T", "tool number"), ("P", "pocket number")):
        if letter not in seen:
            raise ConfigError(f"a tool needs a {name}; add a word like {letter}1", place)
    return tool


def _words(body: str, place: Place | None) -> list[tuple[str, float]]:
    found = []
    at = 0
    while at < len(body):
        if body[at].isspace():
            at += 1
            continue
        match = _WORD.match(body, at)
        if match is None:
            wrong = body[at:].split()[0]
            raise ConfigError(f"{wrong!r} is no word of a tool table; a letter and a number are, like Z1.5", place)
        letter, number = match[1].upper(), float(match[2])
        if letter in _INTEGERS and number != int(number):
            raise ConfigError(f"{match[0]!r}: a whole number is needed", place)
        found.append((letter, number))
        at = match.end()
    return found


def format_line(tool: Tool) -> str:
    """A fresh line for a tool: T, P and everything that is not zero."""
    parts = [_format_word(letter, value) for letter, value in tool.words().items() if value or letter in "TP"]
    return " ".join(parts) + (f" ;{tool.remark}" if tool.remark else "")


def _format_word(letter: str, value: float) -> str:
    if letter in _INTEGERS:
        return f"{letter}{int(value)}"
    return f"{letter}{value:+.6f}"


def update_line(text: str, tool: Tool) -> str:
    """``text`` with the words that differ from ``tool`` written anew and missing ones appended, nothing else."""
    body, semicolon, remark = text.partition(";")
    values = tool.words()
    last = {match[1].upper(): match.start() for match in _WORD.finditer(body)}

    def replace(match: re.Match[str]) -> str:
        letter = match[1].upper()
        if letter not in values or last[letter] != match.start() or float(match[2]) == values[letter]:
            return match[0]
        return _format_word(letter, values[letter])

    changed = _WORD.sub(replace, body)
    missing = [_format_word(letter, value) for letter, value in values.items() if value and letter not in last]
    if missing:
        stripped = changed.rstrip()
        gap = changed[len(stripped) :] or (" " if semicolon else "")
        changed = stripped + " " + " ".join(missing) + gap
    return changed + semicolon + remark


class ToolFile:
    """A tool table file: its lines as they are, and the tools in them.

    A line that is no tool, of LinuxCNC's old column format for instance, is kept but not used; ``remarks`` says why.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Read the file; ConfigError when it cannot be read."""
        self.path = Path(path)
        self.lines: list[str] = []
        self.tools: list[Tool] = []
        self.remarks: list[str] = []
        try:
            content = self.path.read_text(encoding="utf-8", errors="surrogateescape")
        except OSError as error:
            raise ConfigError(f"the tool table cannot be read: {error.strerror}", Place(str(self.path))) from None
        self._line_of: dict[int, int] = {}
        for number, line in enumerate(content.splitlines()):
            self.lines.append(line)
            try:
                self._take(number, line)
            except ConfigError as error:
                self.remarks.append(str(error))

    def _take(self, number: int, line: str) -> None:
        place = Place(str(self.path), number + 1)
        tool = parse_line(line, place)
        if tool is None:
            return
        if tool.toolno in self._line_of:
            first = self._line_of[tool.toolno] + 1
            raise ConfigError(f"T{tool.toolno} is in line {first} already; tool numbers must differ", place)
        self._line_of[tool.toolno] = number
        self.tools.append(tool)

    def place(self, toolno: int) -> Place:
        """Where a tool of the file stands."""
        return Place(str(self.path), self._line_of[toolno] + 1)

    def render(self, tools: list[Tool]) -> str:
        """The text of the file with these tools' values; lines of tools that are not among them stay as they are."""
        lines = list(self.lines)
        for tool in tools:
            number = self._line_of.get(tool.toolno)
            if number is None:
                lines.append(format_line(tool))
            else:
                lines[number] = update_line(lines[number], tool)
        return "\n".join(lines) + "\n"

    def adopt(self, text: str) -> None:
        """``text``, rendered from these lines, is what the file holds now."""
        before, self.lines = len(self.lines), text.splitlines()
        for number in range(before, len(self.lines)):
            tool = parse_line(self.lines[number])
            if tool is not None:
                self._line_of[tool.toolno] = number


def replace_file(path: Path, text: str) -> None:
    """Put ``text`` into the file at ``path`` in one step that no crash can tear; links and rights stay."""
    target = Path(os.path.realpath(path))
    descriptor, name = tempfile.mkstemp(prefix=f".{target.name}.", dir=target.parent)
    try:
        with os.fdopen(descriptor, "w", encoding="utf-8", errors="surrogateescape") as stream:
            if target.exists():
                os.fchmod(stream.fileno(), target.stat().st_mode & 0o7777)
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(name, target)
    except BaseException:
        os.unlink(name)
        raise
