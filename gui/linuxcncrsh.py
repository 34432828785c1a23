"""``linuxcncrsh``: command a machine over TCP with lines of text, from telnet, nc or a program; port 5007.

Every connection is a `Session`. One task reads a connection's lines and answers them one after the other; orders to
the machine may wait, so they run in a thread and other connections go on. A client that does not read its replies stops
only its own session; a line that is too long is answered with a refusal and skipped up to its end.

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
import sys

import linuxcnc
from gui.rsh_session import EOL, Session
from nml import namespace

PORT = 5007
CONNECT_PASSWORD = "EMC"
ENABLE_PASSWORD = "EMCTOO"
SERVER_NAME = "EMCNETSVR"
LONGEST_LINE = 4096  # bytes
MESSAGE_INTERVAL = 0.05  # host seconds between looks at the operator messages
MESSAGE_KINDS = {
    linuxcnc.NML_ERROR: "error",
    linuxcnc.OPERATOR_ERROR: "error",
    linuxcnc.NML_TEXT: "text",
    linuxcnc.OPERATOR_TEXT: "text",
    linuxcnc.NML_DISPLAY: "display",
    linuxcnc.OPERATOR_DISPLAY: "display",
}
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
    """The listening socket and its sessions."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.name: str = options.name
        self.connect_password: str = options.connectpw
        self.enable_password: str = options.enablepw
        self.in_control: Session | None = None
        self._most_sessions: int = options.sessions
        self._sessions: set[Session] = set()
        self._over = asyncio.Event()
        self._loop = asyncio.get_running_loop()
        self._errors = linuxcnc.error_channel()

    async def serve(self, address: str | None, port: int) -> None:
        """Serve until `shut_down`; the port in use is written to the runtime folder."""
        listener = await asyncio.start_server(self._connected, address, port)
        port_file = namespace.runtime_dir() / "linuxcncrsh.port"
        port_file.write_text(f"{listener.sockets[0].getsockname()[1]}\n")
        for number in (signal.SIGTERM, signal.SIGINT):
            self._loop.add_signal_handler(number, self._over.set)
        messages = asyncio.create_task(self._pass_messages_on())
        try:
            await self._over.wait()
        finally:
            messages.cancel()
            listener.close()
            port_file.unlink(missing_ok=True)

    def shut_down(self) -> None:
        """End the server, and with it the machine; also from a session's thread."""
        self._loop.call_soon_threadsafe(self._over.set)

    async def _pass_messages_on(self) -> None:
        """Give every operator message to every session, because the error channel gives each of them only once."""
        while True:
            while (message := self._errors.poll()) is not None:
                kind, text = message
                for session in self._sessions:
                    session.note(MESSAGE_KINDS.get(kind, "text"), text)
            await asyncio.sleep(MESSAGE_INTERVAL)

    async def _connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """One connection from its first byte to its last."""
        if 0 <= self._most_sessions <= len(self._sessions):
            writer.close()
            return
        session = Session(self)
        self._sessions.add(session)
        try:
            await self._converse(session, reader, writer)
        except ConnectionError:
            pass  # the client went away; the machine goes on
        finally:
            session.enabled = False
            self._sessions.discard(session)
            writer.close()

    async def _converse(self, session: Session, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        lines = LineBuffer()
        while not session.closing and (data := await reader.read(65536)):
            for line in lines.feed(data):
                if line is None:
                    reply = f"NAK: a line may have {LONGEST_LINE} characters{EOL}"
                else:
                    reply = await asyncio.to_thread(session.answer, line)
                writer.write(reply.encode("latin-1", "replace"))
                await writer.drain()
                if session.closing:
                    break


def main(arguments: list[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    options = _parser().parse_args([word for word in arguments or sys.argv[1:] if word != "--"])
    if options.ini:
        os.environ["INI_FILE_NAME"] = options.ini
    address = options.bind
    if address is None:
        address = "localhost" if options.connectpw == CONNECT_PASSWORD else ""
    try:
        asyncio.run(_serve(options, address or None))
    except (OSError, linuxcnc.error) as reason:
        print(f"linuxcncrsh: {reason}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


async def _serve(options: argparse.Namespace, address: str | None) -> None:
    with contextlib.suppress(asyncio.CancelledError):
        await Server(options).serve(address, options.port)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="linuxcncrsh", description="Command a CNC machine over TCP.")
    parser.add_argument("-p", "--port", type=int, default=PORT, help="port; 0: any free one (default 5007)")
    parser.add_argument("-n", "--name", default=SERVER_NAME, help="name given to clients (default EMCNETSVR)")
    parser.add_argument("-w", "--connectpw", default=CONNECT_PASSWORD, help="password of `hello` (default EMC)")
    parser.add_argument("-e", "--enablepw", default=ENABLE_PASSWORD, help="password of `set enable` (default EMCTOO)")
    parser.add_argument("-s", "--sessions", type=int, default=-1, help="most connections at a time (default: all)")
    parser.add_argument("--bind", metavar="ADDRESS", help="address to listen on; empty: all")
    parser.add_argument("--path", metavar="FOLDER", help="where programs are, for callers that give it")
    parser.add_argument("-ini", metavar="FILE", help="INI file, for callers that give it")
    return parser


if __name__ == "__main__":
    sys.exit(main())
