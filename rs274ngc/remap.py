"""What [RS274NGC]REMAP lines say: which code is done by which NGC procedure or Python function, and what it is given.

    REMAP = M400 modalgroup=10 argspec=Pq ngc=m400

``remapping`` executes what is defined here.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from nml.errors import ConfigError

CODE = re.compile(r"(?:([GM])(\d{1,3})(?:\.(\d))?|([TSF]))$", re.I)
ARGSPEC = re.compile(r"[@A-NP-Za-np-z^>]*$")
M_GROUPS = range(4, 11)
KEYS = {"py": "python"}
OPTIONS = frozenset(("modalgroup", "argspec", "ngc", "python", "prolog", "epilog"))


@dataclass(frozen=True, slots=True)
class Remap:
    """One remapped code."""

    name: str               # as LinuxCNC shows it: M400, G88.6, T
    letter: str             # G, M, T, S or F
    number: int             # G codes times 10; 0 for T, S, F
    group: int              # modal group
    argspec: str | None
    ngc: str | None
    python: str | None
    prolog: str | None
    epilog: str | None

    @property
    def key(self) -> str:
        """Under which the interpreter finds it."""
        return f"{self.letter}{self.number}"

    @property
    def positional(self) -> bool:
        """Are the words given as #1, #2 ...?"""
        return self.argspec is not None and "@" in self.argspec

    # The names under which Python code of LinuxCNC's remaps asks for these
    @property
    def remap_ngc(self) -> str | None:
        return self.ngc

    @property
    def remap_py(self) -> str | None:
        return self.python

    @property
    def motion_code(self) -> int:
        return self.number


def parse(text: str) -> Remap:
    """A REMAP line; ConfigError where it is wrong."""
    code, *options = text.split() or [""]
    match = CODE.match(code)
    if match is None:
        raise ConfigError(f"REMAP={text}: '{code}' is no code that can be remapped; G, M with a number, T, S or F can")
    letter = (match[1] or match[4]).upper()
    number = int(match[2] or 0) * (10 if letter == "G" else 1) + int(match[3] or 0)
    values: dict[str, str] = {}
    for option in options:
        key, equals, value = option.partition("=")
        key = KEYS.get(key.lower(), key.lower())
        if not equals or key not in OPTIONS:
            raise ConfigError(f"REMAP={text}: '{option}' is no option; {', '.join(sorted(OPTIONS))} are")
        values[key] = value
    if ("ngc" in values) == ("python" in values):
        raise ConfigError(f"REMAP={text}: needs either ngc= or python=")
    argspec = values.get("argspec")
    if argspec is not None and not ARGSPEC.match(argspec):
        raise ConfigError(f"REMAP={text}: argspec '{argspec}' has a character that names no word")
    return Remap(
        name=code.upper(),
        letter=letter,
        number=number,
        group=group_of(text, letter, values.get("modalgroup")),
        argspec=argspec,
        ngc=values.get("ngc"),
        python=values.get("python"),
        prolog=values.get("prolog"),
        epilog=values.get("epilog"),
    )


def group_of(text: str, letter: str, given: str | None) -> int:
    """The modal group: of a G code always motion, of an M code one with a place in the order of execution."""
    if letter == "G":
        if given not in (None, "1"):
            raise ConfigError(f"REMAP={text}: modalgroup={given}; a G code can only be in group 1")
        return 1
    if letter != "M":
        return 0
    if given is None:
        return 10
    if not given.isdigit() or int(given) not in M_GROUPS:
        raise ConfigError(f"REMAP={text}: modalgroup={given}; an M code can be in groups 4 to 10")
    return int(given)


def remaps_of(ini: Any) -> dict[str, Remap]:
    """All remapped codes of an INI file, by key."""
    found = [parse(text) for text in ini.findall("RS274NGC", "REMAP")]
    return {remap.key: remap for remap in found}
