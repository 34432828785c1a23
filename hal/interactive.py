"""The interactive shell of ``halcmd`` and ``halrun``: a prompt, history, and completion of commands and names."""

from __future__ import annotations

import glob
import sys
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from hal import commands
from hal._shm import PARAM, PIN, USER
from hal.show import Save
from hal.values import TYPES
from nml.errors import HalError, Place

if TYPE_CHECKING:
    from hal.session import Session

PROMPT = "halcmd: "


class Completer:
    """What may stand at a place of a command line, by command and position."""

    def __init__(self, session: Session) -> None:
        segment = session.hal.segment
        pins: Callable[[], list[str]] = lambda: [p.shown for p in segment.items(PIN)]  # noqa: E731
        params: Callable[[], list[str]] = lambda: [p.shown for p in segment.items(PARAM)]  # noqa: E731
        items: Callable[[], list[str]] = lambda: pins() + params()  # noqa: E731
        signals: Callable[[], list[str]] = lambda: [s.name for s in segment.signals()]  # noqa: E731
        functs: Callable[[], list[str]] = lambda: [f.name for f in segment.functs()]  # noqa: E731
        threads: Callable[[], list[str]] = lambda: [t.name for t in segment.threads()]  # noqa: E731
        comps: Callable[[], list[str]] = lambda: [c.name for c in segment.comps()]  # noqa: E731
        users: Callable[[], list[str]] = lambda: [c.name for c in segment.comps() if c.kind == USER]  # noqa: E731
        kinds = ["comp", "pin", "sig", "param", "funct", "thread", "alias", "all"]
        self._words: dict[str, list[Callable[[], Iterable[str]]]] = {
            "loadrt": [_modules],
            "unload": [comps],
            "unloadrt": [session.host.loaded],
            "unloadusr": [users],
            "waitusr": [users],
            "net": [signals, pins],
            "linkps": [pins, signals],
            "linksp": [signals, pins],
            "linkpp": [pins],
            "unlinkp": [pins],
            "newsig": [list, lambda: TYPES],
            "delsig": [signals],
            "setp": [items],
            "getp": [items],
            "ptype": [items],
            "sets": [signals],
            "gets": [signals],
            "stype": [signals],
            "addf": [functs, threads],
            "delf": [functs, threads],
            "show": [lambda: kinds, items],
            "list": [lambda: kinds, items],
            "save": [lambda: Save(session.hal).tables],
            "status": [lambda: ["lock", "mem", "all"]],
            "lock": [lambda: ["none", "tune", "all"]],
            "unlock": [lambda: ["tune", "all"]],
            "alias": [lambda: ["pin", "param"], items],
            "unalias": [lambda: ["pin", "param"], items],
            "help": [lambda: commands.TABLE],
        }

    def candidates(self, before: list[str], text: str) -> list[str]:
        """Words beginning with ``text`` that may follow the words ``before``."""
        if not before:
            known: Iterable[str] = commands.TABLE
        elif before[0] == "source":
            known = glob.glob(text + "*")
        else:
            makers = self._words.get(before[0], [])
            known = makers[min(len(before), len(makers)) - 1]() if makers else []
        return sorted(word for word in set(known) if word.startswith(text))


def _modules() -> list[str]:
    from hal.components import names
    from hal.finder import realtime_modules

    return [*names(), *realtime_modules()]


def _install(completer: Completer) -> None:
    try:
        import readline
    except ImportError:
        return

    def complete(text: str, number: int) -> str | None:
        before = readline.get_line_buffer()[: readline.get_begidx()].split()
        found = completer.candidates(before, text)
        return found[number] + " " if number < len(found) else None

    readline.set_completer_delims(" \t\n")
    readline.set_completer(complete)
    readline.parse_and_bind("tab: complete")


def run(session: Session) -> bool:
    """Read commands until end of input or ``quit`` (which raises); a failed one does not end the shell."""
    _install(Completer(session))
    number = 0
    while True:
        try:
            line = input(PROMPT)
        except EOFError:
            print()
            return True
        except KeyboardInterrupt:
            print()
            continue
        number += 1
        session.place = Place("<stdin>", number)
        try:
            session.run_line(line)
        except KeyboardInterrupt:
            print()
            session.report(HalError("interrupted"))
        sys.stdout.flush()
