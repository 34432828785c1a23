"""One client of linuxcncrsh: its settings, and the words that it says turned into replies.

A session does no input or output: `answer` takes one line and returns the reply, so it can be tested without a socket.
Each session has channels of its own to the machine. The reply to an order waits for its end, or for its being received,
as WAIT_MODE says; until then no connection may give another order, except for E-stop, machine off and abort.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Container
from typing import TYPE_CHECKING

import linuxcnc
from gui import rsh_help
from gui import rsh_values as values
from gui.rsh_get import GETTERS, UNANSWERED
from gui.rsh_set import SETTERS, Access, Setting
from gui.rsh_words import Arguments, Refused, split
from nml import clock

if TYPE_CHECKING:
    from gui.linuxcncrsh import Server

EOL = "\r\n"
LOOK = 0.2  # host seconds between looks whether a wait was given up
STATE_TIMEOUT = 1.0  # host seconds that a change of the machine's state may take
HEARTBEAT_TIMEOUT = 1.0  # s that a client may wait for the servo thread
MESSAGES_KEPT = 100  # of each kind that a client has not asked for
LONGEST_NAME = 80  # characters of a client's name
VERSION = "1.1"  # of the protocol, where the INI file names none

MESSAGE_KINDS = {
    linuxcnc.NML_ERROR: "error",
    linuxcnc.OPERATOR_ERROR: "error",
    linuxcnc.NML_TEXT: "text",
    linuxcnc.OPERATOR_TEXT: "text",
    linuxcnc.NML_DISPLAY: "display",
    linuxcnc.OPERATOR_DISPLAY: "display",
}


class Session:
    """The state of one connection; ``number`` tells connections apart."""

    def __init__(self, server: Server, number: int) -> None:
        self.server = server
        self.number = number
        self.client = f"Default-{number}"
        self.linked: bool = False
        self.enabled: bool = False
        self.echo: bool = True
        self.verbose: bool = False
        self.fresh: bool = True
        self.timestamp: bool = False
        self.readable_time: bool = False
        self.version: str = VERSION
        self.comm_mode: str = "ASCII"
        self.wait_mode: str = "DONE"
        self.timeout: float = 0.0  # host seconds, 0: for ever
        self.linear_conversion: str = "AUTO"
        self.angular_conversion: str = "AUTO"
        self.program: str = ""
        self.first_line: int = 0
        self.closing: bool = False
        self.shutting_down: bool = False
        self.command: linuxcnc.command = linuxcnc.command()
        self._status = linuxcnc.stat()
        self._errors = linuxcnc.error_channel()
        self._messages: dict[str, deque[str]] = {}
        self._reply: list[str] = []

    # --- what the tables of commands use ---------------------------------------------------------------------------

    @property
    def status(self) -> linuxcnc.stat:
        """The status, fresh unless the client wants stale values."""
        if self.fresh:
            self._status.poll()
        return self._status

    def renew(self) -> None:
        """Take the newest status for a client that wants stale values otherwise."""
        self._status.poll()

    def say(self, text: str) -> None:
        """Add a line to the reply."""
        self._reply.append(f"{self._stamp()}{text}{EOL}")

    def warn(self, text: str) -> None:
        self.say(f"warning: {text}")

    def _stamp(self) -> str:
        if not self.timestamp:
            return ""
        now = time.time()
        seconds = time.strftime("%F %T", time.localtime(now)) if self.readable_time else f"{int(now)}"
        return f"{seconds}.{int(now % 1.0 * 1e6):06}: "

    def ini(self, section: str, key: str) -> str | None:
        """A value of the machine's INI file."""
        return linuxcnc.ini(self._status.ini_filename).find(section, key)

    def message(self, kind: str) -> str:
        """The oldest message of a kind that was not asked for yet."""
        while (message := self._errors.poll()) is not None:
            number, text = message
            kept = self._messages.setdefault(MESSAGE_KINDS.get(number, "text"), deque(maxlen=MESSAGES_KEPT))
            kept.append(text)
        waiting = self._messages.get(kind)
        return waiting.popleft() if waiting else "OK"

    @property
    def display_linear_units(self) -> str:
        if self.linear_conversion != "AUTO":
            return self.linear_conversion
        return values.PROGRAM_UNITS.get(self.status.program_units, values.CUSTOM)

    @property
    def display_angular_units(self) -> str:
        return "DEG" if self.angular_conversion == "AUTO" else self.angular_conversion

    def displayed(self, length: float) -> float:
        """A length in machine units turned into the units of the display."""
        return length / self._status.linear_units * values.LINEAR_UNITS.get(self.display_linear_units, 1.0)

    # --- waiting ---------------------------------------------------------------------------------------------------

    def wait_until(self, condition: Callable[[linuxcnc.stat], bool], timeout: float) -> bool:
        """Wait for a state of the machine; false after ``timeout`` host seconds, or when linuxcncrsh ends."""
        deadline = clock.host_now() + timeout
        self._status.poll()
        while not condition(self._status):
            left = deadline - clock.host_now()
            if left <= 0.0 or self.server.over:
                return False
            self._status.wait(min(left, LOOK))
            self._status.poll()
        return True

    def reach(self, condition: Callable[[linuxcnc.stat], bool], what: str) -> None:
        """Wait for the state that an order brings about; Refused when it does not come."""
        if not self.wait_until(condition, STATE_TIMEOUT):
            raise Refused(f"Waiting for '{what}' failed")

    def wait_heartbeats(self, periods: int) -> None:
        """Wait until the servo thread has run so many times; Refused when that would take, or takes, too long."""
        needed = periods * self._status.cycle_time
        if needed > HEARTBEAT_TIMEOUT:
            raise Refused(
                f"Invalid periods '{periods}', waiting time of {needed:.3f} seconds would exceed timeout of "
                f"{HEARTBEAT_TIMEOUT:.3f} seconds"
            )
        self._status.poll()
        before = self._status.heartbeat
        if not self.wait_until(lambda s: (s.heartbeat - before) % 2**32 >= periods, HEARTBEAT_TIMEOUT):
            raise Refused

    def wait_done(self) -> None:
        """Wait for the end of the last order; Refused when it failed or the timeout is over."""
        deadline = clock.host_now() + self.timeout if self.timeout > 0.0 else float("inf")
        while (result := self.command.wait_complete(LOOK)) == -1:
            if clock.host_now() > deadline or self.server.over:
                raise Refused("timed out")
        if result == linuxcnc.RCS_ERROR:
            raise Refused

    def require_no_order(self, what: str) -> None:
        """Refused while an order is under way."""
        if self.server.order_under_way:
            raise Refused(f"Cannot issue '{what}' while another command is being processed")

    # --- the protocol ----------------------------------------------------------------------------------------------

    def answer(self, line: str) -> str:
        """The reply to one line, with its line ends; empty where there is nothing to say."""
        verb, name, arguments = split(line)
        if not verb:
            return ""
        known = VERBS.get(verb)
        words = len(arguments) + bool(name)
        if known is None:
            self.say(f"error: Command '{line.split()[0]}' not found")
        elif words < LEAST_WORDS.get(verb, 0):
            self.say(f"error: Too few arguments for '{line.split()[0]}' command")
        else:
            if self.echo and self.linked and verb != "HELLO":
                self.say(line)
            known(self, name, arguments, line)
        reply = "".join(self._reply)
        self._reply.clear()
        return reply

    def _hello(self, name: str, arguments: Arguments, line: str) -> None:
        password, client, *version = line.split()[1:]
        self.linked = self.enabled = False
        if len(client) > LONGEST_NAME:
            self.say(f"error: Hostname too long. Max length allowed is {LONGEST_NAME}")
        if len(client) > LONGEST_NAME or password != self.server.connect_password:
            self.say("HELLO NAK")
            return
        ours = self.ini("EMC", "VERSION") if self._status.ini_filename else None
        ours = ours or VERSION
        self.command.origin = f"linuxcncrsh: {client}"
        self.client, self.version, self.linked = client, (version or [VERSION])[0], True
        if self.version > ours:
            self.warn(f"Requested version '{self.version}' is newer than '{ours}' from [EMC]VERSION")
        self.say(f"HELLO ACK {self.server.name} {ours}")

    def _get(self, name: str, arguments: Arguments, line: str) -> None:
        if name in UNANSWERED:
            return
        question = GETTERS.get(name)
        if question is None:
            self._unknown("GET", name, SETTERS, line)
            return
        try:
            _require(arguments, question.least, f"GET {name}")
            answer = question.answer(self, arguments)
        except (Refused, linuxcnc.error) as reason:
            self._refuse(f"GET {name} NAK", reason)
            return
        for text in [answer] if isinstance(answer, str) else answer:
            self.say(f"{question.said or name} {text}".rstrip())

    def _set(self, name: str, arguments: Arguments, line: str) -> None:
        setting = SETTERS.get(name)
        if setting is None:
            self._unknown("SET", name, GETTERS, line)
            return
        try:
            _require(arguments, setting.least, f"SET {name}")
            self._require_access(setting, name)
            if not setting.order:
                setting.act(self, arguments)
            elif not self._carry_out(setting, name, arguments):
                return
        except (Refused, linuxcnc.error) as reason:
            self._refuse(f"SET {name} NAK", reason)
            return
        if self.verbose:
            self.say(f"SET {name} ACK")

    def _require_access(self, setting: Setting, name: str) -> None:
        if setting.access >= Access.HELLO and not self.linked:
            raise Refused(f"A HELLO must be successfully negotiated for SET {name}")
        if setting.access >= Access.ENABLED and not self.enabled:
            raise Refused(f"Connection must be enabled for SET {name}")
        if setting.access >= Access.MACHINE_ON:
            self._status.poll()
            if self._status.task_state != linuxcnc.STATE_ON:
                raise Refused(f"Machine must be 'ON' for SET {name}")

    def _carry_out(self, setting: Setting, name: str, arguments: Arguments) -> bool:
        """Give an order and wait as the client wants it; false when another order is under way."""
        other = self.server.begin_order(name)
        if other:
            self.say(f"error: Cannot issue SET {name} command while SET {other} command is still active")
            return False
        try:
            setting.act(self, arguments)
            if setting.waits and self.wait_mode == "DONE":
                self.wait_done()
            elif self.command.wait_complete(0.0) == linuxcnc.RCS_ERROR:
                raise Refused
        finally:
            self.server.end_order()
        return True

    def _unknown(self, verb: str, name: str, others: Container[str], line: str) -> None:
        """Refuse a word that the verb does not know; ``others``: those of the other verb."""
        if name in others:
            self.say(f"{verb} {name} NAK")
        else:
            self.say(f"error: Subcommand not found: {verb} {line.split()[1]}")
            self.say(f"{verb} NAK")

    def _refuse(self, reply: str, reason: Exception) -> None:
        """Say why, where there is something to say, and the refusal."""
        if str(reason):
            self.say(f"error: {reason}")
        self.say(reply)

    def _quit(self, name: str, arguments: Arguments, line: str) -> None:
        self.closing, self.enabled = True, False
        self.say("QUIT ACK")

    def _shutdown(self, name: str, arguments: Arguments, line: str) -> None:
        if self.enabled:
            self.closing = self.shutting_down = True
            self.say("SHUTDOWN ACK")
        else:
            self.say("error: SHUTDOWN failed, not enabled")
            self.say("SHUTDOWN NAK")

    def _help(self, name: str, arguments: Arguments, line: str) -> None:
        for text in rsh_help.help_on(name):
            self.say(text)


def _require(arguments: Arguments, least: int, what: str) -> None:
    if len(arguments) < least:
        raise Refused(f"Too few arguments to {what}, have {len(arguments)}, need {least} or more")


LEAST_WORDS = {"GET": 1, "SET": 1, "HELLO": 2}
VERBS: dict[str, Callable[[Session, str, Arguments, str], None]] = {
    "HELLO": Session._hello,
    "GET": Session._get,
    "SET": Session._set,
    "QUIT": Session._quit,
    "SHUTDOWN": Session._shutdown,
    "HELP": Session._help,
}
