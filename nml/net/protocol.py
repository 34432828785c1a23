"""What the server answers to one client: bytes in, bytes out, never a socket and never a clock of its own.

A ``Session`` takes what arrived, splits it into requests and answers each through the buffers it was given
(``served.Desk``). Nothing that a client sends makes it raise, wait or grow: input is held only until its request is
complete, output is made only up to ``OUTPUT_LIMIT`` before the caller has to take it away, and a body that is too long
is passed over. ``server`` owns the sockets and calls ``receive``, ``proceed`` and ``tick``.

Where LinuxCNC's server crashes, hangs or stops on a request, this one answers with a status or ignores the request.
"""

from __future__ import annotations

import secrets
import string
import struct
from collections.abc import Callable, Mapping
from typing import Protocol

from nml.net import wire
from nml.net.wire import MASK, Access, CmsStatus, Request, Subscription

OUTPUT_LIMIT = 65536
"""Bytes of replies made ahead of a client that does not take them; requests wait beyond that."""
SHORTEST_PERIOD = 0.010
"""s; the fastest push of a subscription, and how often a waiting read looks again."""
LOGIN_ATTEMPTS = 5
"""Failed log-ins before the connection is closed."""

_KEY_CHARACTERS = string.ascii_letters + string.digits
_NEVER = float("inf")


class View(Protocol):
    """One client's access to one buffer (``served`` has the implementations). Nothing here raises or waits."""

    @property
    def name(self) -> str: ...

    @property
    def confirm_write(self) -> bool: ...

    @property
    def may_read(self) -> bool: ...

    @property
    def can_block(self) -> bool: ...

    @property
    def largest_body(self) -> int: ...

    def fetch(self, consume: bool, last: int) -> tuple[int, int, int, bytes]:
        """status, id, was_read and encoded message for a client whose last message was ``last``."""

    def store(self, body: bytes, only_if_read: bool) -> tuple[int, int]:
        """Write an encoded message: its id and the status."""

    def ask(self, question: int) -> tuple[int, int]:
        """Answer to CHECK_IF_READ, MESSAGE_COUNT, QUEUE_LENGTH or SPACE: status and value."""

    def clear(self) -> int: ...

    def log_in(self, user: bytes, password: bytes, challenge: bytes) -> bool: ...

    def introduce(self, info: bytes) -> None:
        """What a client says of itself for the diagnostics."""

    def diagnostics(self, swapped: bool) -> tuple[int, bytes]: ...


class Desk(Protocol):
    """One client's place at the server: the buffers that it may address, in the form that it wants."""

    def view(self, number: int) -> View | None: ...

    def agree(self, checksum: int) -> bool:
        """A client that knows native images has this vocabulary checksum; whether it gets them from now on."""


class Pushes:
    """A subscription: whom it serves, how often, and when next."""

    __slots__ = ("due", "last", "period", "view")

    def __init__(self, view: View, period: float, due: float) -> None:
        self.view = view
        self.period = period
        self.due = due
        self.last = 0


class Wait:
    """A blocking read that has not been answered yet."""

    __slots__ = ("access", "deadline", "due", "last", "view")

    def __init__(self, view: View, access: int, last: int, deadline: float) -> None:
        self.view = view
        self.access = access
        self.last = last
        self.deadline = deadline
        self.due = 0.0


