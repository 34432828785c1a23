"""The tool path of the loaded program, computed by a process of its own and handed on in chunks.

The worker (``python -m rs274ngc.dryrun``) may take long, fail or be killed: the server goes on, and says what
became of the picture. A preview is ``whole`` only if the worker came to the program's end and assumed nothing on its
way.
"""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import linuxcnc
from gui.web import frames, present
from gui.web.calls import CallError
from gui.web.state import State
from gui.web.workers import Workers, end_worker

if TYPE_CHECKING:
    from gui.web.client import Client

log = logging.getLogger(__name__)

MODULE = "rs274ngc.dryrun"
PIECE = 8192  # rows of a chunk
ROTARY = slice(3, 6)
MOST_BYTES = 1 << 30  # of encoded chunks that are kept
CHECK_SECONDS = 20.0
ROW = np.dtype(
    [
        ("end", "<f8", 9), ("feed", "<f8"), ("speed", "<f8"), ("line", "<i4"), ("kind", "<i4"), ("tool", "<i4"),
        ("coolant", "<i4"),
    ]
)  # fmt: skip
"""A row of the worker: mm, degrees, mm/min."""
MOST_OUTSIDE = 100


@dataclass(slots=True)
class Job:
    """One preview: the chunks that are there, and whether more will come."""

    number: int
    path: Path
    chunks: list[bytes] = field(default_factory=list)
    moves: int = 0
    size: int = 0
    end: bytes | None = None
    forecast: bytes | None = None
    grown: asyncio.Event = field(default_factory=asyncio.Event)

    def add(self, data: bytes, last: bool = False) -> None:
        """One more chunk, or the end, for everybody who waits."""
        if last:
            self.end = data
        else:
            self.chunks.append(data)
            self.size += len(data)
        self.announce()

    def announce(self) -> None:
        """Wake everybody who waits for more."""
        self.grown.set()
        self.grown = asyncio.Event()


