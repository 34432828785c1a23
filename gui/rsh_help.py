"""What linuxcncrsh says to `help`; the lists come from the tables of commands themselves."""

from __future__ import annotations

from collections.abc import Iterable

from gui.rsh_get import GETTERS
from gui.rsh_set import SETTERS, Access

NEEDED = {
    Access.NOTHING: "  Without a HELLO:",
    Access.HELLO: "  After a HELLO:",
    Access.ENABLED: "  After SET ENABLE <password>:",
    Access.MACHINE_ON: "  After SET ENABLE <password>, while the machine is on:",
}


def _listed(rows: Iterable[tuple[str, str]]) -> list[str]:
    return [f"    {name} {usage}".rstrip() for name, usage in rows]


def _settings() -> list[str]:
    lines = []
    for access, heading in NEEDED.items():
        rows = [(name, one.usage) for name, one in SETTERS.items() if one.access is access]
        lines += [heading, *_listed(rows)]
    return lines


TOPICS: dict[str, list[str]] = {
    "": [
        "Available commands:",
        "  HELLO <password> <clientname> [<protocolversion>]",
        "  GET <command> [parameters...]",
        "  SET <command> [parameters...]",
        "  QUIT",
        "  SHUTDOWN",
        "  HELP [<command>]",
    ],
    "HELLO": [
        "Usage: HELLO <password> <clientname> [<protocolversion>]",
        "  The answer is HELLO ACK <servername> <protocolversion>, or HELLO NAK for a wrong password.",
    ],
    "GET": [
        "Usage: GET <command> [parameters...]",
        "  Command may be one of:",
        *_listed((name, one.usage) for name, one in GETTERS.items()),
    ],
    "SET": [
        "Usage: SET <command> [parameters...]",
        "  Command may be one of:",
        *_settings(),
    ],
    "QUIT": ["Usage: QUIT", "  Ends this connection; it needs neither HELLO nor ENABLE."],
    "SHUTDOWN": ["Usage: SHUTDOWN", "  Ends all connections, and the machine if this is its display."],
    "HELP": ["Usage: HELP [<command>]"],
}


def help_on(topic: str) -> list[str]:
    """The lines on one command, or the list of all."""
    return [*TOPICS.get(topic.upper(), [f"error: {topic} is not a valid command."]), ""]
