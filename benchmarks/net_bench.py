"""NML over TCP: our server and LinuxCNC's in the same run, asked by the same clients; median of the runs and the worst.

    python benchmarks/net_bench.py [--seconds 1.0] [--json]

The stock machine runs in namespaces of its own (``tests.support.stock_machine``), and everything else beside it there.
Its task writes a new status every millisecond; so does the stand-in behind our server. Without Debian's package, or
not as root, only our own figures are printed.
"""

from __future__ import annotations

import argparse
import json
import os
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
os.environ.setdefault("PYEMC_NAMESPACE", f"bench-{uuid.uuid4().hex[:8]}")

from nml.channel import Channel
from nml.config import NmlConfig
from nml.net import wire
from tests.support import stock_machine
from tests.support.fake_task import FakeTask
from tests.support.nml_server import free_port, nml_text, running
from tests.support.stock import MODULE_FOUND, StockClient

RUNS = 5
CLIENTS, RATE = 50, 20.0
TICKS = os.sysconf("SC_CLK_TCK")

STOCK_POLLS = """
s = linuxcnc.stat(); s.poll(); n = 0; start = time.perf_counter(); end = start + {seconds}
while time.perf_counter() < end:
    for _ in range(50): s.poll()
    n += 50
out.append(n / (time.perf_counter() - start))
"""
STOCK_COMMANDS = """
c = linuxcnc.command(); c.mode(linuxcnc.MODE_MANUAL); c.wait_complete(); n = 0
start = time.perf_counter(); end = start + {seconds}
while time.perf_counter() < end:
    c.mode(linuxcnc.MODE_MANUAL); c.wait_complete(); n += 1
out.append(1000 * (time.perf_counter() - start) / n)
"""


class Row:
    """A figure with its runs; ``more``: more is better."""

    def __init__(self, label: str, unit: str, goal: str, more: bool = True) -> None:
        self.label, self.unit, self.goal, self.more = label, unit, goal, more
        self.runs: dict[str, list[float]] = {"ours": [], "LinuxCNC": []}

    def text(self) -> str:
        cells = []
        for who in self.runs:
            runs = self.runs[who]
            worst = (min if self.more else max)(runs) if runs else 0.0
            cells.append(f"{statistics.median(runs):10,.1f} ({worst:,.1f})" if runs else " " * 10 + "-")
        return f"{self.label:52} {cells[0]:>24} {cells[1]:>24} {self.unit:8} {self.goal}"


class Peer:
    """A server to be asked: the NML file of its remote clients, its port and its process."""

    def __init__(self, name: str, stock: StockClient, client: Path, port: int, pid: int) -> None:
        self.name, self.stock, self.client, self.port, self.pid = name, stock, client, port, pid

    def our_polls(self, seconds: float) -> float:
        """Polls a second of our own remote channel."""
        channel = Channel(NmlConfig.load(self.client), "emcStatus", "xemc")
        count, start = 0, time.perf_counter()
        while (elapsed := time.perf_counter() - start) < seconds:
            channel.raw.peek()
            count += 1
        channel.close()
        return count / elapsed

    def cpu_of_many(self, seconds: float) -> float:
        """Percent of a core that the server takes for many clients that poll as displays do."""
        clients = [socket.create_connection(("127.0.0.1", self.port)) for _ in range(CLIENTS)]
        last = [0] * CLIENTS
        before, start = cpu_ticks(self.pid), time.perf_counter()
        turn = 0
        while (now := time.perf_counter() - start) < seconds:
            number = turn % CLIENTS
            sock, serial = clients[number], turn // CLIENTS
            sock.sendall(wire.REQUEST.pack(serial, wire.Request.READ, 2, wire.Access.PEEK, last[number]))
            reply = sock.recv(20, socket.MSG_WAITALL)
            _, _, size, last[number], _ = wire.READ_REPLY.unpack(reply)
            sock.recv(size, socket.MSG_WAITALL) if size else b""
            turn += 1
            time.sleep(max(0.0, turn / (CLIENTS * RATE) - now))
        used = (cpu_ticks(self.pid) - before) / TICKS
        for sock in clients:
            sock.close()
        return 100.0 * used / (time.perf_counter() - start)


def cpu_ticks(pid: int) -> int:
    """Processor time of a process so far."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return int(fields[11]) + int(fields[12])


def measure(peers: list[Peer], seconds: float) -> list[dict[str, Any]]:
    """All rows, the servers in turn."""

    def stock(script: str) -> Callable[[Peer], float]:
        return lambda peer: peer.stock.run(script.format(seconds=seconds))[0]

    plan: list[tuple[Row, Callable[[Peer], float]]] = []
    if MODULE_FOUND:
        plan.append((Row("stock client: stat.poll(), a new status each ms", "1/s", "12,500"), stock(STOCK_POLLS)))
        row = Row("stock client: command and wait_complete()", "ms", "", more=False)
        plan.append((row, stock(STOCK_COMMANDS)))
    row = Row("our client: polls", "1/s", "")
    plan.append((row, lambda peer: peer.our_polls(seconds)))
    row = Row(f"{CLIENTS} clients at {RATE:g} Hz: processor time of the server", "% core", "< 10", more=False)
    plan.append((row, lambda peer: peer.cpu_of_many(2 * seconds)))
    for _ in range(RUNS):
        for row, work in plan:
            for peer in peers:
                row.runs[peer.name].append(work(peer))
    return [vars(row) for row, _ in plan]


def process_named(name: str) -> int:
    """Process id of the stock server; nobody else's processes are in sight."""
    for path in Path("/proc").glob("[0-9]*/comm"):
        if path.read_text().strip() == name:
            return int(path.parent.name)
    raise LookupError(name)


def beside_stock(seconds: float) -> list[dict[str, Any]]:
    """The measurement in the namespaces of a stock machine, in the folder of its session."""
    here = Path.cwd()
    home = StockClient(here, here / "server.nml")
    subprocess.run([sys.executable, "-c", _SWITCH_ON], check=True, cwd=here)
    theirs = Peer("LinuxCNC", home, here / "client.nml", stock_machine.PORT, process_named("linuxcncsvr"))
    return ours_and(theirs, seconds)


_SWITCH_ON = f"""
import sys; sys.path.insert(0, {str(stock_machine.SOURCE)!r})
import linuxcnc
linuxcnc.nmlfile = "client.nml"
c = linuxcnc.command()
for state in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON): c.state(state); c.wait_complete()
"""


def ours_and(other: Peer | None, seconds: float) -> list[dict[str, Any]]:
    """The measurement of our server, and of another one."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        port = free_port()
        with running(folder, nml_text(f"TCP={port}")) as server:
            os.environ["NML_FILE"] = str(server.file)
            with FakeTask(cycle=0.001):
                assert server.process is not None
                server.remote()
                home = StockClient(folder, server.file)
                ours = Peer("ours", home, folder / "client.nml", port, server.process.pid)
                return measure([ours, other] if other else [ours], seconds)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=1.0, help="length of a run")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    if stock_machine.reason_to_skip() is None:
        call = f"from benchmarks import net_bench\nout.append(net_bench.beside_stock({arguments.seconds!r}))"
        (results,) = stock_machine.session(call, seconds=600.0)
    else:
        results = ours_and(None, arguments.seconds)
    if arguments.json:
        print(json.dumps(results))
        return 0
    print(f"{'median (worst)':52} {'ours':>24} {'LinuxCNC':>24} unit     goal")
    for result in results:
        row = Row(result["label"], result["unit"], result["goal"], result["more"])
        row.runs = result["runs"]
        print(row.text())
    return 0


if __name__ == "__main__":
    sys.exit(main())
