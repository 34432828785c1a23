"""``linuxcncsvr``: the process that offers the buffers of the NML file to remote programs.

    linuxcncsvr -ini FILE [-nml FILE] [--listen ADDRESS] [--optional] | --client-file HOST

It opens, as process ``emcsvr`` of the NML file, every buffer whose B line has TCP=, STCP=, UDP= or serialPortDevName=,
and serves them all from one thread: nothing it calls waits for a client, and a local process never waits for it. Only
programs of this host reach it unless --listen, the environment's PYEMC_NML_LISTEN or [NML]LISTEN of the INI file
names another address.
"""

from __future__ import annotations

import argparse
import contextlib
import logging
import os
import resource
import select
import signal
import socket
import sys
from collections.abc import Callable
from functools import partial

from nml.clock import host_now
from nml.config import NmlConfig
from nml.errors import ConfigError, NmlError
from nml.inifile import IniFile
from nml.net.client_file import client_file
from nml.net.packet_ports import SerialPort, UdpPort
from nml.net.protocol import Session
from nml.net.served import Desk, Shelf, WireLink
from nml.net.stcp import TextSession
from nml.net.streams import Connection, Limits, Listener, Release, SessionLike, Watched

log = logging.getLogger(__name__)

PROCESS = "emcsvr"
LOOPBACK = "127.0.0.1"
LISTEN_VARIABLE = "PYEMC_NML_LISTEN"
_CHECK_PERIOD = 1.0
_SPARE_FILES = 128
_TURNS = 64
"""Connections that may go on with what is due before others' requests are looked at again."""
_BRISK = 150e-6
"""s; a request that comes this soon after the last replies is followed by others as soon."""
_LOOKS = 40
"""How often to look for such a request, letting others run in between, before going to sleep: some 50 us."""
_NEVER = float("inf")


class Server:
    """Buffers, links and the loop that serves them. ConfigError: the NML file asks for what cannot be done.

    ``optional``: a link that cannot be opened is left out with a warning.
    """

    def __init__(
        self,
        config: NmlConfig,
        *,
        process: str = PROCESS,
        listen: str = LOOPBACK,
        optional: bool = False,
        limits: Limits | None = None,
    ) -> None:
        self.limits = limits or Limits()
        self._epoll = select.epoll()
        self._watched: dict[int, Watched] = {}
        self._connections: dict[Connection, None] = {}
        self._followed: dict[Connection, None] = {}
        self._stopping = False
        self._next_check = host_now() + _CHECK_PERIOD
        self._brisk = False
        self._shelf = Shelf(config, process)
        try:
            if not self._shelf.links:
                raise ConfigError(f"{config.path}: process {process} has no buffer to serve with a TCP= or other link")
            self._open_links(listen, optional)
        except BaseException:
            self.close()
            raise

    def _open_links(self, listen: str, optional: bool) -> None:
        for link, buffers in self._shelf.links.items():
            line = next(iter(buffers.values())).line
            try:
                self._open_link(link, listen, line.baud)
            except OSError as error:
                reason = error.strerror or str(error)
                message = f"buffer {line.name}: cannot serve {link.kind}={link.where}: {reason}"
                if not optional:
                    raise ConfigError(message, line.place) from None
                log.warning("%s: %s; nobody can connect there", line.place, message)

    def _open_link(self, link: WireLink, listen: str, baud: int) -> None:
        make_desk = partial(self._shelf.desk, link)
        match link:
            case WireLink("TCP", int(port)):
                Listener((listen, port), self, partial(_session, Session, make_desk))
            case WireLink("STCP", int(port)):
                Listener((listen, port), self, partial(_session, TextSession, make_desk))
            case WireLink("UDP", int(port)):
                UdpPort((listen, port), self, make_desk)
            case WireLink("serialPortDevName", str(device)):
                SerialPort(device, baud, self, make_desk)

    # The loop, and what its members ask of it (``streams.Loop``)

    def run(self) -> None:
        """Serve until ``stop``."""
        while not self._stopping:
            self.step(_CHECK_PERIOD)

    def step(self, seconds: float) -> None:
        """Wait at most that long for something to do, and do it."""
        timeout = seconds
        if self._followed:
            due = min(connection.due for connection in self._followed)
            timeout = max(0.0, min(due - host_now(), seconds))
        for fd, events in self._events(timeout):
            owner = self._watched.get(fd)
            if owner is not None:
                owner.ready(events)
        if self._followed:
            self._go_on(host_now())
        if host_now() >= self._next_check:
            self._check(host_now())

    def _events(self, timeout: float) -> list[tuple[int, int]]:
        """What is to do, after waiting for it at most ``timeout`` s.

        To sleep and to be woken takes longer than to answer. So while a client asks again and again without a pause,
        the processor is not given up but for others that want to run.
        """
        poll = self._epoll.poll
        if self._brisk:
            for _ in range(_LOOKS):
                events = poll(0)
                if events:
                    return events
                os.sched_yield()
        start = host_now()
        events = poll(timeout)
        self._brisk = bool(events) and host_now() - start < _BRISK
        return events

    def _check(self, now: float) -> None:
        self._next_check = now + _CHECK_PERIOD
        for connection in list(self._connections):
            connection.check(now)

    @property
    def connection_count(self) -> int:
        """How many clients are connected by TCP or STCP."""
        return len(self._connections)

    def _go_on(self, now: float) -> None:
        """Give some of the connections their turn, the rest in the next step."""
        turns = 0
        for connection in list(self._followed):
            due = connection.due
            if due > now and due != _NEVER:
                continue
            del self._followed[connection]
            if due <= now:
                self._followed[connection] = None
                connection.tick(now)
                turns += 1
                if turns == _TURNS:
                    break

    def stop(self) -> None:
        """End ``run``; callable from a signal handler."""
        self._stopping = True

    def watch(self, fd: int, owner: Watched, events: int) -> None:
        self._watched[fd] = owner
        self._epoll.register(fd, events)

    def change(self, fd: int, events: int) -> None:
        self._epoll.modify(fd, events)

    def forget(self, fd: int) -> None:
        del self._watched[fd]
        self._epoll.unregister(fd)

    def follow(self, connection: Connection) -> None:
        self._followed[connection] = None

    def admit(self, connection: Connection) -> None:
        while len(self._connections) >= self.limits.connections:
            self.make_room()
        self._connections[connection] = None

    def dismiss(self, connection: Connection) -> None:
        self._connections.pop(connection, None)
        self._followed.pop(connection, None)

    def make_room(self) -> None:
        if self._connections:
            min(self._connections, key=lambda connection: connection.quiet_since).close()

    def close(self) -> None:
        """Close every link and let go of the buffers."""
        for owner in list(self._watched.values()):
            owner.close()
        self._epoll.close()
        self._shelf.close()


