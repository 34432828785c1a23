"""The server's connections: non-blocking sockets around the sans-I/O sessions, none of which can hold up another.

A ``Connection`` reads only while its client takes the replies, holds at most one batch of them, and goes when the
client stays silent from the start, leaves a request unfinished or stops reading. ``Limits`` has the figures. ``server``
runs the loop that calls ``ready``, ``tick`` and ``check``.
"""

from __future__ import annotations

import contextlib
import errno
import logging
import select
import socket
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from nml.clock import host_now

log = logging.getLogger(__name__)

CHUNK = 4096
"""Bytes taken at once: requests are short, and a longer buffer takes longer to make."""
_IN, _OUT = select.EPOLLIN, select.EPOLLOUT

Release = Callable[[], None]
"""What to do when a connection is gone."""
_KEEPALIVE = ((socket.TCP_KEEPIDLE, 60), (socket.TCP_KEEPINTVL, 10), (socket.TCP_KEEPCNT, 3))
"""A client whose host has gone is noticed after a minute and a half of silence."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Host seconds, and the greatest number of connections."""

    silent: float = 30.0
    """A new connection must make a request within this time."""
    unfinished: float = 30.0
    """A request must be complete within this time."""
    stalled: float = 20.0
    """Replies must be taken within this time."""
    connections: int = 4096
    """When there are as many, a new one replaces the one that was quiet for longest."""


class SessionLike(Protocol):
    """The sans-I/O side of a connection (``protocol.Session``, ``stcp.Session``)."""

    closed: bool
    requests: int

    @property
    def idle(self) -> bool:
        """Whether nothing is to be done before the next input."""

    @property
    def incomplete(self) -> bool: ...

    @property
    def congested(self) -> bool: ...

    @property
    def due(self) -> float: ...

    def receive(self, data: bytes, now: float) -> bytes: ...

    def proceed(self, now: float) -> bytes: ...

    def tick(self, now: float) -> bytes: ...


class Loop(Protocol):
    """What connections and listeners ask of the server."""

    limits: Limits

    def watch(self, fd: int, owner: Watched, events: int) -> None: ...

    def change(self, fd: int, events: int) -> None: ...

    def forget(self, fd: int) -> None: ...

    def follow(self, connection: Connection) -> None:
        """Look at the connection again before waiting: it has more to do, or something due."""

    def admit(self, connection: Connection) -> None: ...

    def dismiss(self, connection: Connection) -> None: ...

    def make_room(self) -> None:
        """Close the connection that was quiet for longest."""


class Watched(Protocol):
    """Anything with a file descriptor."""

    def ready(self, events: int) -> None: ...

    def close(self) -> None: ...


class Connection:
    """One client on a stream socket."""

    def __init__(self, sock: socket.socket, session: SessionLike, loop: Loop, release: Release) -> None:
        self._sock = sock
        self._session = session
        self._loop = loop
        self._release = release
        self._out = b""
        self._since = host_now()
        """When the oldest output, unfinished request or, without any, the last input came."""
        self.more = False
        """Requests may wait in the session although nothing new arrived."""
        self._wanted: int = _IN
        sock.setblocking(False)
        loop.watch(sock.fileno(), self, self._wanted)
        loop.admit(self)

    @property
    def quiet_since(self) -> float:
        return self._since

    @property
    def due(self) -> float:
        """When to call ``tick``; replies that are not taken hold everything back."""
        if self._out:
            return float("inf")
        return 0.0 if self.more else self._session.due

    def ready(self, events: int) -> None:
        """The socket can be read or written, or is broken."""
        now = host_now()
        if events & _OUT:
            self._send(self._out, now)
        elif events & _IN:
            try:
                data = self._sock.recv(CHUNK)
            except BlockingIOError:
                return
            except OSError:
                data = b""
            if not data:
                self.close()
                return
            self._since = now
            reply = self._session.receive(data, now)
            if reply:
                self._send(reply, now)
            else:
                self._settle()
        else:
            self.close()

    def tick(self, now: float) -> None:
        """Go on with requests that wait and with what is due."""
        out = self._session.proceed(now) if self.more else self._session.tick(now)
        if out:
            self._send(out, now)
        else:
            self._settle()

    def check(self, now: float) -> None:
        """Close the connection if its client is not worth keeping it."""
        limits = self._loop.limits
        idle = now - self._since
        if self._out:
            reason = "takes no replies" if idle > limits.stalled else ""
        elif self._session.incomplete:
            reason = "left a request unfinished" if idle > limits.unfinished else ""
        else:
            reason = "has asked nothing" if not self._session.requests and idle > limits.silent else ""
        if reason:
            log.debug("client on descriptor %d %s for %.0f s", self._sock.fileno(), reason, idle)
            self.close()

    def _send(self, data: bytes, now: float) -> None:
        try:
            sent = self._sock.send(data)
        except BlockingIOError:
            sent = 0
        except OSError:
            self.close()
            return
        if sent:
            self._since = now
        if sent == len(data) and self._session.idle and self._wanted == _IN:
            self._out, self.more = b"", False
            return
        self._out = bytes(memoryview(data)[sent:]) if sent < len(data) else b""
        self._settle(sent=True)

    def _settle(self, sent: bool = False) -> None:
        """Choose what to wait for: the client taking output, further requests, or input; or close."""
        session = self._session
        wanted = _IN
        if self._out:
            wanted = _OUT
        elif session.closed:
            self.close()
            return
        else:
            self.more = sent and session.incomplete
            if session.congested:
                wanted = 0
            if self.more or session.due != _NEVER:
                self._loop.follow(self)
        if wanted != self._wanted:
            self._wanted = wanted
            self._loop.change(self._sock.fileno(), wanted)

    def close(self) -> None:
        """Let the client go."""
        if self._sock.fileno() < 0:
            return
        self._loop.forget(self._sock.fileno())
        self._loop.dismiss(self)
        self._sock.close()
        self._release()


class Listener:
    """A listening socket; ``make(address)`` builds the session of a new connection and what to do when it ends."""

    def __init__(
        self, address: tuple[str, int], loop: Loop, make: Callable[[str], tuple[SessionLike, Release]]
    ) -> None:
        self._loop = loop
        self._make = make
        family = socket.AF_INET6 if ":" in address[0] else socket.AF_INET
        self._sock = socket.create_server(address, family=family, backlog=256, reuse_port=False)
        self._sock.setblocking(False)
        self.port: int = self._sock.getsockname()[1]
        loop.watch(self._sock.fileno(), self, select.EPOLLIN)

    def ready(self, events: int) -> None:
        """Take the clients that wait."""
        for _ in range(64):
            try:
                sock, address = self._sock.accept()
            except BlockingIOError:
                return
            except OSError as error:
                if error.errno in (errno.EMFILE, errno.ENFILE):
                    self._loop.make_room()
                return
            with contextlib.suppress(OSError):
                sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                sock.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
                for option, value in _KEEPALIVE:
                    sock.setsockopt(socket.IPPROTO_TCP, option, value)
            session, release = self._make(f"{address[0]}:{address[1]}")
            Connection(sock, session, self._loop, release)

    def close(self) -> None:
        if self._sock.fileno() >= 0:
            self._loop.forget(self._sock.fileno())
            self._sock.close()


_NEVER = float("inf")
