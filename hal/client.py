"""Talk to the realtime host of this namespace: start it where it is needed, send requests, notice that it has died."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import socket
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hal.core import Hal
from hal.finder import is_file
from nml.errors import HalError
from nml.namespace import runtime_dir

LISTENER_FD = 3  # in the host


def socket_path() -> Path:
    return runtime_dir() / "hal-host.socket"


def log_path() -> Path:
    """Where the host's messages go: what Python components print, dead components, refusals of the system."""
    return runtime_dir() / "hal-host.log"


class HostClient:
    """A connection to the host; each method raises HalError with the host's reason."""

    def __init__(self, hal: Hal) -> None:
        self.hal = hal
        self._socket: socket.socket | None = None
        self._rest = b""
        self._started: int | None = None
        self.tells = True
        """Print what the host has to say beside its answers; False for who reads its log (``log_path``)."""

    def start(self) -> int | None:
        """Start the host where there is none, as this process; the first request then waits until it answers."""
        self._connect(start=True)
        return self._started

    def loadrt(self, name: str, words: list[str]) -> None:
        """Load a realtime module, or one in a file; the host, started if there is none, has another working folder."""
        self._connect(start=True)
        self._ask("loadrt", os.path.abspath(name) if is_file(name) else name, words)

    def unloadrt(self, name: str) -> None:
        """Unload a module, or ``all`` of them and the host."""
        if name == "all":
            self.quit()
        else:
            self._ask("unloadrt", name)

    def loaded(self) -> list[str]:
        """The realtime modules, in order of loading."""
        if not self._connect():
            return []
        names: list[str] = self._ask("loaded")
        return names

    def provided(self) -> list[str]:
        """What modules offer to those loaded after them: kinematics, planner, homing."""
        names: list[str] = self._ask("provided") if self._connect() else []
        return names

    def addf(self, funct: str, thread: str, position: int = -1) -> None:
        self._ask("addf", funct, thread, position)

    def delf(self, funct: str, thread: str) -> None:
        self._ask("delf", funct, thread)

    def quit(self) -> None:
        """Make the host stop its threads, unload everything and end; where it has died, clear up after it."""
        if self._connect():
            self._ask("quit")
            assert self._socket is not None
            with contextlib.suppress(OSError):
                self._socket.settimeout(5.0)
                while self._socket.recv(4096):
                    pass
        self.close()
        self._forget_dead_host()

    def close(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    # ---- connection ----

    def _connect(self, start: bool = False) -> bool:
        """Whether there is a host to talk to; with ``start`` there is one afterwards."""
        if self._socket is not None:
            return True
        made = _connected(socket_path())
        if made is None and start:
            with _starting():
                made = _connected(socket_path()) or self._start()
        self._socket = made
        return made is not None

    def _start(self) -> socket.socket:
        """Start the host with a socket that listens already, so that the first request can be sent at once."""
        self._forget_dead_host()
        path = socket_path()
        path.unlink(missing_ok=True)
        listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        listener.bind(str(path))
        listener.listen(16)
        log = os.open(log_path(), os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o600)
        # The host is neither of our terminal nor of our pipes: it outlives the command that started it.
        self._started = os.posix_spawn(
            sys.executable,
            [sys.executable, "-m", "hal.host"],
            {**os.environ, "PYTHONPATH": _python_path()},
            file_actions=[
                (os.POSIX_SPAWN_DUP2, listener.fileno(), LISTENER_FD),
                (os.POSIX_SPAWN_OPEN, 0, os.devnull, os.O_RDONLY, 0),
                (os.POSIX_SPAWN_DUP2, log, 1),
                (os.POSIX_SPAWN_DUP2, log, 2),
            ],
            setsid=True,
        )
        os.close(log)
        listener.close()
        made = _connected(path)
        if made is None:
            raise HalError(f"the realtime host cannot be reached at {path}")
        return made

    def _forget_dead_host(self) -> None:
        """Remove the realtime components, functions and threads of a host that was killed."""
        pid, alive = self.hal.host_state()
        if pid and not alive:
            self.hal.forget_realtime()

    def _ask(self, do: str, *args: Any) -> Any:
        if not self._connect():
            pid, alive = self.hal.host_state()
            if pid and not alive:
                raise HalError(f"the realtime host (process {pid}) has died; 'unload all' clears up after it", -3)
            raise HalError("no realtime module is loaded", -3)
        assert self._socket is not None
        try:
            self._socket.sendall(json.dumps({"do": do, "args": args}).encode() + b"\n")
            answer = json.loads(self._line())
        except (OSError, EOFError):
            self.close()
            raise HalError(f"the realtime host died while it did '{do}'; see {log_path()}", -3) from None
        for note in answer["notes"] if self.tells else []:
            print(note, file=sys.stderr)
        if "error" in answer:
            raise HalError(answer["error"], answer["errno"])
        return answer["ok"]

    def _line(self) -> bytes:
        assert self._socket is not None
        while b"\n" not in self._rest:
            data = self._socket.recv(65536)
            if not data:
                raise EOFError
            self._rest += data
        line, _, self._rest = self._rest.partition(b"\n")
        return line


def _connected(path: Path) -> socket.socket | None:
    made = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        made.connect(str(path))
    except OSError:
        made.close()
        return None
    return made


@contextlib.contextmanager
def _starting() -> Iterator[None]:
    """Only one process starts the host at a time."""
    fd = os.open(runtime_dir() / "hal-host.lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        fcntl.flock(fd, fcntl.LOCK_EX)
        yield
    finally:
        os.close(fd)


def _python_path() -> str:
    """The host finds the same packages as this process, wherever it runs."""
    ours = str(Path(__file__).resolve().parent.parent)
    return os.pathsep.join([ours, *filter(None, [os.environ.get("PYTHONPATH")])])
