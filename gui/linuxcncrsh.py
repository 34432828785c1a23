"""``linuxcncrsh``: command a machine over TCP with lines of text, from telnet, nc or a program; port 5007.

Every connection is a `Session`. One task reads a connection's lines and answers them one after the other; orders to
the machine may wait, so each session has a thread of its own and the others go on. A client that does not read its
replies stops only its own session; a line that is too long is answered with a refusal and skipped up to its end.

With the passwords that everybody knows from the manual only this host may connect; with a password of your own
(--connectpw) the port is open to the network, as LinuxCNC's is. ``--bind`` decides otherwise.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
import re
import signal
import socket
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import linuxcnc
from gui.rsh_session import EOL, Session
from nml import namespace

PORT = 5007
LOCALHOST = "localhost"
CONNECT_PASSWORD = "EMC"
ENABLE_PASSWORD = "EMCTOO"
SERVER_NAME = "EMCNETSVR"
LONGEST_LINE = 4096  # bytes
_LINE_ENDS = re.compile(rb"[\r\n]+")


class LineBuffer:
    """Cuts a stream of bytes into lines, whatever mixture of CR and LF ends them; an overlong line becomes None."""

    def __init__(self) -> None:
        self._rest = b""
        self._skipping = False

    def feed(self, data: bytes) -> list[str | None]:
        """The lines that ``data`` completes."""
        *whole, rest = _LINE_ENDS.split(self._rest + data)
        lines: list[str | None] = []
        for line in whole:
            if self._skipping or len(line) > LONGEST_LINE:
                lines.append(None)
                self._skipping = False
            elif line:
                lines.append(line.decode("latin-1"))
        if len(rest) > LONGEST_LINE or (self._skipping and rest):
            self._skipping, rest = True, b"+"
        self._rest = rest
        return lines


class Server:
    """The listening socket, its sessions, and the one order that may be under way."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.name: str = options.name
        self.connect_password: str = options.connectpw
        self.enable_password: str = options.enablepw
        self.folders = [Path(folder) for folder in options.path.split(os.pathsep) if folder]
        self.sessions: list[Session] = []
        self.over = False
        self._quiet: bool = options.quiet
        self._most_sessions: int = options.sessions
        self._order = ""
        self._order_lock = threading.Lock()
        self._end = asyncio.Event()

    # --- orders, called by the sessions' threads -------------------------------------------------------------------

    @property
    def order_under_way(self) -> str:
        """Name of the order that a session waits for; empty: none."""
        return self._order

    def begin_order(self, name: str) -> str:
        """Take the right to give an order; the name of the one that is under way, if so, else nothing."""
        with self._order_lock:
            if not self._order:
                self._order = name
                return ""
            return self._order

    def end_order(self) -> None:
        self._order = ""

    # --- connections -----------------------------------------------------------------------------------------------

    async def serve(self, sockets: list[socket.socket]) -> None:
        """Serve until a client shuts the machine down or a signal comes; the port is written to the runtime folder."""
        listeners = [await asyncio.start_server(self._connected, sock=one) for one in sockets]
        port_file = namespace.runtime_dir() / "linuxcncrsh.port"
        port_file.write_text(f"{sockets[0].getsockname()[1]}\n")
        loop = asyncio.get_running_loop()
        for number in (signal.SIGTERM, signal.SIGINT):
            loop.add_signal_handler(number, self._end.set)
        try:
            await self._end.wait()
        finally:
            self.over = True
            for listener in listeners:
                listener.close()
            port_file.unlink(missing_ok=True)

    async def _connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """One connection from its first byte to its last."""
        if 0 < self._most_sessions <= len(self.sessions):
            writer.close()
            return
        session = Session(self, writer.get_extra_info("socket").fileno())
        self._tell(f"New connection {session.number} from {writer.get_extra_info('peername')[0]}")
        self.sessions.append(session)
        with ThreadPoolExecutor(1, f"session-{session.number}") as thread:
            try:
                await self._converse(session, thread, reader, writer)
            except ConnectionError:
                pass  # the client went away; the machine goes on
            finally:
                self.sessions.remove(session)
                self._tell(f"Connection terminated '{session.client}' ({session.number})")
                writer.close()

    async def _converse(
        self,
        session: Session,
        thread: ThreadPoolExecutor,
        reader: asyncio.StreamReader,
        writer: asyncio.StreamWriter,
    ) -> None:
        loop, lines = asyncio.get_running_loop(), LineBuffer()
        while not session.closing and (data := await reader.read(65536)):
            for line in lines.feed(data):
                if line is None:
                    reply = f"error: a line may have {LONGEST_LINE} characters{EOL}"
                else:
                    reply = await loop.run_in_executor(thread, session.answer, line)
                writer.write(reply.encode("latin-1", "replace"))
                await writer.drain()
                if session.shutting_down:
                    self._end.set()
                if session.closing:
                    break

    def _tell(self, text: str) -> None:
        """Who comes and goes, for the operator's terminal."""
        if not self._quiet:
            print(f"linuxcncrsh: {text}", flush=True)


