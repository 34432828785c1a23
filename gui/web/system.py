"""The machine's processes, NML buffers and threads, for the page that shows how the controller itself is doing."""

from __future__ import annotations

import asyncio
import json
import os
import sys
from pathlib import Path
from typing import Any

from linuxcnc.instance import ProcessRecord
from nml import clock, namespace

TICKS = os.sysconf("SC_CLK_TCK")
PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")
RATE_SECONDS = 0.2  # over which the rates of buffers are measured


class Processes:
    """The processes that the launcher has started, with the share of a CPU that each took since the last look."""

    def __init__(self) -> None:
        self._before: dict[int, tuple[float, float]] = {}

    def look(self) -> list[dict[str, Any]]:
        """One row for each process."""
        rows = []
        for record in _records():
            used, memory, now = *_usage(record.pid), clock.host_now()
            past, then = self._before.get(record.pid, (used, now - 1.0))
            self._before[record.pid] = (used, now)
            rows.append(
                {
                    "name": record.name, "pid": record.pid, "alive": record.alive, "memory": memory,
                    "cpu": max(0.0, (used - past) / max(now - then, 1e-3)),
                }
            )  # fmt: skip
        return rows


def _records() -> list[ProcessRecord]:
    try:
        lines = (namespace.runtime_dir() / "processes").read_text().splitlines()
    except OSError:
        return []
    return [record for line in lines if (record := ProcessRecord.parse(line))]


def _usage(pid: int) -> tuple[float, int]:
    """CPU time in s and resident memory in bytes; zeros for a process that is gone."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0, 0
    return (int(fields[11]) + int(fields[12])) / TICKS, int(fields[21]) * PAGE_BYTES


async def buffers(ini: Path) -> list[dict[str, Any]]:
    """One row for each NML buffer, by ``nmlstat``, which looks without taking a message from anybody."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-P", "-m", "nml.tools.nmlstat", "-ini", str(ini), "--json", "-i", str(RATE_SECONDS),
        stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.DEVNULL,
    )  # fmt: skip
    output, _ = await process.communicate()
    return [json.loads(line) for line in output.splitlines() if line.startswith(b"{")]
