"""A client of the web display for tests: what a page does over /ws, in calls that block until something is so."""

from __future__ import annotations

import asyncio
import contextlib
import os
import shutil
import threading
import uuid
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import aiohttp
import msgpack

from nml import namespace
from tests.support.machine import PATIENCE, Run, copy_mill, running, wait_until


class Refused(Exception):
    """An error frame; ``code`` and the whole ``frame``."""

    def __init__(self, frame: dict[str, Any]) -> None:
        self.frame = frame
        self.code = frame["code"]
        super().__init__(f"{frame['code']}: {frame['text']}")


def web_port(run: Run) -> int:
    """The port of a machine's web display, waited for."""
    path = namespace.runtime_dir() / "web.port"
    wait_until(lambda: run.process.poll() is not None or (path.exists() and path.read_text().strip()), "web display")
    assert run.process.poll() is None, run.errors
    return int(path.read_text())


class WebClient:
    """One page: ``state`` is what it has been told, ``call`` asks for something."""

    def __init__(
        self, port: int, *, token: str | None = None, name: str = "test", origin: str | None = None, lang: str = "en"
    ) -> None:
        self.base = f"http://127.0.0.1:{port}"
        self.origin = origin or self.base
        self.token = token
        self.name = name
        self.lang = lang
        self.hello: dict[str, Any] = {}
        self.state: dict[str, Any] = {}
        self.frames: list[dict[str, Any]] = []
        self.messages: list[dict[str, Any]] = []
        self.close_code: int | None = None
        self._answers: dict[int, Future[Any]] = {}
        self._next = 1
        self._beating: set[int] = set()
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)

    def __enter__(self) -> WebClient:
        """Connect; the machine's first status may still be on its way to the server."""
        self._thread.start()
        self.run(self._connect())
        self.wait(lambda state: self.hello["config"]["wizard"] or "task_state" in state, "first status")
        return self

    def __exit__(self, *exc_info: object) -> None:
        self.run(self._close())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def run(self, work: Any) -> Any:
        """Wait for a coroutine in the client's loop."""
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(PATIENCE)

    async def _connect(self) -> None:
        self.session = aiohttp.ClientSession()
        self.socket = await self.session.ws_connect(f"{self.base}/ws", headers={"Origin": self.origin}, max_msg_size=0)
        hello = {"t": "hello", "name": self.name, "lang": self.lang} | ({"token": self.token} if self.token else {})
        await self.socket.send_bytes(msgpack.packb(hello))
        message = await self.socket.receive(PATIENCE)
        if message.type is not aiohttp.WSMsgType.BINARY:
            self.close_code = self.socket.close_code
            await self.session.close()
            raise ConnectionError(f"closed with {self.close_code}: {message.extra}")
        self._take(msgpack.unpackb(message.data))
        self._reader = asyncio.create_task(self._read())
        self._beater = asyncio.create_task(self._beat())

    async def _close(self) -> None:
        if not self.session.closed:
            self._reader.cancel()
            self._beater.cancel()
            await self.socket.close()
            await self.session.close()

    async def _read(self) -> None:
        async for message in self.socket:
            self._take(msgpack.unpackb(message.data))
        self.close_code = self.socket.close_code

    async def _beat(self) -> None:
        while True:
            for number in list(self._beating):
                await self.socket.send_bytes(msgpack.packb({"t": "beat", "jog": number}))
            await asyncio.sleep(0.05)

    def _take(self, frame: dict[str, Any]) -> None:
        match frame["t"]:
            case "hello":
                self.hello, self.state = frame, dict(frame["status"])
            case "status":
                self.state.update(frame["s"])
            case "message":
                self.messages.append(frame)
            case "result":
                self._answers.pop(frame["id"]).set_result(frame["ok"])
            case "error":
                self._answers.pop(frame["id"]).set_exception(Refused(frame))
            case _:
                self.frames.append(frame)

    # --- what tests use --------------------------------------------------------------------------------------------

    def start(self, method: str, **arguments: Any) -> Future[Any]:
        """A call that is not waited for."""
        answer: Future[Any] = Future()
        number, self._next = self._next, self._next + 1
        self._answers[number] = answer
        self.run(self.socket.send_bytes(msgpack.packb({"t": "call", "id": number, "m": method, "a": arguments})))
        return answer

    def call(self, method: str, **arguments: Any) -> Any:
        """A call and its value; Refused for an error."""
        return self.start(method, **arguments).result(PATIENCE)

    def send_raw(self, data: bytes) -> None:
        self.run(self.socket.send_bytes(data))

    def wait(self, condition: Callable[[dict[str, Any]], object], what: str, timeout: float = PATIENCE) -> None:
        """Wait until the state fulfils a condition."""
        wait_until(lambda: condition(self.state), what, timeout)

    def take(self) -> None:
        """Take the controls; the page before may still be about to let go of them."""
        mine = self.hello["client"]
        self.wait(lambda state: state["control"] is None or state["control"]["client"] == mine, "controls are free")
        self.call("control.take")

    def jog_until(self, reached: Callable[[], object], velocity: float, **target: Any) -> int:
        """Jog with the button held until something is so; the number of the jog.

        A busy computer may be late with the signs of life, which ends a jog: then the button is pressed again.
        """
        jog = 0

        def there() -> bool:
            nonlocal jog
            if reached():
                return True
            if all(one["jog"] != jog for one in self.state["jog"]):
                self.let_go(jog)
                with contextlib.suppress(Refused):  # it has begun, and the status does not show it yet
                    jog = self.call("jog.start", velocity=velocity, **target)["jog"]
                    self.hold(jog)
            return False

        wait_until(there, "jogged")
        return jog

    def hold(self, jog: int) -> None:
        """Keep the jog button down."""
        self._beating.add(jog)

    def let_go(self, jog: int) -> None:
        """No beats any more."""
        self._beating.discard(jog)

    def cut(self) -> None:
        """The network is gone: nothing is sent or read any more, and nobody says goodbye."""
        self._beating.clear()
        self.run(self._abandon())

    async def _abandon(self) -> None:
        self._reader.cancel()
        self._beater.cancel()
        assert self.socket._conn is not None
        assert self.socket._conn.transport is not None
        self.socket._conn.transport.pause_reading()

    def ready(self) -> None:
        """Take the controls, switch on, home what is not homed, and stand still."""
        self.take()
        self.call("machine.estop_reset")
        self.call("machine.power", on=True)
        if not self.state["all_homed"]:
            self.call("home", joint=-1)
        self.wait(lambda state: state["all_homed"] and state["inpos"], "homed and at rest")

    def upload(self, name: str, text: str, replace: bool = False) -> int:
        """Send a program; the HTTP status."""
        return int(self.run(self._post(name, text.encode(), replace)))

    async def _post(self, name: str, data: bytes, replace: bool, **headers: str) -> int:
        sent = {"Origin": self.origin, "X-Requested-With": "linuxcnc-web"}
        if self.token:
            sent["Authorization"] = f"Bearer {self.token}"
        query = {"name": name, "replace": str(int(replace))}
        async with self.session.post(f"{self.base}/upload", params=query, data=data, headers=sent | headers) as answer:
            return answer.status