def main(arguments: list[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    options = _parser().parse_args([word for word in arguments or sys.argv[1:] if word != "--"])
    if options.ini:
        os.environ["INI_FILE_NAME"] = options.ini
    address = options.bind
    if address is None:
        address = LOCALHOST if options.connectpw == CONNECT_PASSWORD else ""
    try:
        asyncio.run(_serve(options, listening(address, options.port)))
    except (OSError, linuxcnc.error) as reason:
        print(f"linuxcncrsh: {reason}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


async def _serve(options: argparse.Namespace, sockets: list[socket.socket]) -> None:
    with contextlib.suppress(asyncio.CancelledError):
        await Server(options).serve(sockets)


def listening(address: str, port: int) -> list[socket.socket]:
    """Sockets of one port, for IPv4 and IPv6 where this host has both; an empty address means all of them."""
    if not address and socket.has_dualstack_ipv6():
        return [socket.create_server(("", port), family=socket.AF_INET6, dualstack_ipv6=True)]
    if address != LOCALHOST:
        family = socket.AF_INET6 if ":" in address else socket.AF_INET
        return [socket.create_server((address, port), family=family)]
    sockets = [socket.create_server(("127.0.0.1", port))]
    with contextlib.suppress(OSError):
        sockets.append(socket.create_server(("::1", sockets[0].getsockname()[1]), family=socket.AF_INET6))
    return sockets


def _word(text: str) -> str:
    """A password or name: it stands in a line between blanks."""
    if not text.isprintable() or " " in text:
        raise argparse.ArgumentTypeError("control and space characters are not allowed")
    return text


def _enable_password(text: str) -> str:
    if text.upper() == "OFF":
        raise argparse.ArgumentTypeError("OFF cannot be the password, because `set enable off` gives control back")
    return _word(text)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="linuxcncrsh", description="Command a CNC machine over TCP.")
    programs = str(Path.home() / "nc_files")
    add = parser.add_argument
    add("-p", "--port", type=int, default=PORT, help="port; 0: any free one (default 5007)")
    add("-n", "--name", type=_word, default=SERVER_NAME, help="name given to clients (default EMCNETSVR)")
    add("-w", "--connectpw", type=_word, default=CONNECT_PASSWORD, help="password of `hello` (default EMC)")
    add("-e", "--enablepw", type=_enable_password, default=ENABLE_PASSWORD, help="of `set enable` (default EMCTOO)")
    add("-s", "--sessions", type=int, default=0, help="most connections at a time; 0 (default) or less: any number")
    add("-d", "--path", metavar="FOLDERS", default=programs, help="where `set open` looks, separated by colons")
    add("-q", "--quiet", action="store_true", help="do not print who connects")
    add("--bind", metavar="ADDRESS", help="address to listen on; empty: all")
    add("-ini", metavar="FILE", help="INI file of the machine")
    return parser


if __name__ == "__main__":
    sys.exit(main())
