"""The realtime host process, ``python -m hal.host``: takes requests for its threads and modules over a Unix socket.

It is started by ``hal.client`` with a listening socket as file descriptor 3, one for each namespace, and runs until it
is told to end (``quit``) or its segment is gone. A request is a line of JSON, ``{"do": NAME, "args": [...]}``; the
answer is ``{"ok": result}`` or ``{"error": text, "errno": n}``, with ``"notes": [...]`` for the user: what the system
refused, what realtime functions said, late threads, components that died. Each is in the log too, at once; ``notes``
only asks for them.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import socket
import sys
import time
import traceback
from collections.abc import Callable
from typing import Any

from hal._messages import hear
from hal.client import LISTENER_FD
from hal.process import own_identity
from hal.realtime import Host
from nml.errors import PyemcError
from nml.namespace import shm_name

SWEEP_SECONDS = 0.5  # host time between looks for dead components and messages
PATIENCE_SECONDS = 0.25  # host time; a machine that ends because of such a death says so itself


class Server:
    """Requests in, answers out, one at a time."""

    def __init__(self, listener: socket.socket) -> None:
        self.listener = listener
        self.host = Host()
        self.running = True
        self.woken, self.wake = socket.socketpair()  # a signal writes, so that `select` returns at once
        self.wake.setblocking(False)
        self._lines: dict[socket.socket, bytes] = {}
        self._requests: dict[str, Callable[..., Any]] = {
            "loadrt": self.host.load,
            "unloadrt": self.host.unload,
            "loaded": self.host.loaded,
            "provided": self.host.provided,
            "addf": self.host.add_function,
            "delf": self.host.remove_function,
            "quit": self.quit,
        }
        self._late: set[str] = set()  # threads whose first overrun has been told
        self._died: dict[str, float] = {}  # components, and since when that is known
        self._overworked: set[str] = set()  # threads that were said to have too much to do

    def quit(self) -> None:
        """End: stop the threads, unload everything."""
        self.running = False

    def look(self, patience: float = 0.0) -> None:
        """Gather what is to be told; of components that died when they are dead for so many seconds."""
        for text in hear():
            self.host.note(text)
        now = time.monotonic()
        self._died.update(dict.fromkeys(self.host.hal.reap(), now))
        for name in [name for name, since in self._died.items() if now - since >= patience]:
            del self._died[name]
            self.host.note(f"HAL: component '{name}' died without leaving; removed")
        for name, complaint in self.host.overworked():
            if name not in self._overworked:
                self._overworked.add(name)
                self.host.note(f"{complaint}. Give the thread a longer period, or less to do")
        for thread in self.host.hal.segment.threads() if self.host.realtime else []:
            if thread.overruns and thread.name not in self._late:
                self._late.add(thread.name)
                self.host.note(
                    f"Unexpected realtime delay: thread '{thread.name}' began more than its period of "
                    f"{thread.period_ns} ns late. This is said once; latency-test shows what the machine can do"
                )

    def serve(self) -> None:
        """Until told to end; threads go on by themselves meanwhile."""
        segment = self.host.hal.segment
        segment.host = own_identity()
        segment.skip_ids(1)
        try:
            while self.running and os.path.exists("/dev/shm" + shm_name("hal")):
                sweep = PATIENCE_SECONDS if self._died else SWEEP_SECONDS
                ready, _, _ = select.select([self.listener, self.woken, *self._lines], [], [], sweep)
                for source in ready:
                    if source is self.listener:
                        self._lines[source.accept()[0]] = b""
                    elif source in self._lines:
                        self._receive(source)
                self.look(PATIENCE_SECONDS)
        finally:
            self.host.hal.halt_threads()
            segment.host = (0, 0)
            self.host.close()

    def _receive(self, source: socket.socket) -> None:
        try:
            data = source.recv(65536)
        except OSError:
            data = b""
        if not data:
            del self._lines[source]
            source.close()
            return
        *lines, self._lines[source] = (self._lines[source] + data).split(b"\n")
        for line in lines:
            answer = self._answer(line)
            with contextlib.suppress(OSError):  # who asked may be gone
                source.sendall(json.dumps(answer).encode() + b"\n")

    def _answer(self, line: bytes) -> dict[str, Any]:
        answer: dict[str, Any]
        try:
            request = json.loads(line)
            answer = {"ok": self._requests[request["do"]](*request["args"])}
        except PyemcError as error:
            answer = {"error": str(error), "errno": getattr(error, "errno", -22)}
        except Exception as error:  # a module's mistake is the user's to read, and no reason for the host to end
            traceback.print_exception(error)
            place = traceback.extract_tb(error.__traceback__)[-1]
            answer = {"error": f"{place.filename}:{place.lineno}: {type(error).__name__}: {error}", "errno": -14}
        self.look(0.0 if self.running else PATIENCE_SECONDS)
        answer["notes"], self.host.notes = self.host.notes, []
        return answer


def main() -> int:
    """Serve on the inherited socket."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    listener = socket.socket(fileno=LISTENER_FD)
    server = Server(listener)
    signal.signal(signal.SIGTERM, lambda *_: server.quit())
    signal.set_wakeup_fd(server.wake.fileno(), warn_on_full_buffer=False)
    try:
        server.serve()
    finally:
        with contextlib.suppress(OSError):
            os.unlink(listener.getsockname())
    return 0


if __name__ == "__main__":
    sys.exit(main())
