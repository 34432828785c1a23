"""How long the loaded program takes, line by line: ``linuxcnc-forecast``, a process of its own, after each preview."""

from __future__ import annotations

import asyncio
import json
import logging
from pathlib import Path
from typing import Any

import numpy as np

from gui.web import frames
from gui.web.preview import Preview
from gui.web.state import State
from gui.web.workers import end_worker, start_worker

log = logging.getLogger(__name__)

MODULE = "emcmot.forecast"
PATIENCE = 300.0  # s


class Forecast:
    """The forecast of the program whose preview came to its end last."""

    def __init__(self, ini: Path, state: State, preview: Preview) -> None:
        self._ini = ini
        self._state = state
        self._preview = preview
        self._task: asyncio.Task[None] | None = None
        state.update({"forecast": None})
        preview.when_done(self._restart)

    def stop(self) -> None:
        """End the worker."""
        if self._task is not None:
            self._task.cancel()
            self._task = None

    def _restart(self, path: Path, job: int) -> None:
        self.stop()
        self._publish(path, job, "running")
        self._task = asyncio.create_task(self._run(path, job))

    def _publish(self, path: Path, job: int, state: str, seconds: float = 0.0, text: str = "") -> None:
        self._state.update(
            {"forecast": {"job": job, "file": str(path), "state": state, "seconds": seconds, "text": text}}
        )

    async def _run(self, path: Path, job: int) -> None:
        """One worker, from start to its answer."""
        stands = self._preview.present()
        worker = await start_worker(MODULE, str(self._ini), str(path), "--json", "-", *stands, nice=True)
        try:
            async with asyncio.timeout(PATIENCE):
                output, errors = await worker.communicate()
            found = await asyncio.to_thread(json.loads, output)
        except TimeoutError:
            found, errors = None, b"the forecast takes too long"
        except ValueError:
            found = None
        finally:
            await end_worker(worker)
        if found is None:
            said = errors.decode(errors="replace").strip().splitlines()
            self._publish(path, job, "failed", text=said[-1] if said else "the forecast failed")
            self._preview.attach(
                job, encode(job, {"seconds": 0.0, "lines": [], "sections": []}, said[-1] if said else "")
            )
            return
        self._preview.attach(job, await asyncio.to_thread(encode, job, found, ""))
        self._publish(path, job, "whole", found["seconds"])


def encode(job: int, found: dict[str, Any], text: str) -> bytes:
    """The frame for the page; ``lines``: pairs of a line and the time at which it is done."""
    pairs = np.array(found["lines"], np.float64).reshape(-1, 2)
    sections = [
        {"tool": tool, "text": operation, "motion": motion, "pauses": pauses}
        for tool, operation, motion, pauses in found["sections"]
    ]
    return frames.encode(
        "forecast",
        {
            "job": job,
            "seconds": found["seconds"],
            "lines": pairs[:, 0].astype("<u4").tobytes(),
            "times": pairs[:, 1].astype("<f4").tobytes(),
            "sections": sections,
            "text": text,
        },
    )
