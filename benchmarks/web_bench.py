#!/usr/bin/env python3
"""What the web display costs and how soon it tells: run beside nothing else, prints a table.

    python benchmarks/web_bench.py

Measured on a simulated mill with the client of the tests: from an order of another program to the state of a page, the
share of a CPU core of the server at rest, with one page and with fifty readers while the machine moves, and how soon a
program of a million lines shows its first moves and its last.
"""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import linuxcnc
from nml import namespace
from tests.support.machine import wait_until
from tests.support.webclient import WebClient, web_mill

ROUNDS = 50
READERS = 50
SECONDS = 4.0
LINES = 1_000_000
TICKS = os.sysconf("SC_CLK_TCK")


def cpu_seconds(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def share(pid: int) -> float:
    """Percent of a core that a process takes now."""
    used, began = cpu_seconds(pid), time.perf_counter()
    time.sleep(SECONDS)
    return 100.0 * (cpu_seconds(pid) - used) / (time.perf_counter() - began)


def latencies(page: WebClient) -> list[float]:
    """ms from an order given elsewhere to the changed state in the page, the machine's own time included."""
    command, found = linuxcnc.command(), []
    for number in range(ROUNDS):
        value = 0.5 if number % 2 else 0.75
        began = time.perf_counter()
        command.feedrate(value)
        while page.state["feedrate"] != value:
            time.sleep(0.0002)
        found.append(1000.0 * (time.perf_counter() - began))
        time.sleep(0.13)
    return found


def loading(page: WebClient) -> tuple[float, float]:
    """s from the order to load a large program to its first moves and to its last."""
    page.call("path.subscribe")
    began = time.perf_counter()
    page.call("program.open", path="large.ngc")
    wait_until(lambda: any(frame["t"] == "path" for frame in page.frames), "first moves", 60.0)
    first = time.perf_counter() - began
    wait_until(lambda: any(frame["t"] == "path_end" for frame in page.frames), "last moves", 120.0)
    return first, time.perf_counter() - began


def main() -> None:
    os.environ[namespace.VARIABLE] = f"webbench{os.getpid()}"
    large = "G21 G90 F1000\n" + "".join(f"G1 X{k % 97 / 7:.3f} Y{k % 89 / 3:.3f}\n" for k in range(LINES)) + "M2\n"
    with (
        tempfile.TemporaryDirectory() as folder,
        web_mill(Path(folder), large=large) as (run, port),
        WebClient(port) as page,
    ):
        page.ready()
        times = latencies(page)
        print(f"order elsewhere to page       {statistics.median(times):7.1f} ms median, {max(times):.1f} ms worst")
        pid = run.pids()["display"]
        print(f"server at rest, 1 page        {share(pid):7.1f} % of a core")
        page.start("mdi.run", text="G1 F300 X100")
        print(f"server, moving, 1 page        {share(pid):7.1f} %")
        readers = [WebClient(port, name=f"reader {number}").__enter__() for number in range(READERS)]
        print(f"server, moving, {READERS + 1} pages      {share(pid):7.1f} %")
        for reader in readers:
            reader.__exit__()
        page.call("machine.abort")
        first, last = loading(page)
        print(f"first moves of {LINES} lines {first:7.2f} s")
        print(f"last moves of {LINES} lines  {last:7.2f} s")


if __name__ == "__main__":
    main()
