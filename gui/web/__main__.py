"""``linuxcnc-web -ini FILE``: the web display as a program. ``DISPLAY = web`` starts it; it lives as long as the
machine.

Exit codes: 0, ended by a signal; 1, something is wrong, said in one line; 2, a wrong command line.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import errno
import logging
import os
import signal
import socket
import sys
import webbrowser
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import linuxcnc
from gui.web import settings as settings_module
from gui.web.server import Server
from gui.web.settings import Settings
from gui.web.site import application
from gui.web.wizard.server import WizardServer
from nml import namespace
from nml.errors import ConfigError, PyemcError
from nml.inifile import IniFile

PORT_FILE = "web.port"
Maker = Callable[[Settings, Callable[[], None]], Server | WizardServer]
DESKTOP = ("DISPLAY", "WAYLAND_DISPLAY")


def main(arguments: list[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    options = _parser().parse_args(arguments)
    logging.basicConfig(format="%(name)s: %(message)s", level=logging.WARNING)
    try:
        if options.wizard:
            asyncio.run(_serve(settings_module.of_wizard(options.port), _wizard_server, options.open))
            return 0
        ini = IniFile(_ini_file(options))
        _use_nml_file(ini)
        settings = settings_module.read(ini, options.host, options.port)
        asyncio.run(_serve(settings, lambda settings, _: Server(ini, settings), options.open))
    except (PyemcError, linuxcnc.error, OSError) as reason:
        print(f"linuxcnc-web: {reason}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


def _ini_file(options: argparse.Namespace) -> Path:
    name = options.ini or os.environ.get("INI_FILE_NAME")
    if not name:
        raise ConfigError("no INI file named; linuxcnc-web -ini FILE would be right")
    return Path(name)


def _use_nml_file(ini: IniFile) -> None:
    """The client module finds the machine by the INI file's NML file."""
    os.environ["INI_FILE_NAME"] = str(ini.file.resolve())
    nml_file = ini.path("EMC", "NML_FILE", None)
    if nml_file is not None:
        linuxcnc.nmlfile = str(nml_file)


def _wizard_server(settings: Settings, finish: Callable[[], None]) -> WizardServer:
    return WizardServer(settings, settings.program_folder, finish)


async def _serve(settings: Settings, make: Maker, browser: bool) -> None:
    """Serve until a signal asks for the end."""
    from aiohttp import web

    over = asyncio.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        asyncio.get_running_loop().add_signal_handler(number, over.set)
    tls = settings.tls()
    listener = listening_socket(settings)
    settings = replace(settings, port=listener.getsockname()[1])
    server = make(settings, over.set)
    runner = web.AppRunner(application(server), access_log=None, handle_signals=False, shutdown_timeout=1.0)
    await runner.setup()
    port_file = namespace.runtime_dir() / PORT_FILE
    try:
        await server.start()
        await web.SockSite(runner, listener, ssl_context=tls).start()
        address = f"{settings.scheme}://{shown_host(settings.host)}:{settings.port}/"
        port_file.write_text(f"{settings.port}\n")
        print(f"the machine's page: {address}", flush=True)
        if browser and any(os.environ.get(name) for name in DESKTOP):
            await asyncio.to_thread(webbrowser.open, address)
        await over.wait()
    finally:
        port_file.unlink(missing_ok=True)
        with contextlib.suppress(asyncio.CancelledError):
            await server.stop()
        await runner.cleanup()


def listening_socket(settings: Settings) -> socket.socket:
    """The socket; any free port where the wished one is taken by another machine of this host."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    made = socket.socket(family, socket.SOCK_STREAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind((settings.host, settings.port))
    except OSError as reason:
        if reason.errno != errno.EADDRINUSE or not settings.port_is_wish:
            made.close()
            raise ConfigError(f"{settings.host} port {settings.port}: {reason.strerror}") from None
        made.bind((settings.host, 0))
    made.listen(128)
    made.setblocking(False)
    return made


def shown_host(host: str) -> str:
    """A host as it stands in an address."""
    if host in ("0.0.0.0", "::"):
        host = socket.gethostname()
    return f"[{host}]" if ":" in host else host


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="linuxcnc-web", description="Show and operate a CNC machine in browsers.")
    parser.add_argument("-ini", metavar="FILE", help="INI file of the machine")
    parser.add_argument("--port", type=int, metavar="N", help="port; 0: any free one (default [WEB]PORT or 8080)")
    parser.add_argument("--host", metavar="ADDRESS", help="address to listen on (default [WEB]HOST or 127.0.0.1)")
    parser.add_argument("--wizard", action="store_true", help="make a new configuration; no INI file is needed")
    parser.add_argument("--no-browser", dest="open", action="store_false", help="do not open a browser on the desktop")
    return parser


if __name__ == "__main__":
    sys.exit(main())
