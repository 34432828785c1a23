"""The table of DESIGN's figures: ours beside LinuxCNC's (where Debian's package is installed), measured in one run.

    python benchmarks/figures.py [--only ours|linuxcnc] [--json FILE]

Both controllers run the same configuration folder and the same driver through their own ``import linuxcnc``. LinuxCNC's
controller runs as an ordinary user (it refuses root): ``--user NAME`` names one when this is started by root.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import machine

ROOT = Path(__file__).resolve().parent.parent
STOCK = {"rs274": "/usr/bin/rs274", "linuxcnc": "/usr/bin/linuxcnc"}
CAM_LINES = 200_000


@dataclass(frozen=True)
class Figure:
    """One row: how a result is read from a controller's raw results, its unit and whether more is better."""

    label: str
    unit: str
    value: Callable[[dict], float | None]
    more_is_better: bool = False
    goal: str = ""


def of(key: str, scale: float = 1.0) -> Callable[[dict], float | None]:
    """Read a number, or the median of a list, and scale it."""

    def read(results: dict) -> float | None:
        value = results.get(key)
        if value is None or value == []:
            return None
        return scale * (statistics.median(value) if isinstance(value, list) else value)

    return read


def block_rate(results: dict) -> float | None:
    seconds = results.get("short_circle.ngc")
    return 30_000 / seconds if seconds else None


FIGURES = (
    Figure("rs274 -g, 200,000 lines, whole process", "s", of("rs274"), goal="as fast"),
    Figure("blocks/s, program to motion (0.02 mm segments)", "1/s", block_rate, True, "4,050 (planner bound)"),
    Figure("30,000 segments of 0.02 mm, r 100, 100 mm/s", "s", of("short_circle.ngc"), goal="7.8"),
    Figure("stat.poll(), nothing new", "1/s", of("polls"), True, "2,000,000"),
    Figure("MDI round trip, median", "ms", of("mdi", 1e3), goal="3"),
    Figure("servo cycle, 3 joints, motion-controller", "us", of("servo_us"), goal="15"),
    Figure("20,000 short segments on a curve", "s", of("wavy_curve.ngc"), goal="27"),
    Figure("100 zigzags of 20 mm", "s", of("zigzag.ngc"), goal="46.4"),
    Figure("stat.poll() of a stock client over NML/TCP", "1/s", of("remote_polls"), True, "12,500"),
    Figure("forecast: times real time, whole process", "x", of("forecast"), True, "100"),
    Figure("from `linuxcnc INI` to ready", "s", of("ready"), goal="2"),
)


def time_rs274(command: list[str], folder: Path, environment: dict[str, str]) -> float:
    """Best of three runs of ``rs274 -g`` on a CAM program, s."""
    program = folder / "cam.ngc"
    if not program.exists():
        program.write_text(machine.cam_program(CAM_LINES))
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        whole = os.environ | environment
        subprocess.run([*command, "-g", str(program)], stdout=subprocess.DEVNULL, check=True, cwd=folder, env=whole)
        best = min(best, time.perf_counter() - start)
    return best


def run_machine(command: list[str], environment: dict[str, str]) -> dict:
    """Start a controller on a fresh configuration folder with the driver as its display; the driver's results."""
    with tempfile.TemporaryDirectory(prefix="pyemc-bench-") as name:
        folder = Path(name)
        driver = folder / "driver.py"
        shutil.copy(Path(__file__).with_name("driver.py"), driver)
        ini = machine.write(folder, str(driver))
        for path in (folder, *folder.iterdir()):
            path.chmod(0o777)
        start = time.time()
        done = subprocess.run(
            [word.replace("INI", str(ini)) for word in command],
            cwd=folder, env=os.environ | environment, capture_output=True, text=True, timeout=900, check=False,
        )
        result = folder / "results.json"
        if not result.exists():
            sys.stderr.write(done.stdout[-2000:] + done.stderr[-2000:])
            return {}
        results = json.loads(result.read_text())
    results["ready"] = results["ready_at"] - start
    results["servo_us"] = [t / 1000.0 for t in results.get("servo_ticks", [])]
    return results


