"""The NML gateway, /nml: EMC messages by name, as JSON or msgpack, for clients in any language.

A client says hello with its token, then sends commands, subscribes to buffers and asks what messages look like; see
docs/web-protocol.md. Each connection has channels of its own. Commands are not asked for the controls of the display:
the owner of the machine has given this program an operator's token.
"""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import Awaitable, Callable
from typing import Any

import msgpack
from aiohttp import WSMsgType, web

import linuxcnc
from gui.web.access import Role, bearer
from gui.web.calls import CallError
from gui.web.ends import Ends
from gui.web.programjogs import ProgramJogs
from linuxcnc._connection import error, open_channel
from nml.channel import Channel
from nml.codecs import packed
from nml.emc import EMC_JOG_CONT, EMC_JOG_STOP
from nml.errors import NmlError
from nml.message import Command, Message, registry

JSON, MSGPACK = "nml.json", "nml.msgpack"
BUFFERS = ("emcStatus", "emcError", "toolTable")
SHORTEST_INTERVAL, LONGEST_INTERVAL = 0.02, 60.0  # s between status messages
ERROR_INTERVAL = 0.02  # s between looks at operator messages
LONGEST_FRAME = 1 << 18
HELLO_TIMEOUT = 10.0  # s
HEARTBEAT = 10.0  # s
BAD_TOKEN = 4401

NAMES: dict[str, type[Message]] = {cls.__name__: cls for cls in registry.values()}


class Wrong(Exception):
    """A frame that cannot be obeyed; the text goes back to the client."""


def command_message(name: Any, fields: Any) -> Command:
    """The command of a frame; Wrong names what does not fit."""
    cls = NAMES.get(name) if isinstance(name, str) else None
    if cls is None or not issubclass(cls, Command) or not name.startswith("EMC_"):
        raise Wrong(f"there is no command {name!r}")
    if not isinstance(fields, dict):
        raise Wrong("fields must be a map")
    if not finite(fields):
        raise Wrong("numbers must be finite")
    try:
        message = packed.decode(msgpack.packb([cls.TYPE_ID, {}, fields]))
    except (NmlError, TypeError, ValueError, OverflowError) as reason:
        raise Wrong(str(reason)) from None
    assert isinstance(message, Command)
    return message


def finite(value: Any) -> bool:
    """Whether every number within is one that a machine can be sent to."""
    if isinstance(value, dict):
        return all(finite(one) for one in value.values())
    if isinstance(value, list):
        return all(finite(one) for one in value)
    return not isinstance(value, float) or math.isfinite(value)


