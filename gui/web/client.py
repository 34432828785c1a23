"""One browser: its WebSocket from hello to close, the calls that it makes, the frames that wait for it.

A client that reads slowly costs nobody else anything: status changes that it has not read yet are merged into one,
other frames wait up to a limit, and beyond that the connection is closed.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from typing import TYPE_CHECKING, Any

from aiohttp import WSCloseCode, WSMsgType, web

from gui.web import calls, frames, texts
from gui.web.access import Role
from gui.web.calls import Caller, CallError
from gui.web.hub import MOST_CLIENTS

if TYPE_CHECKING:
    from gui.web.server import Server

log = logging.getLogger(__name__)

HELLO_TIMEOUT = 10.0  # s
MOST_WAITING = 32_000_000  # bytes of frames that a client has not read
MOST_CALLS = 64  # of one client at a time
LONGEST_NAME = 40
BAD_DATA, POLICY = 1007, 1008
BAD_TOKEN, NO_HELLO, TOO_MANY, TOO_SLOW = 4401, 4408, 4429, 4430


class Closed(Exception):
    """The connection is to end with this code and reason."""

    def __init__(self, code: int, reason: str) -> None:
        self.code, self.reason = code, reason
        super().__init__(reason)


class Client:
    """One connection to /ws."""

    def __init__(self, server: Server, socket: web.WebSocketResponse, address: str, token: str | None) -> None:
        self.server = server
        self.id = 0
        self.name = ""
        self.language = texts.ENGLISH
        self.role = Role.READER
        self.address = address
        self.since = time.time()
        self.watched: list[str] = []
        self.streams: dict[str, asyncio.Task[None]] = {}
        self._socket = socket
        self._token = token
        self._waiting: deque[bytes] = deque()
        self._bytes = 0
        self._room = asyncio.Event()
        self._dirty: set[str] = set()
        self._count = 0
        self._wake = asyncio.Event()
        self._calls: set[asyncio.Task[None]] = set()
        self._failure: Closed | None = None

    def card(self) -> dict[str, Any]:
        """What others see of this client."""
        return {
            "id": self.id, "name": self.name, "role": self.role.value, "address": self.address, "since": self.since,
        }  # fmt: skip

    # --- frames to the page ----------------------------------------------------------------------------------------

    def send(self, kind: str, fields: dict[str, Any]) -> None:
        """Queue a frame."""
        self._queue(frames.encode(kind, fields))

    async def send_patiently(self, data: bytes) -> None:
        """Queue an encoded frame when the client has read what came before it; for long streams."""
        while self._bytes > MOST_WAITING // 16:
            self._room.clear()
            await self._room.wait()
        self._queue(data)

    def _queue(self, data: bytes) -> None:
        self._waiting.append(data)
        self._bytes += len(data)
        if self._bytes > MOST_WAITING:
            self._failure = Closed(TOO_SLOW, "the client does not read")
        self._wake.set()

    def state_changed(self, changed: dict[str, Any]) -> None:
        """Keys of the state that the page does not know yet."""
        self._dirty.update(changed)
        self._wake.set()

    async def _write(self) -> None:
        """Send what waits, status first, until the connection ends."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            if self._failure is not None:
                await self._socket.close(code=self._failure.code, message=self._failure.reason.encode())
                return
            if self._dirty:
                await self._socket.send_bytes(self._status_frame())
            while self._waiting:
                data = self._waiting.popleft()
                await self._socket.send_bytes(data)
                self._bytes -= len(data)
                self._room.set()
                if self._dirty:
                    await self._socket.send_bytes(self._status_frame())

    def _status_frame(self) -> bytes:
        values = self.server.state.values
        delta = {key: values[key] for key in self._dirty}
        self._dirty.clear()
        self._count += 1
        return frames.encode("status", {"n": self._count, "s": delta, "time": time.time()})

    # --- the conversation ------------------------------------------------------------------------------------------

    async def converse(self) -> None:
        """From hello to close."""
        writer = None
        try:
            await self._greet()
            writer = asyncio.create_task(self._write())
            await self._listen()
        except Closed as end:
            await self._socket.close(code=end.code, message=end.reason.encode()[:120])
        finally:
            self.server.hub.leave(self)
            for task in (*self._calls, *self.streams.values(), *filter(None, [writer])):
                task.cancel()

    async def _greet(self) -> None:
        """Wait for hello, answer with everything there is to know."""
        try:
            message = await self._socket.receive(HELLO_TIMEOUT)
        except TimeoutError:
            raise Closed(NO_HELLO, "no hello") from None
        if message.type is not WSMsgType.BINARY:
            raise Closed(POLICY, "the first frame must be hello")
        frame = self._decoded(message.data)
        if frame["t"] != "hello":
            raise Closed(POLICY, "the first frame must be hello")
        token = frame.get("token")
        role = self.server.access.role(token if isinstance(token, str) else self._token)
        if role is None:
            raise Closed(BAD_TOKEN, "wrong token")
        if len(self.server.hub.clients) >= MOST_CLIENTS:
            raise Closed(TOO_MANY, "too many clients")
        self.role = role
        self.name = _name(frame.get("name"), self.address)
        if frame.get("lang") in texts.codes():
            self.language = frame["lang"]
        self.server.hub.enter(self)
        self._dirty.clear()
        own = {"version": frames.VERSION, "client": self.id, "role": role.value}
        self.send("hello", own | self.server.greeting(self.language))

    async def _listen(self) -> None:
        async for message in self._socket:
            if message.type is not WSMsgType.BINARY:
                raise Closed(POLICY, "frames are binary")
            frame = self._decoded(message.data)
            match frame["t"]:
                case "beat":
                    self.server.jogging.beat(self, frame.get("jog"))
                case "call":
                    self._start_call(frame)
                case "ping":
                    self.send("pong", {"id": frame.get("id"), "time": time.time()})
                case kind:
                    raise Closed(POLICY, f"there is no frame {kind[:20]}")

    def _decoded(self, data: bytes) -> dict[str, Any]:
        try:
            return frames.decode(data)
        except frames.BadFrame as reason:
            raise Closed(BAD_DATA, str(reason)) from None

    def _start_call(self, frame: dict[str, Any]) -> None:
        number = frame.get("id")
        if not isinstance(number, int) or isinstance(number, bool):
            raise Closed(POLICY, "a call needs an integer id")
        if len(self._calls) >= MOST_CALLS:
            self._refuse(number, CallError("busy", "too many calls at a time"))
            return
        task = asyncio.create_task(self._call(number, frame.get("m"), frame.get("a")))
        self._calls.add(task)
        task.add_done_callback(self._calls.discard)

    async def _call(self, number: int, name: Any, arguments: Any) -> None:
        try:
            value = await calls.perform(Caller(self.server, self), name, arguments)
            self.send("result", {"id": number, "ok": value})
        except CallError as refusal:
            self._refuse(number, refusal)
        except Exception:
            log.exception("call %s", name)
            self._refuse(number, CallError("internal", "the display's server made a mistake; its log says more"))

    def _refuse(self, number: int, refusal: CallError) -> None:
        text = texts.fill(self.language, refusal.text, refusal.more)
        self.send("error", {"id": number, "code": refusal.code, **refusal.more, "text": text})

    def stream(self, name: str, task: asyncio.Task[None] | None) -> None:
        """Replace a long-running stream of frames to this client; None ends it."""
        former = self.streams.pop(name, None)
        if former is not None:
            former.cancel()
        if task is not None:
            self.streams[name] = task

    async def dismiss(self) -> None:
        """The server ends."""
        await self._socket.close(code=WSCloseCode.GOING_AWAY, message=b"the server ends")


def _name(wish: Any, address: str) -> str:
    text = "".join(character for character in wish if character.isprintable()) if isinstance(wish, str) else ""
    return text.strip()[:LONGEST_NAME] or address