def forecast_speed(folder: Path, environment: dict[str, str]) -> float:
    """Seconds of machining that a second of forecasting covers, whole process, on the curve of short segments."""
    ini = machine.write(folder, "none")
    start = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-m", "emcmot.forecast", str(ini), str(folder / "wavy_curve.ngc")],
        capture_output=True, text=True, check=True, env=os.environ | environment,
    )  # fmt: skip
    seconds = time.perf_counter() - start
    match = re.search(r"\(([\d.]+) s", done.stdout)
    assert match, done.stdout
    return float(match[1]) / seconds


def remote_polls() -> tuple[dict, dict]:
    """Polls per second of the stock client module over TCP, from either server (see net_bench)."""
    done = subprocess.run(
        [sys.executable, str(Path(__file__).with_name("net_bench.py")), "--json"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode:
        return {}, {}
    rows = json.loads(done.stdout.splitlines()[-1])
    runs = next(row["runs"] for row in rows if row["label"].startswith("stock client: stat.poll()"))
    return {"remote_polls": runs.get("ours")}, {"remote_polls": runs.get("LinuxCNC")}


def measure_ours() -> dict:
    python = sys.executable
    bin_folder = str(Path(python).parent)
    environment = {
        "PATH": f"{bin_folder}:{os.environ['PATH']}",
        "PYEMC_NAMESPACE": f"bench{os.getpid()}",
        "PYTHONPATH": str(ROOT),
    }
    results = run_machine([python, "-m", "linuxcnc_start", "INI"], environment)
    with tempfile.TemporaryDirectory() as folder:
        results["rs274"] = time_rs274([python, "-m", "rs274ngc"], Path(folder), environment)
        results["forecast"] = forecast_speed(Path(folder), environment)
    return results


def measure_stock(user: str | None) -> dict:
    command = ["linuxcnc", "-r", "INI"]
    environment = {"PATH": "/usr/bin:/bin:/usr/sbin:/sbin"}
    if os.getuid() == 0:
        if not user:
            sys.stderr.write("LinuxCNC refuses to run as root; name an ordinary user with --user\n")
            return {}
        command = ["runuser", "-u", user, "--", *command]
        environment["HOME"] = os.path.expanduser(f"~{user}")
    results = run_machine(command, environment)
    with tempfile.TemporaryDirectory() as folder:
        results["rs274"] = time_rs274([STOCK["rs274"]], Path(folder), environment | {"HOME": folder})
    return results


def show(ours: dict, stock: dict) -> None:
    """Print the table; ratio above 1 means ours is better."""
    print(f"{'figure':52} {'ours':>12} {'LinuxCNC':>12} {'ratio':>7}  goal")
    for figure in FIGURES:
        mine, theirs = figure.value(ours), figure.value(stock)
        ratio = ""
        if mine and theirs:
            ratio = f"{(mine / theirs if figure.more_is_better else theirs / mine):.2f}"
        cells = [f"{v:,.3g} {figure.unit}" if v is not None and v < 1000 else f"{v:,.0f} {figure.unit}" if v else "-"
                 for v in (mine, theirs)]
        print(f"{figure.label:52} {cells[0]:>12} {cells[1]:>12} {ratio:>7}  {figure.goal}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=("ours", "linuxcnc"))
    parser.add_argument("--user", help="ordinary user that runs LinuxCNC when this is started by root")
    parser.add_argument("--json", type=Path, help="write the raw results there")
    options = parser.parse_args()
    ours = measure_ours() if options.only != "linuxcnc" else {}
    installed = all(Path(path).exists() for path in STOCK.values())
    if not installed:
        print("LinuxCNC is not installed here: its column stays empty")
    stock = measure_stock(options.user) if installed and options.only != "ours" else {}
    if installed and not options.only:
        mine, theirs = remote_polls()
        ours |= mine
        stock |= theirs
    show(ours, stock)
    if options.json:
        options.json.write_text(json.dumps({"ours": ours, "linuxcnc": stock}, indent=1))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