def plain(value: Any) -> Any:
    """A message's values as every JSON reader takes them: no infinities, no bytes that are not text."""
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, list):
        return [plain(one) for one in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value.encode("utf-8", "replace").decode() if isinstance(value, str) else value


def describe(name: Any) -> dict[str, Any]:
    """The fields of a message."""
    cls = NAMES.get(name) if isinstance(name, str) else None
    if cls is None:
        raise Wrong(f"there is no message {name!r}")
    fields = [
        {"name": field.name, "type": field.c_type, "unit": field.unit, "text": field.doc} for field in cls.BODY
    ]  # fmt: skip
    return {"describe": name, "type": cls.TYPE_ID, "text": (cls.__doc__ or "").strip(), "fields": fields}


class Connection:
    """One client of the gateway."""

    def __init__(self, socket: web.WebSocketResponse, jogs: ProgramJogs, role: Role) -> None:
        self._socket = socket
        self._jogs = jogs
        self._role = role
        self._commands: Channel = open_channel("emcCommand")
        self._ends = Ends()
        self._subscriptions: dict[str, asyncio.Task[None]] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._binary = socket.ws_protocol == MSGPACK

    async def send(self, frame: dict[str, Any]) -> None:
        if self._binary:
            await self._socket.send_bytes(msgpack.packb(frame))
        else:
            await self._socket.send_str(json.dumps(frame))

    async def converse(self) -> None:
        """Obey frames until the client goes."""
        await self.send({"hello": {"role": self._role.value, "version": linuxcnc.version}})
        try:
            async for message in self._socket:
                await self._obey(message.data)
        finally:
            for task in (*self._subscriptions.values(), *self._tasks):
                task.cancel()
            self._jogs.end()
            self._commands.close()
            self._ends.close()

    async def _obey(self, data: str | bytes) -> None:
        number = None
        try:
            self._jogs.beat()
            frame = read_frame(data, self._binary)
            number = frame.get("id")
            actions: dict[str, Callable[[dict[str, Any]], Awaitable[None]]] = {
                "command": self._command, "subscribe": self._subscribe, "unsubscribe": self._unsubscribe,
                "get": self._get, "describe": self._describe, "beat": self._beat,
            }  # fmt: skip
            for name, action in actions.items():
                if name in frame:
                    await action(frame)
                    return
            raise Wrong(f"one of {', '.join(actions)} is needed")
        except Wrong as reason:
            await self.send({"id": number, "error": str(reason)})
        except (NmlError, error) as reason:
            await self.send({"id": number, "error": f"the machine is out of reach: {reason}"})

    async def _command(self, frame: dict[str, Any]) -> None:
        if self._role is not Role.OPERATOR:
            raise Wrong("readers may look, not command")
        message = command_message(frame["command"], frame.get("fields", {}))
        try:
            serial = await self._give(message)
        except CallError as reason:
            raise Wrong(reason.text.format(**reason.more)) from None
        await self.send({"id": frame.get("id"), "serial": serial})
        task = asyncio.create_task(self._follow(frame.get("id"), serial))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _give(self, message: Command) -> int:
        """Put a command into task's queue, a continuous jog as what stops by itself; its serial number."""
        if isinstance(message, EMC_JOG_CONT):
            return await self._jogs.go_on(message)
        if isinstance(message, EMC_JOG_STOP):
            await self._jogs.stop(message)
        else:
            self._jogs.drop()
        return await asyncio.to_thread(self._commands.write, message)

    async def _beat(self, frame: dict[str, Any]) -> None:
        """Nothing to do: any frame keeps the jogs of this program going."""

    async def _follow(self, number: Any, serial: int) -> None:
        """Tell how a command ended, with the messages that belong to it."""
        end = await self._ends.of(serial)
        answer = {"id": number, "serial": serial, "result": end.outcome, "messages": end.messages}
        if end.outcome != "done":
            answer["error"] = "; ".join(end.messages) or end.outcome
        await self.send(answer)

    async def _subscribe(self, frame: dict[str, Any]) -> None:
        name, interval = _buffer(frame["subscribe"]), frame.get("interval", 0.05)
        if type(interval) not in (int, float) or not SHORTEST_INTERVAL <= interval <= LONGEST_INTERVAL:
            raise Wrong(f"interval must be {SHORTEST_INTERVAL:g} to {LONGEST_INTERVAL:g} s")
        await self._unsubscribe({"unsubscribe": name})
        channel = open_channel(name)  # now, so that no message is missed that comes from here on
        task = asyncio.create_task(self._pass_on(name, channel, float(interval)))
        task.add_done_callback(lambda _: channel.close())
        self._subscriptions[name] = task

    async def _unsubscribe(self, frame: dict[str, Any]) -> None:
        task = self._subscriptions.pop(_buffer(frame["unsubscribe"]), None)
        if task is not None:
            task.cancel()

    async def _pass_on(self, name: str, channel: Channel, interval: float) -> None:
        """Send the newest status whenever there is one, or every operator message."""
        queue = name == "emcError"
        while True:
            message = channel.read() if queue else channel.peek()
            if message is not None:
                await self._send_message(name, message)
            if message is None or not queue:
                await asyncio.sleep(ERROR_INTERVAL if queue else interval)

    async def _get(self, frame: dict[str, Any]) -> None:
        name = _buffer(frame["get"])
        with open_channel(name) as channel:
            message = channel.peek()
        if message is None:
            raise Wrong(f"{name} holds no message")
        await self._send_message(name, message)

    async def _send_message(self, name: str, message: Message) -> None:
        fields = {field.name: field.plain(message) for field in message.FIELDS if field.part != "header"}
        await self.send({"message": type(message).__name__, "buffer": name, "fields": plain(fields)})

    async def _describe(self, frame: dict[str, Any]) -> None:
        await self.send(describe(frame["describe"]))


def _buffer(name: Any) -> str:
    if name not in BUFFERS:
        raise Wrong(f"there is no buffer {name!r}; {', '.join(BUFFERS)} can be read")
    return str(name)


def read_frame(data: str | bytes, binary: bool) -> dict[str, Any]:
    """The map of a frame; Wrong for anything else."""
    try:
        frame = msgpack.unpackb(data) if binary else json.loads(data)
    except Exception as reason:  # both readers raise many kinds for bad data
        raise Wrong(f"this is no {'msgpack' if binary else 'JSON'}: {reason}"[:200]) from None
    if not isinstance(frame, dict):
        raise Wrong("a frame is a map")
    return frame


async def serve(
    request: web.Request, jogs: ProgramJogs, role_of: Callable[[str | None], Role | None]
) -> web.StreamResponse:
    """One connection from its upgrade to its end."""
    socket = web.WebSocketResponse(protocols=(JSON, MSGPACK), heartbeat=HEARTBEAT, max_msg_size=LONGEST_FRAME)
    await socket.prepare(request)
    role = role_of(bearer(request.headers.get("Authorization")))
    if role is None:
        role = await _token(socket, role_of)
    if role is None:
        await socket.close(code=BAD_TOKEN, message=b"wrong token")
    else:
        await Connection(socket, jogs, role).converse()
    return socket


async def _token(socket: web.WebSocketResponse, role_of: Callable[[str | None], Role | None]) -> Role | None:
    """The role by the token in the first frame."""
    try:
        message = await socket.receive(HELLO_TIMEOUT)
        if message.type not in (WSMsgType.TEXT, WSMsgType.BINARY):
            return None
        token = read_frame(message.data, socket.ws_protocol == MSGPACK).get("hello")
    except (TimeoutError, Wrong):
        return None
    return role_of(token) if isinstance(token, str) else None
