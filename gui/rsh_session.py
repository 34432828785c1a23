"""One client of linuxcncrsh: its settings, and the words that it says turned into replies.

A session does no input or output: `answer` takes one line and returns the reply, so it can be tested without a socket.
Each session has channels of its own to the machine; orders are given to the machine in the order of the lines.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

import linuxcnc
from gui import rsh_help, rsh_values
from gui.rsh_get import GETTERS
from gui.rsh_set import FREE, PROTOCOL, SETTERS, Refused

if TYPE_CHECKING:
    from gui.linuxcncrsh import Server

EOL = "\r\n"
FOREVER = 1e9  # s
MESSAGES_KEPT = 100  # of each kind that a client has not asked for


class Session:
    """The state of one connection."""

    def __init__(self, server: Server) -> None:
        self.server = server
        self.linked: bool = False
        self.echo: bool = True
        self.verbose: bool = False
        self.fresh: bool = True
        self.comm_mode: str = "ASCII"
        self.protocol: str = "1.0"
        self.set_wait: str = "RECEIVED"
        self.timeout: float = 0.0  # s, 0: forever
        self.linear_conversion: str = "AUTO"
        self.angular_conversion: str = "AUTO"
        self.closing = False
        self.command = linuxcnc.command()
        self._status = linuxcnc.stat()
        self._messages: dict[str, deque[str]] = {}

    # --- what the tables of commands use ---------------------------------------------------------------------------

    @property
    def status(self) -> linuxcnc.stat:
        """The status, fresh unless the client wants stale values."""
        if self.fresh:
            self._status.poll()
        return self._status

    @property
    def enabled(self) -> bool:
        """Whether this connection has control of the machine; one at a time has."""
        return self.server.in_control is self

    @enabled.setter
    def enabled(self, on: bool) -> None:
        if on:
            self.server.in_control = self
        elif self.enabled:
            self.server.in_control = None

    def wait_as_set(self) -> None:
        """After an order: wait for its end if the client wants that."""
        if self.set_wait == "DONE":
            self.wait_done()

    def wait_done(self) -> None:
        """Wait for the end of the last order; Refused when it failed or the timeout is over."""
        if self.command.wait_complete(self.timeout if self.timeout > 0.0 else FOREVER) != linuxcnc.RCS_DONE:
            raise Refused

    def note(self, kind: str, text: str) -> None:
        """An operator message came in."""
        self._messages.setdefault(kind, deque(maxlen=MESSAGES_KEPT)).append(text)

    def message(self, kind: str) -> str:
        """The oldest message of a kind that was not asked for yet."""
        waiting = self._messages.get(kind)
        return waiting.popleft() if waiting else "OK"

    @property
    def display_linear_units(self) -> str:
        if self.linear_conversion != "AUTO":
            return self.linear_conversion
        return rsh_values.PROGRAM_UNITS.get(self.status.program_units, "CUSTOM")

    @property
    def display_angular_units(self) -> str:
        return "DEG" if self.angular_conversion == "AUTO" else self.angular_conversion

    def displayed(self, value: float, linear: bool) -> float:
        """A value in machine units turned into the units of the display."""
        if linear:
            return value / self._status.linear_units * rsh_values.LINEAR_UNITS.get(self.display_linear_units, 1.0)
        return value / self._status.angular_units * rsh_values.ANGULAR_UNITS[self.display_angular_units]

    # --- the protocol ----------------------------------------------------------------------------------------------

    def answer(self, line: str) -> str:
        """The reply to one line, with its line ends; empty where there is nothing to say."""
        words = line.split()
        if not words:
            return ""
        echo = line + EOL if self.echo and self.linked else ""
        verb = VERBS.get(words[0].upper())
        return echo + (verb(self, words[1:]) if verb else "")

    def _hello(self, words: list[str]) -> str:
        if len(words) != 3 or words[0] != self.server.connect_password:
            return f"HELLO NAK{EOL}"
        self.linked = True
        return f"HELLO ACK {self.server.name} {PROTOCOL}{EOL}"

    def _get(self, words: list[str]) -> str:
        if not words:
            return f"GET NAK{EOL}"
        name = words[0].upper()
        getter = GETTERS.get(name)
        value = getter(self, words[1:]) if getter else None
        if value is None:
            return f"GET {name} NAK{EOL}"
        return f"{name} {value}".rstrip() + EOL

    def _set(self, words: list[str]) -> str:
        if not words or not self.linked:
            return f"SET NAK{EOL}"
        name = words[0].upper()
        setter = SETTERS.get(name)
        allowed = self.enabled or name in FREE
        try:
            if setter is None or not allowed:
                raise Refused
            setter(self, words[1:])
        except (Refused, linuxcnc.error):
            return f"SET {name} NAK{EOL}"
        return f"SET {name} ACK{EOL}" if self.verbose else ""

    def _quit(self, words: list[str]) -> str:
        self.closing = True
        return ""

    def _shutdown(self, words: list[str]) -> str:
        if not (self.linked and self.enabled):
            return f"SHUTDOWN NAK{EOL}"
        self.server.shut_down()
        return ""

    def _help(self, words: list[str]) -> str:
        return EOL.join([*rsh_help.help_on(words[0] if words else ""), "", ""])


VERBS = {
    "HELLO": Session._hello,
    "GET": Session._get,
    "SET": Session._set,
    "QUIT": Session._quit,
    "SHUTDOWN": Session._shutdown,
    "HELP": Session._help,
}