@contextlib.contextmanager
def web_mill(
    folder: Path,
    *,
    changes: dict[str, str] | None = None,
    extra: str = "",
    hal: str = "",
    post: str = "",
    **programs: str,
) -> Iterator[tuple[Run, int]]:
    """A mill with the web display, (run, port).

    ``extra``: more INI lines; ``post``: text of a post-GUI HAL file; ``programs``: texts of NAME.ngc.
    """
    nc_files = folder / "nc"
    nc_files.mkdir(exist_ok=True)
    for name, text in programs.items():
        (nc_files / f"{name}.ngc").write_text(text)
    wanted = {"DISPLAY.DISPLAY": "web --port 0 --no-browser", "DISPLAY.PROGRAM_PREFIX": str(nc_files)}
    ini = copy_mill(folder, changes=wanted | (changes or {}), hal=hal)
    if post:
        (folder / "post.hal").write_text(post)
        line = "HALFILE = spindle.hal\n"
        ini.write_text(ini.read_text().replace(line, f"{line}POSTGUI_HALFILE = post.hal\n"))
    if extra:
        ini.write_text(f"{ini.read_text()}\n{extra}\n")
    with running(ini) as run:
        yield run, web_port(run)


@contextlib.contextmanager
def shared_web_mill(folder: Path, **options: Any) -> Iterator[tuple[str, int]]:
    """A mill for all tests of a file, (namespace, port); each test enters the namespace by `monkeypatch`."""
    name = f"shared{os.getpid()}-{uuid.uuid4().hex[:8]}"
    before = os.environ.get(namespace.VARIABLE)
    os.environ[namespace.VARIABLE] = name
    with web_mill(folder, **options) as (_, port):
        _restore(before)
        yield name, port
        os.environ[namespace.VARIABLE] = name
    shutil.rmtree(namespace.runtime_dir(), ignore_errors=True)
    _restore(before)


def _restore(before: str | None) -> None:
    if before is None:
        os.environ.pop(namespace.VARIABLE, None)
    else:
        os.environ[namespace.VARIABLE] = before
