"""A server process over buffers of the test's own namespace, and NML files for both ends of every kind of link."""

from __future__ import annotations

import contextlib
import itertools
import os
import pty
import random
import re
import select
import signal
import socket
import subprocess
import sys
import threading
import time
import tty
from collections.abc import Iterator
from pathlib import Path

from nml.config import DEFAULT_FILE, NmlConfig
from nml.net import wire

SOURCE = Path(__file__).parents[2]
STARTED_WITHIN = 60.0
LOOPBACK = "127.0.0.1"
PORTS = range(10_000, 32_000)  # below those that the kernel gives to clients, of which some tests start thousands


def _candidates() -> Iterator[int]:
    """All ports again and again; each process of a test run begins elsewhere."""
    first = random.SystemRandom().randrange(len(PORTS))
    yield from itertools.cycle((*PORTS[first:], *PORTS[:first]))


_next_port = _candidates()


def free_port(kind: socket.SocketKind = socket.SOCK_STREAM) -> int:
    """A port of the loopback address that nobody uses and no other test of this process was given."""
    while True:
        with contextlib.suppress(OSError), socket.socket(socket.AF_INET, kind) as sock:
            sock.bind((LOOPBACK, port := next(_next_port)))
            return port


def _tcp_accepts(host: str, port: int) -> bool:
    with contextlib.suppress(OSError), socket.create_connection((host, port), 1.0):
        return True
    return False


def _udp_answers(port: int) -> bool:
    with contextlib.suppress(OSError), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        sock.settimeout(0.2)
        sock.connect(("127.0.0.1", port))
        sock.send(wire.PACKET_REQUEST.pack(wire.Request.GET_NAME, 2, 0, 0, 0, 0, 0))
        return bool(sock.recv(100))
    return False


def nml_text(links: str, changes: dict[str, str] | None = None) -> str:
    """The packaged NML file with other links (``TCP=15005``), and options added to the lines of some buffers."""
    text = re.sub(r"TCP=\d+", links, DEFAULT_FILE.read_text())
    for name, options in (changes or {}).items():
        text = re.sub(rf"^(B {name}\s.*)$", rf"\1 {options}", text, flags=re.MULTILINE)
    return text


def remote_text(text: str, options: str = "") -> str:
    """The same file as a client on another computer has it: process xemc is remote."""
    lines = text.splitlines()
    return "\n".join(
        f"{line.replace(' LOCAL ', ' REMOTE ')} {options}" if line.startswith("P xemc") else line for line in lines
    )


class Server:
    """``linuxcncsvr`` as a process."""

    def __init__(self, folder: Path, text: str, *arguments: str, host: str = LOOPBACK) -> None:
        self.folder = folder
        self.host = host
        self.file = folder / "server.nml"
        self.file.write_text(text)
        found = re.findall(r"^B.* (S?TCP|UDP)=(\d+)", text, flags=re.MULTILINE)
        self.ports = {(kind, int(port)) for kind, port in found}
        self.arguments = arguments
        self.process: subprocess.Popen[str] | None = None
        self.config = NmlConfig.load(self.file)

    def start(self) -> None:
        """Start it and wait until it can be reached."""
        command = [sys.executable, "-m", "nml.net.server", "-nml", str(self.file), *self.arguments]
        self.process = subprocess.Popen(command, cwd=SOURCE, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + STARTED_WITHIN
        for kind, port in self.ports:
            while not (_udp_answers(port) if kind == "UDP" else _tcp_accepts(self.host, port)):
                assert self.process.poll() is None, self.process.communicate()[1]
                assert time.monotonic() < deadline, "the server does not listen"
                time.sleep(0.02)

    def stop(self, number: int = signal.SIGTERM) -> int:
        """End it and give its exit code."""
        assert self.process is not None
        self.process.send_signal(number)
        self.process.communicate(timeout=STARTED_WITHIN)
        return self.process.returncode

    def remote(self, options: str = "", text: str | None = None) -> NmlConfig:
        """The configuration of a client."""
        file = self.folder / "client.nml"
        file.write_text(remote_text(text or self.file.read_text(), options))
        return NmlConfig.load(file)


@contextlib.contextmanager
def running(folder: Path, text: str, *arguments: str, host: str = LOOPBACK) -> Iterator[Server]:
    """A server that runs during the block."""
    server = Server(folder, text, *arguments, host=host)
    server.start()
    try:
        yield server
    finally:
        assert server.process is not None
        if server.process.poll() is None:
            server.stop()


class NullModem:
    """Two pseudo-terminals joined by a thread: a serial cable, which may lose bytes."""

    def __init__(self) -> None:
        pairs = [pty.openpty() for _ in range(2)]
        for pair in pairs:
            for fd in pair:
                tty.setraw(fd)
        self._ends = [master for master, _ in pairs]
        self._slaves = [slave for _, slave in pairs]
        self.devices = [os.ttyname(slave) for slave in self._slaves]
        self.lose = 0
        """One byte of so many is lost; 0: none."""
        self._count = 0
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def _run(self) -> None:
        while not self._over.is_set():
            readable, _, _ = select.select(self._ends, [], [], 0.05)
            for end in readable:
                data = os.read(end, 4096)
                if self.lose:
                    data = bytes(byte for byte in data if not self._lost())
                os.write(self._ends[1 - self._ends.index(end)], data)

    def _lost(self) -> bool:
        self._count += 1
        return self._count % self.lose == 0

    def __enter__(self) -> NullModem:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._over.set()
        self._thread.join()
        for fd in (*self._ends, *self._slaves):
            os.close(fd)
