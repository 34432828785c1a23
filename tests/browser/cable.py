"""A network cable between browser and server that can be pulled out: a TCP relay in a thread."""

from __future__ import annotations

import selectors
import socket
import threading

CHUNK = 65536
LOOK_SECONDS = 0.05  # how soon the end of the test is noticed


class Cable:
    """Relays ``port`` to the server. While it is cut nothing passes in either direction, and nobody says goodbye."""

    def __init__(self, server_port: int) -> None:
        self._server_port = server_port
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listener.getsockname()[1]
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._partner: dict[socket.socket, socket.socket] = {}
        self._cut = threading.Event()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._relay, daemon=True)
        self._thread.start()

    def cut(self) -> None:
        self._cut.set()

    def mend(self) -> None:
        """Connections from before are dead; new ones can be made."""
        self._cut.clear()

    def close(self) -> None:
        self._ended.set()
        self._thread.join()

    def _relay(self) -> None:
        was_cut = False
        while not self._ended.is_set():
            ready = self._selector.select(LOOK_SECONDS)
            if self._cut.is_set():
                was_cut = True
                self._ended.wait(LOOK_SECONDS)
                continue
            if was_cut:
                was_cut = False
                self._drop_all()
                continue
            for key, _ in ready:
                self._accept() if key.fileobj is self._listener else self._pass_on(key.fileobj)
        self._drop_all()
        self._listener.close()

    def _accept(self) -> None:
        near, _ = self._listener.accept()
        far = socket.create_connection(("127.0.0.1", self._server_port))
        for one, other in ((near, far), (far, near)):
            self._partner[one] = other
            self._selector.register(one, selectors.EVENT_READ)

    def _pass_on(self, source: object) -> None:
        assert isinstance(source, socket.socket)
        if source not in self._partner:
            return  # its partner was closed in this round
        try:
            data = source.recv(CHUNK)
            self._partner[source].sendall(data)
        except OSError:
            data = b""
        if not data:
            self._drop(source)

    def _drop(self, one: socket.socket) -> None:
        other = self._partner.pop(one)
        self._partner.pop(other, None)
        for end in (one, other):
            self._selector.unregister(end)
            end.close()

    def _drop_all(self) -> None:
        while self._partner:
            self._drop(next(iter(self._partner)))
