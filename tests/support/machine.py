"""Start a whole machine in a namespace of its own and look at its processes."""

from __future__ import annotations

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from nml import namespace

ROOT = Path(__file__).parents[2]
PACKAGED_NML = ROOT / "nml" / "linuxcnc.nml"
MILL = ROOT / "configs" / "sim" / "mill"
PROGRAMS = ROOT / "configs" / "sim" / "nc_files"
PATIENCE = 60.0  # s; a watchdog, not a claim about speed
MOST_SAID = 1 << 20  # bytes of stderr that are looked at
HEARTBEAT = "EMCMOT.HEARTBEAT_TIMEOUT"
TOLERANT_HEARTBEAT_S = 0.5  # a busy computer may hold up one process for longer than the 0.1 s of a machine
OF_THE_COMPUTER = ("Unexpected realtime delay:", " cannot keep its period of ")
"""What the realtime host says of a computer too busy for its threads; a test of something else must not hear it."""


def wait_until(condition: Callable[[], object], what: str, timeout: float = PATIENCE) -> None:
    """Poll a condition; AssertionError names what did not happen."""
    deadline = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < deadline, f"{what}: not within {timeout:g} s"
        time.sleep(0.01)


def copy_mill(folder: Path, *, units: str = "mm", changes: dict[str, str] | None = None, hal: str = "") -> Path:
    """A copy of the simulated mill whose linuxcncrsh takes any free port; ``changes`` replace whole INI lines.

    A key of ``changes`` is ``SECTION.KEY``; its value replaces that of every such entry. ``hal`` is added as a last HAL
    file. The NML buffers of the copy have no TCP ports, which tests in parallel would quarrel about. Its motion waits
    longer for a sign of life of task than that of a machine, unless ``changes`` has HEARTBEAT.
    """
    for path in MILL.iterdir():
        if path.suffix in (".hal", ".tbl", ".ini"):
            shutil.copy(path, folder)
    ini = folder / f"mill_{units}.ini"
    wanted = {"DISPLAY.DISPLAY": "linuxcncrsh --port 0", "RS274NGC.SUBROUTINE_PATH": str(PROGRAMS)} | (changes or {})
    lines, section = [], ""
    for line in ini.read_text().splitlines():
        if line.startswith("["):
            section = line.strip("[]")
        key = f"{section}.{line.partition('=')[0].strip()}"
        lines.append(f"{key.partition('.')[2]} = {wanted[key]}" if "=" in line and key in wanted else line)
        if line == "[EMC]":
            lines.append("NML_FILE = local.nml")
        if line == "[EMCMOT]":
            lines.append(f"HEARTBEAT_TIMEOUT = {wanted.get(HEARTBEAT, TOLERANT_HEARTBEAT_S)}")
        if hal and line == "HALFILE = spindle.hal":
            lines.append("HALFILE = test.hal")
    ini.write_text("\n".join(lines) + "\n")
    (folder / "local.nml").write_text(re.sub(r"TCP=\d+ xdr", "", PACKAGED_NML.read_text()))
    if hal:
        (folder / "test.hal").write_text(hal)
    return ini


