"""STCP: the same questions as lines of text, messages in display encoding, for a person with a terminal or a script.

    peek(2,0):                            peek(2,17):+1999,+10784,...     newer than 17 next time: peek(2,17):
    write(1):+504,+24,+0,+3,              write(1,16):
    queue_length(1):                      queue_length(1):0

A line is ``verb(buffer number[,id of the last message]):text``; an error is answered by ``ERR:`` and the reason.
``help`` lists the verbs. A session takes bytes and gives bytes, as ``protocol.Session`` does for TCP.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from nml.net.forms import Kind
from nml.net.protocol import LOGIN_ATTEMPTS, OUTPUT_LIMIT, View
from nml.net.served import Desk
from nml.net.wire import LONGEST_LINE, CmsStatus, Request

_LINE = re.compile(rb"(\w+)\((\d{1,9})(?:,(\d{1,10}))?\):(.*)", re.DOTALL)
_NEVER = float("inf")


class TextSession:
    """The server's side of one STCP connection."""

    def __init__(self, desk: Desk) -> None:
        desk.kind = Kind.TEXT
        self._desk = desk
        self._inbox = bytearray()
        self._failed_logins = 0
        self.requests = 0
        self.closed = False

    @property
    def idle(self) -> bool:
        """Whether nothing is to be done before the next input."""
        return not (self._inbox or self.closed)

    @property
    def incomplete(self) -> bool:
        """Whether part of a line, or more, waits."""
        return bool(self._inbox)

    @property
    def congested(self) -> bool:
        return False

    @property
    def due(self) -> float:
        return _NEVER

    def tick(self, now: float) -> bytes:
        """Nothing is ever due: there are no subscriptions here."""
        return b""

    def receive(self, data: bytes, now: float) -> bytes:
        """Replies to what has arrived."""
        self._inbox += data
        return self.proceed(now)

    def proceed(self, now: float) -> bytes:
        """Answer the lines that wait, as far as the output limit allows."""
        out = bytearray()
        while not self.closed and len(out) < OUTPUT_LIMIT:
            line, newline, _ = self._inbox.partition(b"\n")
            if not newline:
                if len(line) > LONGEST_LINE:
                    self.closed = True
                    out += _error(f"a line has at most {LONGEST_LINE} bytes")
                break
            del self._inbox[: len(line) + 1]
            self.requests += 1
            out += self._answer(bytes(line.rstrip(b"\r")))
        return bytes(out)

    def _answer(self, line: bytes) -> bytes:
        if not line.strip():
            return b""
        if line.strip() == b"help":
            return " ".join([*_VERBS, "quit"]).encode() + b"\r\n"
        if line.strip() == b"quit":
            self.closed = True
            return b""
        match = _LINE.fullmatch(line)
        if match is None:
            return _error("a line is verb(buffer number): or verb(buffer number,id): with a text after the colon")
        verb, number, last, text = match.groups()
        action = _VERBS.get(verb.decode())
        if action is None:
            return _error(f"no verb {verb.decode()!r}; 'help' lists them")
        view = self._desk.view(int(number))
        if view is None:
            return _error(f"no buffer {int(number)}")
        return action(self, view, verb + b"(" + number, int(last or 0), text)

    def _name(self, view: View, start: bytes, last: int, text: bytes) -> bytes:
        return start + b"):" + view.name.encode() + b"\r\n"

    def _fetch(self, view: View, start: bytes, last: int, text: bytes) -> bytes:
        status, message_id, _, body = view.fetch(start.startswith(b"read"), last)
        if status < 0:
            return _error(CmsStatus.describe(status))
        return b"%s,%d):%s\r\n" % (start, message_id, body)

    def _store(self, view: View, start: bytes, last: int, text: bytes) -> bytes:
        number, status = view.store(text, start.startswith(b"write_if_read"))
        if status != CmsStatus.WRITE_OK:
            return _error(CmsStatus.describe(status))
        return b"%s,%d):\r\n" % (start, number)

    def _clear(self, view: View, start: bytes, last: int, text: bytes) -> bytes:
        status = view.clear()
        return _error(CmsStatus.describe(status)) if status < 0 else start + b"):\r\n"

    def _log_in(self, view: View, start: bytes, last: int, text: bytes) -> bytes:
        user, _, password = text.strip().partition(b" ")
        if view.log_in(user, password, b""):
            return start + b"):\r\n"
        self._failed_logins += 1
        self.closed = self._failed_logins >= LOGIN_ATTEMPTS
        return _error("wrong name or password")


_Action = Callable[[TextSession, View, bytes, int, bytes], bytes]


def _question(kind: Request) -> _Action:
    return lambda session, view, start, last, text: b"%s):%d\r\n" % (start, view.ask(kind)[1])


def _error(reason: str) -> bytes:
    return f"ERR:{reason}\r\n".encode()


_VERBS: Mapping[str, _Action] = {
    "name": TextSession._name,
    "read": TextSession._fetch,
    "peek": TextSession._fetch,
    "write": TextSession._store,
    "write_if_read": TextSession._store,
    "check_if_read": _question(Request.CHECK_IF_READ),
    "message_count": _question(Request.MESSAGE_COUNT),
    "queue_length": _question(Request.QUEUE_LENGTH),
    "space": _question(Request.SPACE),
    "clear": TextSession._clear,
    "login": TextSession._log_in,
}
