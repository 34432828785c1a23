"""What NML buffers cost: median of several runs and the worst of them, in a namespace of its own.

    python benchmarks/nml_bench.py [--seconds 0.5] [--json]

``figures.py`` has what a whole controller makes of them, beside LinuxCNC's.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import statistics
import sys
import time
import uuid
from collections.abc import Callable
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
os.environ["PYEMC_NAMESPACE"] = f"bench-{uuid.uuid4().hex[:8]}"

from nml.channel import Channel
from nml.codecs import codec
from nml.config import DEFAULT_FILE, NmlConfig
from nml.emc import EMC_JOG_CONT, EMC_STAT
from nml.emc.emcmot import EMCMOT_COMMAND, EMCMOT_STATUS

RUNS = 5
CONFIG = NmlConfig(DEFAULT_FILE)


class Row:
    """A figure with its runs."""

    def __init__(self, label: str, unit: str, runs: list[float], goal: str = "", more: bool = True) -> None:
        self.label, self.unit, self.goal = label, unit, goal
        self.median = statistics.median(runs)
        self.worst = min(runs) if more else max(runs)

    def text(self) -> str:
        return f"{self.label:58} {self.median:14,.1f} {self.worst:14,.1f} {self.unit:6} {self.goal}"


def rate(work: Callable[[], object], seconds: float) -> list[float]:
    """How often ``work`` runs in a second, for each of RUNS runs."""
    rates = []
    for _ in range(RUNS):
        count, start = 0, time.perf_counter()
        while (elapsed := time.perf_counter() - start) < seconds / RUNS:
            for _ in range(100):
                work()
            count += 100
        rates.append(count / elapsed)
    return rates


def poll_rows(seconds: float) -> list[Row]:
    writer, reader = Channel(CONFIG, "emcStatus", "emc"), Channel(CONFIG, "emcStatus", "xemc")
    status = EMC_STAT()
    mirror = status.copy()
    writer.write(status)
    reader.poll_into(mirror.data)
    poll, data = reader.poll_into, mirror.data

    def changed() -> None:
        writer.write(status)
        poll(data)

    rows = [
        Row("poll with nothing new", "1/s", rate(partial(poll, data), seconds), "2,000,000"),
        Row("write and poll a full status (10,784 bytes)", "1/s", rate(changed, seconds), "20,000"),
        Row("read one attribute, two levels deep", "1/s", rate(lambda: mirror.motion.traj.velocity, seconds)),
    ]
    writer.close()
    reader.close()
    return rows


def message_rows(seconds: float) -> list[Row]:
    writer, reader = Channel(CONFIG, "emcmotCommand", "emc"), Channel(CONFIG, "emcmotCommand", "emcmot")
    pose = tuple(float(n) for n in range(9))

    def move() -> None:
        writer.write(EMCMOT_COMMAND(command=20, id=7, pos=pose, vel=10.0, ini_maxvel=50.0, acc=500.0, termCond=2))
        reader.raw.read()

    rows = [Row("make, queue and take a move for motion", "1/s", rate(move, seconds), "10,000")]
    writer.close()
    reader.close()
    status = EMC_STAT()
    for name in ("xdr", "msgpack", "ascii", "disp"):
        encode, decode = codec(name).encode, codec(name).decode
        encoded = encode(status)
        label = f"EMC_STAT as {name} ({len(encoded)} bytes)"
        rows.append(Row(f"encode {label}", "1/s", rate(partial(encode, status), seconds)))
        rows.append(Row(f"decode {label}", "1/s", rate(partial(decode, encoded), seconds)))
    return rows


def child(work: Callable[[], None]) -> int:
    """A process that works until it is killed."""
    pid = os.fork()
    if pid == 0:
        try:
            work()
        finally:
            os._exit(1)
    return pid


def end(pid: int) -> None:
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)


def latency_row(seconds: float) -> Row:
    """One way from process to process: half the time of a command and its echo."""

    def echo() -> None:
        commands, answers = Channel(CONFIG, "emcCommand", "emc"), Channel(CONFIG, "toolSts", "tool")
        while True:
            command = commands.blocking_read()
            answers.raw.write(command.data)

    pid = child(echo)
    commands, answers = Channel(CONFIG, "emcCommand", "xemc"), Channel(CONFIG, "toolSts", "emc")
    medians = []
    for _ in range(RUNS):
        times, stop = [], time.perf_counter() + seconds / RUNS
        while time.perf_counter() < stop or not times:
            start = time.perf_counter()
            commands.write(EMC_JOG_CONT())
            while answers.raw.read() is None:
                answers.wait(1.0)
            times.append((time.perf_counter() - start) / 2)
        medians.append(statistics.median(times) * 1e6)
    end(pid)
    commands.close()
    answers.close()
    return Row("queued command from one process to another", "us", medians, "100", more=False)


def reader_rows(seconds: float) -> list[Row]:
    """What a write costs while others read every message."""

    def read() -> None:
        reader = Channel(CONFIG, "emcmotStatus", "xemc")
        mirror = bytearray(EMCMOT_STATUS.SIZE)
        while True:
            reader.poll_into(mirror)
            time.sleep(0.001)

    rows = []
    writer = Channel(CONFIG, "emcmotStatus", "emcmot")
    status = EMCMOT_STATUS()
    for readers in (0, 1, 8):
        pids = [child(read) for _ in range(readers)]
        runs = [1e6 / one for one in rate(partial(writer.write, status), seconds)]
        rows.append(Row(f"write EMCMOT_STATUS (5,384 bytes), {readers} readers at 1 kHz", "us", runs, more=False))
        for pid in pids:
            end(pid)
    writer.close()
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=0.5, help="for each figure")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    rows = [*poll_rows(arguments.seconds), *message_rows(arguments.seconds)]
    rows += [latency_row(arguments.seconds), *reader_rows(arguments.seconds)]
    if arguments.json:
        print(json.dumps([vars(row) for row in rows], indent=1))
    else:
        print(f"{'':58} {'median':>14} {'worst':>14} {'':6} goal")
        for row in rows:
            print(row.text())
    return 0


if __name__ == "__main__":
    sys.exit(main())