class Preview:
    """The present preview and who wants it."""

    def __init__(self, ini: Path, config: dict[str, Any], state: State) -> None:
        self.job: Job | None = None
        self._ini = ini
        self._workers = Workers(MODULE)
        self._workers.refill()
        self._state = state
        self._scale = np.ones(9)
        mm = config["units"]["mm_per_unit"]
        self._scale[:] = 1.0 / mm
        self._scale[ROTARY] = 1.0 / config["units"]["degrees_per_unit"]
        self._mm = mm
        self._number = 0
        self._task: asyncio.Task[None] | None = None
        self._wanted: tuple[Any, ...] | None = None
        self._modes: frozenset[str] = frozenset()  # codes that a program finds when it is started
        self._subscribers: set[Client] = set()
        self._done: list[Callable[[Path, int], None]] = []
        state.update({"preview": None})
        state.listen(self._state_changed)

    def when_done(self, action: Callable[[Path, int], None]) -> None:
        """Call ``action(path, job)`` when a preview has come to the program's end."""
        self._done.append(action)

    def attach(self, number: int, forecast: bytes) -> None:
        """The forecast of a job, for everybody who has its picture."""
        if self.job is not None and self.job.number == number:
            self.job.forecast = forecast
            self.job.announce()

    # --- when it is computed ---------------------------------------------------------------------------------------

    def _state_changed(self, changed: dict[str, Any]) -> None:
        if changed.keys() & {"program", "offsets", "tools", "gcode_text", "interp_state"}:
            program = self._state.get("program")
            if self._state.get("interp_state", linuxcnc.INTERP_IDLE) == linuxcnc.INTERP_IDLE:
                self._modes = present.CARRIED.intersection(self._state.get("gcode_text", ()))
            wanted = program and (
                program["file"], program["version"], self._state.get("offsets"), self._state.get("tools"), self._modes,
            )  # fmt: skip
            if wanted != self._wanted:
                self._wanted = wanted
                self.restart()

    def restart(self) -> None:
        """Compute the loaded program's path anew."""
        self.cancel()
        self.job = None
        program = self._state.get("program")
        if program is None:
            self._state.update({"preview": None})
            return
        self._number += 1
        self.job = Job(self._number, Path(program["file"]))
        self._publish("running", 0.0)
        self._task = asyncio.create_task(self._run(self.job))
        for client in list(self._subscribers):
            self._stream(client)

    def cancel(self) -> None:
        """End the worker; what it has sent stays, as a part."""
        if self._task is not None:
            self._task.cancel()
            self._task = None

    async def close(self) -> None:
        """End every worker."""
        self.cancel()
        await self._workers.close()

    def _publish(self, state: str, progress: float, text: str = "") -> None:
        job = self.job
        if job is not None:
            self._state.update(
                {
                    "preview": {
                        "job": job.number, "file": str(job.path), "state": state, "progress": progress, "text": text,
                    }
                }
            )  # fmt: skip

    # --- the worker ------------------------------------------------------------------------------------------------

    async def _run(self, job: Job) -> None:
        """One worker from start to end."""
        end: dict[str, Any] = {"error": {"message": "the preview was cancelled"}}
        try:
            end = await self._work(job)
        except asyncio.CancelledError:
            self._finish(job, end)
            raise
        except Exception as reason:
            log.exception("preview")
            end = {"error": {"message": f"the preview failed: {reason}"}}
        self._finish(job, end)

    async def _work(self, job: Job) -> dict[str, Any]:
        """Read the worker's frames; its last one."""
        worker = await self._workers.start(
            str(job.path), "-i", str(self._ini), "--piece", str(PIECE), *self.present()
        )
        assert worker.stdout is not None
        try:
            while (line := await worker.stdout.readline()).strip():
                header = json.loads(line)
                data = await worker.stdout.readexactly(header["bytes"])
                if header["frame"] == "end":
                    return dict(header)
                rows = np.frombuffer(data, ROW)
                job.add(await asyncio.to_thread(self._chunk, job, rows, header["done"]))
                job.moves += len(rows)
                self._publish("running", header["done"])
                if job.size > MOST_BYTES:
                    return {"error": {"message": "the program has too many moves for a picture"}}
            errors = (await worker.stderr.read()).decode(errors="replace").strip() if worker.stderr else ""
            return {"error": {"message": errors.splitlines()[-1] if errors else "the preview ended too soon"}}
        finally:
            await end_worker(worker)

    def _chunk(self, job: Job, rows: Any, progress: float) -> bytes:
        """Rows of the worker as a frame for the page."""
        return frames.encode(
            "path",
            {
                "job": job.number,
                "chunk": len(job.chunks),
                "first": job.moves,
                "count": len(rows),
                "progress": progress,
                "end": (rows["end"] * self._scale).astype("<f4").tobytes(),
                "line": rows["line"].astype("<u4").tobytes(),
                "kind": rows["kind"].astype("u1").tobytes(),
                "feed": (rows["feed"] / self._mm).astype("<f4").tobytes(),
                "tool": np.clip(rows["tool"], 0, 65535).astype("<u2").tobytes(),
            },
        )

    def _finish(self, job: Job, end: dict[str, Any]) -> None:
        """Tell how it ended."""
        error, notes = end.get("error"), end.get("notes", [])
        text = describe(error) if error else "; ".join(f"line {note['line']}: {note['text']}" for note in notes[:3])
        whole = error is None and not notes
        job.add(
            frames.encode(
                "path_end",
                {
                    "job": job.number, "whole": whole, "text": text, "notes": notes, "moves": job.moves,
                    "extents": end.get("extents"), "outside": end.get("outside", [])[:MOST_OUTSIDE],
                    "outside_count": end.get("outside_count", 0), "tools": end.get("tools", []),
                    "line": (error or {}).get("line", 0),
                },
            ),
            last=True,
        )  # fmt: skip
        if job is self.job:
            self._publish("whole" if whole else "part" if job.moves else "failed", 1.0, text)
            if error is None:
                for action in self._done:
                    action(job.path, job.number)

    # --- who gets it -----------------------------------------------------------------------------------------------

    def subscribe(self, client: Client) -> int | None:
        """Send the present preview and all later ones; the present job."""
        self._subscribers.add(client)
        self._stream(client)
        return None if self.job is None else self.job.number

    def unsubscribe(self, client: Client) -> None:
        self._subscribers.discard(client)
        client.stream("path", None)

    def _stream(self, client: Client) -> None:
        if client.id not in client.server.hub.clients:
            self._subscribers.discard(client)
        elif self.job is not None:
            client.stream("path", asyncio.create_task(_feed(client, self.job)))

    # --- dry runs --------------------------------------------------------------------------------------------------

    async def state_at(self, path: Path, line: int) -> dict[str, Any]:
        """The state that the program has when a line is next."""
        return await self._ask(str(path), "--state-at", str(line), *self.present())

    async def check_block(self, text: str) -> dict[str, Any]:
        """A dry run of one MDI line from where the machine stands; CallError gcode where it is wrong."""
        return await self._ask(f"--mdi={text}", *self.present())

    def present(self) -> list[str]:
        """How the machine stands now, as arguments of a worker."""
        return present.arguments(self._state.values, self._mm)

    async def check_file(self, path: Path) -> list[dict[str, Any]]:
        """The errors of a program: one, where the interpreter stops."""
        try:
            await self._ask(str(path), "--check", *self.present())
        except CallError as wrong:
            if wrong.code != "gcode":
                raise
            return [{"line": wrong.more["line"], "column": wrong.more["column"], "text": wrong.more["reason"]}]
        return []

    async def _ask(self, *arguments: str) -> dict[str, Any]:
        """Run a worker that answers with one line of JSON."""
        worker = await self._workers.start(*arguments, "-i", str(self._ini))
        try:
            async with asyncio.timeout(CHECK_SECONDS):
                answer, errors = await worker.communicate()
        except TimeoutError:
            raise CallError("check", "the check takes too long") from None
        finally:
            await end_worker(worker)
        try:
            found = json.loads(answer.splitlines()[-1])
        except (ValueError, IndexError):
            said = errors.decode(errors="replace").strip().splitlines()
            raise CallError("check", "this cannot be checked: {reason}", reason=said[-1] if said else "?") from None
        error = found.get("error")
        if error:
            raise CallError(
                "gcode", "{reason}", reason=error["message"], line=error.get("line", 0),
                column=error.get("column", 0), file=error.get("file", ""),
            )  # fmt: skip
        return dict(found)


def describe(error: dict[str, Any]) -> str:
    """An error of the worker as one line."""
    line = error.get("line")
    return f"line {line}: {error['message']}" if line else str(error["message"])


async def _feed(client: Client, job: Job) -> None:
    """Send one job to one client, as fast as both go."""
    sent = 0
    while True:
        grown = job.grown
        while sent < len(job.chunks):
            await client.send_patiently(job.chunks[sent])
            sent += 1
        if job.end is not None and sent == len(job.chunks):
            break
        await grown.wait()
    await client.send_patiently(job.end)
    while job.forecast is None:
        await job.grown.wait()
    await client.send_patiently(job.forecast)