class Session:
    """The server's side of one connection."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._inbox = bytearray()
        self._skip = 0
        self._serial = 0
        self._views: dict[int, View | None] = {}
        self._subscriptions: dict[int, Pushes] = {}
        self._wait: Wait | None = None
        self._challenge = b""
        self._failed_logins = 0
        self._swapped = False
        self.errors = 0
        """Requests out of order or of unknown type."""
        self.requests = 0
        self.closed = False
        """The connection is to be closed once the output is gone."""

    # Bytes in, bytes out

    def receive(self, data: bytes, now: float) -> bytes:
        """Replies to what has arrived at ``now`` (s); more may follow from ``proceed`` once these are taken away."""
        self._inbox += data
        return self.proceed(now)

    def proceed(self, now: float) -> bytes:
        """Answer the requests that wait, as far as the output limit allows."""
        out = b""
        while self._inbox and self._wait is None and not self.closed and len(out) < OUTPUT_LIMIT:
            reply = self._next(now)
            if reply is None:
                break
            out = out + reply if out else reply
        return out

    @property
    def idle(self) -> bool:
        """Whether nothing is to be done before the next input."""
        return not (self._inbox or self._skip or self._subscriptions or self.closed or self._wait is not None)

    @property
    def incomplete(self) -> bool:
        """Whether the client owes the rest of a request."""
        return bool(self._skip) or (bool(self._inbox) and self._wait is None)

    @property
    def congested(self) -> bool:
        """Whether no more input should be taken before an earlier request is answered."""
        return self._wait is not None and len(self._inbox) > OUTPUT_LIMIT

    @property
    def due(self) -> float:
        """When ``tick`` has something to do (same clock as ``now``); infinity: only after further input."""
        if self._wait is not None:
            return self._wait.due
        if not self._subscriptions:
            return _NEVER
        return min(push.due for push in self._subscriptions.values())

    def tick(self, now: float) -> bytes:
        """Messages for subscribers and the answer to a blocking read, where their time has come."""
        out = b""
        if self._wait is not None:
            out = self._look_again(self._wait, now)
            if self._wait is None:
                out += self.proceed(now)
        for push in self._subscriptions.values():
            if push.due <= now and len(out) < OUTPUT_LIMIT:
                push.due = now + push.period
                out += self._push(push)
        return out

    # Framing

    def _next(self, now: float) -> bytes | None:
        """The reply to the next complete request (empty if it gets none); None if there is no complete one."""
        inbox = self._inbox
        if self._skip:
            gone = min(self._skip, len(inbox))
            del inbox[:gone]
            self._skip -= gone
        if len(inbox) < 20:
            return None
        serial, kind, number, word3, word4 = wire.REQUEST.unpack_from(inbox)
        view = self._views.get(number)
        if view is None:
            view = self._open(number)
        if kind == Request.WRITE:
            return self._take_write(serial, view, word3, word4)
        end = 20 + _EXTRA.get(kind, 0)
        if len(inbox) < end:
            return None
        extra = b"" if end == 20 else bytes(inbox[20:end])
        del inbox[:end]
        reply = self._count(serial)
        handler = _HANDLERS.get(kind)
        if handler is None:
            self.errors += 1
            return b""
        if view is None and kind != Request.CLOSE:
            return _refuse_unknown(kind, reply)
        return handler(self, view, reply, word3, word4, extra, number, now)

    def _count(self, serial: int) -> int:
        """Serial number of the reply to request ``serial``."""
        if serial != self._serial:
            self.errors += 1
        self.requests += 1
        self._serial = (serial + 1) & MASK
        return self._serial

    def _open(self, number: int) -> View | None:
        view = self._desk.view(number)
        if view is not None:
            self._views[number] = view
        return view

    # Reads

    def _read(
        self, view: View, reply: int, access: int, last: int, extra: bytes, number: int, now: float
    ) -> bytes:
        if access == Access.PEEK:
            consume = False
        elif access == Access.READ:
            consume = True
        else:
            return wire.READ_REPLY.pack(reply, CmsStatus.NOT_SET, 0, last, 1)
        status, message_id, was_read, body = view.fetch(consume, last)
        return wire.READ_REPLY.pack(reply, status, len(body), message_id, was_read) + body

    def _blocking_read(
        self, view: View, reply: int, access: int, last: int, extra: bytes, number: int, now: float
    ) -> bytes:
        (timeout_ms,) = _TIMEOUT.unpack(extra)
        if timeout_ms == 0:
            return self._read(view, reply, access, last, extra, number, now)
        if not view.can_block or not view.may_read:
            status = CmsStatus.PERMISSIONS_ERROR if view.can_block else CmsStatus.NO_BLOCKING_SEM_ERROR
            return wire.READ_REPLY.pack(reply, status, 0, last, 1)
        deadline = now + timeout_ms * 1e-3 if timeout_ms > 0 else _NEVER
        self._wait = Wait(view, access, last, deadline)
        return self._look_again(self._wait, now)

    def _look_again(self, wait: Wait, now: float) -> bytes:
        """The reply to a blocking read if there is news or its time is over, else nothing."""
        answer = self._read(wait.view, self._serial, wait.access, wait.last, b"", 0, now)
        status = wire.READ_REPLY.unpack_from(answer)[1]
        if status == CmsStatus.READ_OLD and now < wait.deadline:
            wait.due = now + SHORTEST_PERIOD
            return b""
        self._wait = None
        if status == CmsStatus.READ_OLD:
            return wire.READ_REPLY.pack(self._serial, CmsStatus.TIMED_OUT, 0, wait.last, 1)
        return answer

    # Writes

    def _take_write(self, serial: int, view: View | None, access: int, length: int) -> bytes | None:
        inbox = self._inbox
        if view is None or length > view.largest_body:
            del inbox[:20]
            self._count(serial)
            self._skip = length
            self.errors += 1
            return self._confirm(view, 0, CmsStatus.INSUFFICIENT_SPACE_ERROR)
        end = 20 + length
        if len(inbox) < end:
            return None
        body = bytes(inbox[20:end])
        del inbox[:end]
        self._count(serial)
        if access not in (Access.WRITE, Access.WRITE_IF_READ):
            return self._confirm(view, 0, CmsStatus.MISC_ERROR)
        return self._confirm(view, *view.store(body, access == Access.WRITE_IF_READ))

    @staticmethod
    def _confirm(view: View | None, message_id: int, status: int) -> bytes:
        if view is None or not view.confirm_write:
            return b""
        return wire.SHORT_REPLY.pack(message_id & MASK, status, 0)

    # Small questions

    def _ask(self, view: View, reply: int, kind: int) -> bytes:
        return wire.SHORT_REPLY.pack(reply, *view.ask(kind))

    def _clear(self, view: View, reply: int, *rest: object) -> bytes:
        return wire.STATUS_REPLY.pack(reply, view.clear())

    def _ignore(self, view: View, reply: int, *rest: object) -> bytes:
        """A remote client does not end the server."""
        return b""

    def _close(self, view: View | None, reply: int, *rest: object) -> bytes:
        self.closed = True
        return b""

    def _name(
        self, view: View, reply: int, magic: int, checksum: int, extra: bytes, number: int, now: float
    ) -> bytes:
        name = view.name.encode()[: wire.NAME_LENGTH]
        if magic == wire.EXTENDED_MAGIC:
            agreed = self._desk.agree(checksum)
            self._views.clear()
            if agreed and len(name) < 32 - len(wire.EXTENDED_MARK):
                name = name.ljust(32 - len(wire.EXTENDED_MARK), b"\0") + wire.EXTENDED_MARK
        return wire.NAME_REPLY.pack(reply, CmsStatus.NOT_SET, name)

    # Log-in and diagnostics

    def _keys(self, view: View, reply: int, *rest: object) -> bytes:
        self._challenge = "".join(secrets.choice(_KEY_CHARACTERS) for _ in range(16)).encode()
        return wire.KEYS_REPLY.pack(reply, self._challenge[:8], self._challenge[8:])

    def _log_in(
        self, view: View, reply: int, word3: int, word4: int, extra: bytes, number: int, now: float
    ) -> bytes:
        user, password = wire.LOGIN.unpack(extra)
        challenge, self._challenge = self._challenge, b""
        success = view.log_in(user.rstrip(b"\0"), password, challenge)
        if not success:
            self._failed_logins += 1
            self.closed = self._failed_logins >= LOGIN_ATTEMPTS
        return wire.STATUS_REPLY.pack(reply, success)

    def _set_diag(
        self, view: View, reply: int, word3: int, word4: int, extra: bytes, number: int, now: float
    ) -> bytes:
        self._swapped = extra[-4:] == _LITTLE_ENDIAN
        view.introduce(extra)
        return b""

    def _get_diag(self, view: View, reply: int, *rest: object) -> bytes:
        status, body = view.diagnostics(self._swapped)
        if status < 0:
            return wire.STATUS_REPLY.pack(reply, status).ljust(24, b"\0")
        return wire.STATUS_REPLY.pack(reply, status) + body

    # Subscriptions

    def _subscribe(
        self, view: View, reply: int, mode: int, interval_ms: int, extra: bytes, number: int, now: float
    ) -> bytes:
        self._subscriptions.pop(number, None)
        wanted = mode in (Subscription.POLLED, Subscription.VARIABLE)
        if wanted and view.may_read:
            period = SHORTEST_PERIOD
            if mode == Subscription.POLLED:
                period = max(period, interval_ms * 1e-3)
            self._subscriptions[number] = Pushes(view, period, now + period)
        return wire.STATUS_REPLY.pack(reply, not wanted or view.may_read)

    def _push(self, push: Pushes) -> bytes:
        status, message_id, was_read, body = push.view.fetch(True, push.last)
        if status != CmsStatus.READ_OK:
            return b""
        push.last = message_id
        self._serial = (self._serial + 1) & MASK
        return wire.READ_REPLY.pack(self._serial, status, len(body), message_id, was_read) + body


def _refuse_unknown(kind: int, reply: int) -> bytes:
    """The answer to a request for a buffer that nobody serves."""
    status = CmsStatus.SERVER_SIDE_ERROR
    length = _REPLY_BYTES[kind]
    return wire.STATUS_REPLY.pack(reply, 0 if kind in _ANSWERED_BY_SUCCESS else status).ljust(length, b"\0")[:length]


def _question(kind: Request) -> Handler:
    return lambda session, view, reply, *rest: session._ask(view, reply, kind)


Handler = Callable[..., bytes]

_TIMEOUT = struct.Struct(">i")
_LITTLE_ENDIAN = struct.pack("<I", 0x11223344)
_EXTRA: Mapping[int, int] = {int(kind): size for kind, size in wire.EXTRA_BYTES.items()}
_ANSWERED_BY_SUCCESS = (Request.LOGIN, Request.SUBSCRIBE)
_REPLY_BYTES: Mapping[int, int] = {
    Request.READ: 20,
    Request.CHECK_IF_READ: 12,
    Request.CLEAN: 0,
    Request.CLEAR: 8,
    Request.CLOSE: 0,
    Request.GET_KEYS: 20,
    Request.LOGIN: 8,
    Request.SUBSCRIBE: 8,
    Request.BLOCKING_READ: 20,
    Request.GET_NAME: 40,
    Request.SET_DIAG: 0,
    Request.GET_DIAG: 24,
    Request.MESSAGE_COUNT: 12,
    Request.QUEUE_LENGTH: 12,
    Request.SPACE: 12,
}
_HANDLERS: Mapping[int, Handler] = {
    Request.READ: Session._read,
    Request.CHECK_IF_READ: _question(Request.CHECK_IF_READ),
    Request.CLEAN: Session._ignore,
    Request.CLEAR: Session._clear,
    Request.CLOSE: Session._close,
    Request.GET_KEYS: Session._keys,
    Request.LOGIN: Session._log_in,
    Request.SUBSCRIBE: Session._subscribe,
    Request.BLOCKING_READ: Session._blocking_read,
    Request.GET_NAME: Session._name,
    Request.SET_DIAG: Session._set_diag,
    Request.GET_DIAG: Session._get_diag,
    Request.MESSAGE_COUNT: _question(Request.MESSAGE_COUNT),
    Request.QUEUE_LENGTH: _question(Request.QUEUE_LENGTH),
    Request.SPACE: _question(Request.SPACE),
}
