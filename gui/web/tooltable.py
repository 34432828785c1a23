"""The tool table file for the page's editor: read whole, written whole or not at all. Remarks and other lines stay.

Lengths are machine units. After it has been written, io is told to load it; until then io's table is the old one.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from gui.web.calls import CallError
from gui.web.programfolder import replace_file, text_version

AXES = "XYZABCUVW"
NUMBERS = {"D": "diameter", "I": "frontangle", "J": "backangle"}
INTEGERS = {"T": "tool", "P": "pocket", "Q": "orientation"}
MOST_TOOLS = 1000
LARGEST = 1e6
KEYS = {"tool", "pocket", "offset", "diameter", "frontangle", "backangle", "orientation", "comment"}

_WORD = re.compile(r"([A-Za-z])\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)")


def read(path: Path) -> dict[str, Any]:
    """``version`` and ``tools`` of a table."""
    data = _bytes(path)
    lines = data.decode("utf-8", "replace").splitlines()
    return {"version": text_version(data), "tools": [tool for line in lines if (tool := parse(line)) is not None]}


def parse(line: str) -> dict[str, Any] | None:
    """The tool of a line; None for a line without one."""
    body, _, comment = line.partition(";")
    words = {letter.upper(): float(number) for letter, number in _WORD.findall(body)}
    if "T" not in words:
        return None
    tool: dict[str, Any] = {name: int(words.get(letter, 0)) for letter, name in INTEGERS.items()}
    tool |= {name: words.get(letter, 0.0) for letter, name in NUMBERS.items()}
    return tool | {"offset": [words.get(letter, 0.0) for letter in AXES], "comment": comment.strip()}


def write(path: Path, version: str, tools: list[Any]) -> str:
    """Replace the table; its new version. CallError where it has changed since ``version`` or a value is wrong."""
    data = _bytes(path)
    if text_version(data) != version:
        raise CallError("conflict", "the tool table was changed meanwhile", version=text_version(data))
    checked = check(tools)
    others = [line for line in data.decode("utf-8", "replace").splitlines() if parse(line) is None]
    text = "".join(f"{line}\n" for line in [*others, *(line_of(tool) for tool in checked)])
    replace_file(path, text.encode())
    return text_version(text.encode())


def check(tools: list[Any]) -> list[dict[str, Any]]:
    """The tools, each with all its keys; CallError names the one that is wrong."""
    if len(tools) > MOST_TOOLS:
        raise CallError("argument", "a table may have {most} tools", argument="tools", most=MOST_TOOLS)
    found = [_checked(tool, number) for number, tool in enumerate(tools, 1)]
    for key, what in (("tool", "tool {number} is there twice"), ("pocket", "pocket {number} is there twice")):
        seen: set[int] = set()
        for tool in found:
            if tool[key] in seen and (key == "tool" or tool[key] != 0):
                raise CallError("argument", what, argument="tools", number=tool[key])
            seen.add(tool[key])
    return found


def line_of(tool: dict[str, Any]) -> str:
    """The line of a tool."""
    words = [f"T{tool['tool']}", f"P{tool['pocket']}"]
    words += [f"{letter}{_number(value)}" for letter, value in zip(AXES, tool["offset"], strict=True) if value]
    words += [f"{letter}{_number(tool[name])}" for letter, name in NUMBERS.items() if tool[name]]
    if tool["orientation"]:
        words.append(f"Q{tool['orientation']}")
    return " ".join(words) + (f" ;{tool['comment']}" if tool["comment"] else "")


def _checked(tool: Any, row: int) -> dict[str, Any]:
    wrong = CallError("argument", "row {row} of the tool table is wrong", argument="tools", row=row)
    if not isinstance(tool, dict) or not set(tool) <= KEYS or "tool" not in tool:
        raise wrong
    whole: dict[str, Any] = {name: tool.get(name, 0) for name in INTEGERS.values()}
    whole |= {name: tool.get(name, 0.0) for name in NUMBERS.values()}
    whole["offset"], whole["comment"] = tool.get("offset", [0.0] * 9), tool.get("comment", "")
    numbers = whole["offset"] if isinstance(whole["offset"], list) and len(whole["offset"]) == len(AXES) else [None]
    reals = [*numbers, *(whole[name] for name in NUMBERS.values())]
    if not all(type(value) in (int, float) and abs(value) <= LARGEST for value in reals):
        raise wrong
    if not all(type(whole[name]) is int and 0 <= whole[name] <= 99999 for name in INTEGERS.values()):
        raise wrong
    if whole["tool"] < 1 or whole["orientation"] > 9:
        raise wrong
    if not isinstance(whole["comment"], str) or len(whole["comment"]) > 200 or not whole["comment"].isprintable():
        raise wrong
    return whole


def _number(value: float) -> str:
    return f"{value:.6f}".rstrip("0").rstrip(".")


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        return b""
    except OSError as reason:
        raise CallError("file", "{path} cannot be read: {reason}", path=path.name, reason=reason.strerror) from None