def _session(
    kind: Callable[[Desk], SessionLike], make_desk: Callable[[str], Desk], address: str
) -> tuple[SessionLike, Release]:
    """A session for a new client, and what to do when it is gone."""
    desk = make_desk(address)
    return kind(desk), desk.close


class _Wakeup:
    """Ends the wait of the loop when a signal arrives."""

    def __init__(self, server: Server) -> None:
        self._read, self._write = socket.socketpair()
        for end in (self._read, self._write):
            end.setblocking(False)
        signal.set_wakeup_fd(self._write.fileno(), warn_on_full_buffer=False)
        server.watch(self._read.fileno(), self, select.EPOLLIN)
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, lambda *_: server.stop())

    def ready(self, events: int) -> None:
        with contextlib.suppress(BlockingIOError):
            self._read.recv(64)

    def close(self) -> None:
        signal.set_wakeup_fd(-1)
        self._read.close()
        self._write.close()


def _allow_files(connections: int) -> int:
    """Raise the limit of open files as far as needed; how many connections it then allows."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = connections + _SPARE_FILES
    if soft < wanted:
        soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    return max(1, min(connections, soft - _SPARE_FILES))


def _arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="linuxcncsvr", description="Offer the buffers of an NML file to a network.")
    parser.add_argument("-ini", metavar="FILE", default=os.environ.get("INI_FILE_NAME"), help="INI file")
    parser.add_argument("-nml", metavar="FILE", help="NML file instead of the one that the INI file names")
    parser.add_argument("--listen", metavar="ADDRESS", help=f"address to listen on, {LOOPBACK} by default")
    parser.add_argument("--client-file", metavar="HOST", help="print the NML file for a program on another computer")
    parser.add_argument("--optional", action="store_true", help="go on without a port that is in use")
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    """The command ``linuxcncsvr``."""
    arguments = _arguments(argv)
    logging.basicConfig(format="linuxcncsvr: %(message)s")
    try:
        listen = arguments.listen or os.environ.get(LISTEN_VARIABLE)
        if arguments.ini:
            os.environ["INI_FILE_NAME"] = arguments.ini
            listen = listen or IniFile(arguments.ini).find("NML", "LISTEN")
        config = NmlConfig.load(arguments.nml)
        if arguments.client_file:
            print(client_file(config, PROCESS, arguments.client_file), end="")
            return 0
        limits = Limits(connections=_allow_files(Limits().connections))
        server = Server(config, listen=listen or LOOPBACK, optional=arguments.optional, limits=limits)
    except (ConfigError, NmlError) as error:
        print(f"linuxcncsvr: {error}", file=sys.stderr)
        return 1
    try:
        _Wakeup(server)
        server.run()
    finally:
        server.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
