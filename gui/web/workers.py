"""Processes that compute for the server: killed without harm, and one of them always started ahead of its work.

A Python process with its imports takes a quarter of a second to start, on a busy machine longer; a person who sends
a line of MDI or opens a program should not wait for that. A spare one waits at its standard input for its arguments,
one line of JSON, and ends when the server does.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import sys
from asyncio.subprocess import DEVNULL, PIPE, Process

LARGEST_LINE = 1 << 20  # bytes of a worker's header
REFILL_AFTER = 0.5  # s; the spare must not hold up the worker that was just given its work
WAIT = "--wait"


class Workers:
    """Workers of one module."""

    def __init__(self, module: str) -> None:
        self._module = module
        self._spare: Process | None = None
        self._refilling: asyncio.Task[None] | None = None

    async def start(self, *arguments: str) -> Process:
        """A worker with these arguments."""
        worker, self._spare = self._spare, None
        if worker is None or worker.returncode is not None:
            worker = await start_worker(self._module, WAIT)
        assert worker.stdin is not None
        with contextlib.suppress(ConnectionError):
            worker.stdin.write(json.dumps(arguments).encode() + b"\n")
            await worker.stdin.drain()
        self.refill(REFILL_AFTER)
        return worker

    def refill(self, delay: float = 0.0) -> None:
        """Have a spare one soon."""
        if self._refilling is None or self._refilling.done():
            self._refilling = asyncio.create_task(self._refill(delay))

    async def _refill(self, delay: float) -> None:
        await asyncio.sleep(delay)
        if self._spare is None:
            self._spare = await start_worker(self._module, WAIT)

    async def close(self) -> None:
        """End the spare one."""
        if self._refilling is not None:
            self._refilling.cancel()
        if self._spare is not None:
            await end_worker(self._spare)


async def start_worker(module: str, *arguments: str, nice: bool = False) -> Process:
    """Start one of our modules with pipes, away from the terminal's Ctrl-C.

    ``nice``: nobody waits for it, it takes what others leave.
    """
    return await asyncio.create_subprocess_exec(
        *(["nice"] if nice else []), sys.executable, "-P", "-m", module, *arguments,
        stdin=PIPE if WAIT in arguments else DEVNULL, stdout=PIPE, stderr=PIPE, limit=LARGEST_LINE,
        start_new_session=True,
    )  # fmt: skip


async def end_worker(worker: Process) -> None:
    """Kill a worker that still runs and take its end."""
    with contextlib.suppress(ProcessLookupError):
        if worker.returncode is None:
            worker.kill()
    await asyncio.shield(worker.wait())