class Run:
    """One run of the launcher."""

    def __init__(self, ini: Path, *options: str, speed: float = 1.0) -> None:
        environment = dict(os.environ)
        environment["HOME"] = str(ini.parent)
        environment["PYTHONPATH"] = os.pathsep.join(filter(None, [str(ROOT), environment.get("PYTHONPATH")]))
        self.namespace = environment[namespace.VARIABLE]
        # Files, which a talkative display cannot fill as it could a pipe
        self._said = tempfile.TemporaryFile("w+"), tempfile.TemporaryFile("w+")  # noqa: SIM115  closed by finish
        self.process = subprocess.Popen(
            [sys.executable, "-m", "linuxcnc_start", str(ini), "--speed", str(speed), *options],
            env=environment,
            cwd=ini.parent,
            stdin=subprocess.DEVNULL,
            stdout=self._said[0],
            stderr=self._said[1],
            start_new_session=True,
        )
        self._output: tuple[str, str] | None = None

    @property
    def output(self) -> str:
        """What it printed, once it has ended."""
        self.finish()
        assert self._output is not None
        return self._output[0]

    @property
    def errors(self) -> str:
        """What it said on stderr, once it has ended; nothing of how busy this computer is."""
        self.finish()
        assert self._output is not None
        lines = self._output[1].splitlines(keepends=True)
        return "".join(line for line in lines if not any(words in line for words in OF_THE_COMPUTER))

    def has_said(self, words: str) -> bool:
        """Whether this is on its stderr by now; its processes share the file's place, which must stay as it is."""
        return words.encode() in os.pread(self._said[1].fileno(), MOST_SAID, 0)

    def finish(self, timeout: float = 120.0) -> int:
        """Wait for its end; the exit code."""
        if self._output is None:
            self.process.wait(timeout)
            self._output = self._read(self._said[0]), self._read(self._said[1])
        return self.process.returncode

    @staticmethod
    def _read(file: IO[str]) -> str:
        file.seek(0)
        with file:
            return file.read()

    def stop(self) -> int:
        """End it as Ctrl-C or a service manager would."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        return self.finish()

    def pids(self) -> dict[str, int]:
        """Its processes by name, as far as they were started."""
        path = namespace.runtime_dir() / "processes"
        lines = path.read_text().splitlines() if path.exists() else []
        return {line.split()[2]: int(line.split()[0]) for line in lines}

    def port(self) -> int:
        """The port of its linuxcncrsh, waited for."""
        path = namespace.runtime_dir() / "linuxcncrsh.port"
        wait_until(lambda: self.process.poll() is not None or (path.exists() and path.read_text().strip()), "display")
        assert self.process.poll() is None, self.errors
        return int(path.read_text())


@contextmanager
def running(ini: Path, *options: str, speed: float = 1.0) -> Iterator[Run]:
    """A machine that is up, and is gone afterwards."""
    run = Run(ini, *options, speed=speed)
    try:
        yield run
    finally:
        if run.process.poll() is None:
            run.process.send_signal(signal.SIGTERM)
            try:
                run.finish(PATIENCE)
            except subprocess.TimeoutExpired:
                run.process.kill()
                run.finish()


def traces() -> list[str]:
    """What is left of the namespace: shared memory, files, processes."""
    prefix = namespace.shm_name("").lstrip("/")
    left = [str(path) for path in Path("/dev/shm").glob(f"*{prefix}*")]
    folder = namespace.runtime_dir()
    left += [str(path) for path in folder.iterdir()]
    folder.rmdir() if not any(folder.iterdir()) else None
    return left + [f"process {pid}: {name}" for pid, name in processes()]


def processes() -> list[tuple[int, str]]:
    """Processes of the namespace other than this one: (pid, command line)."""
    marker = f"{namespace.VARIABLE}={namespace.namespace()}\0".encode()
    found = []
    for entry in Path("/proc").iterdir():
        if not entry.name.isdecimal() or int(entry.name) == os.getpid():
            continue
        try:
            environment = (entry / "environ").read_bytes() + b"\0"
            command = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:
            continue
        if marker in environment and command:
            found.append((int(entry.name), command))
    return found


class RshClient:
    """A client of linuxcncrsh that reads whole lines."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("localhost", port), timeout=PATIENCE)
        self._file = self.socket.makefile("rb")

    def __enter__(self) -> RshClient:
        return self

    def __exit__(self, *exc_info: object) -> None:
        self._file.close()
        self.socket.close()

    def send(self, line: str) -> None:
        self.socket.sendall(line.encode() + b"\r\n")

    def line(self) -> str:
        return self._file.readline().decode("latin-1").rstrip("\r\n")

    def ask(self, line: str) -> str:
        """One line of answer to one line; echo must be off."""
        self.send(line)
        return self.line()

    def take_control(self) -> None:
        """Say hello, switch the echo off and the acknowledgements on, and take control."""
        self.send("hello EMC test 1.0")
        assert self.line().startswith("HELLO ACK")
        self.send("set echo off")
        assert self.line() == "set echo off"
        assert self.ask("set verbose on") == "SET VERBOSE ACK"
        assert self.ask("set enable EMCTOO") == "SET ENABLE ACK"
