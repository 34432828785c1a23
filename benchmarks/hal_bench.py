"""What the HAL costs, beside LinuxCNC's where Debian's package is installed: thread cycles, pins from Python.

    python benchmarks/hal_bench.py [--seconds S] [--histograms]

A thread's time is the median of its ``.time`` pin: for us ns, for LinuxCNC processor clocks, divided by the clock's
rate. Then, of a 1 kHz thread, idle and with every processor busy, how far its periods are from 1 ms; ``--histograms``
shows them whole. LinuxCNC asks for realtime priority on a realtime kernel alone, so ours is measured with and without.
Start it as root to shield LinuxCNC's session from others (it gets namespaces of its own and an ordinary user).
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import shutil
import statistics
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
os.environ.setdefault("PYEMC_NAMESPACE", f"halbench{os.getpid()}")

from hal.latency import histogram_text
from hal.realtime import REALTIME_VARIABLE

CHECKOUT = Path(__file__).resolve().parents[1]
LINUXCNC = shutil.which("halrun", path="/usr/bin") and os.geteuid() == 0
SAMPLES = 400
WITHIN = (10_000, 20_000, 50_000, 100_000, 500_000)  # ns from a period of 1 ms

CASES = {
    "empty thread cycle": "",
    "one sum2": "loadrt sum2 count=1\naddf sum2.0 t\n",
    "100 chained sum2": "loadrt sum2 count=100\n"
    + "".join(f"net s{n} sum2.{n}.out sum2.{n + 1}.in0\n" for n in range(99))
    + "".join(f"addf sum2.{n} t\n" for n in range(100)),
}
PEER_PYTHON = "/usr/bin/python3"
PYTHON = """
import hal, timeit
c = hal.component("bench")
p = c.newpin("in", hal.HAL_FLOAT, hal.HAL_IN)
c.ready()
for code in ('c["in"]', 'c["in"] = 1.0', "p.get()", "p.set(1.0)"):
    print(min(timeit.repeat(code, globals=globals(), number=200000, repeat=5)) / 0.2)
c.exit()
"""


def hal_file(body: str) -> str:
    return (
        "loadrt threads name1=t period1=1000000\n" + body
        + "loadrt sampler cfg=s depth=4000\nnet time t.time sampler.0.pin.0\naddf sampler.0 t\nstart\n"
        + f"loadusr -w halsampler -n {SAMPLES}\n"
    )  # fmt: skip


def run(folder: Path, text: str, ours: bool, **variables: str) -> str:
    """The output of a HAL file under our halrun or LinuxCNC's."""
    path = folder / "bench.hal"
    path.write_text(text)
    if ours:
        command = [sys.executable, "-m", "hal.halrun", "-f", str(path)]
        environment = {**os.environ, "PYTHONPATH": str(CHECKOUT), **variables}
    else:
        command = [*_shield(), f"cd {folder} && /usr/bin/halrun -f {path}"]
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(folder)}
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=True).stdout


def _shield() -> list[str]:
    unshare = ["unshare", "-i", "-p", "-n", "-f", "--mount-proc"]
    return [*unshare, "setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "sh", "-c"]


def clocks_per_us() -> float:
    """Rate of the processor's time stamp counter."""
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("cpu MHz"):
            return float(line.split(":")[1])
    return 1000.0


def thread_time(folder: Path, body: str, ours: bool) -> float:
    """Median time of a period in us; the sampler's own share is in it for both."""
    values = [int(line) for line in run(folder, hal_file(body), ours).split() if line.lstrip("-").isdigit()]
    return statistics.median(values[20:]) / (1000.0 if ours else clocks_per_us())


def _loads_ours(python: str) -> bool:
    """Whether another interpreter takes modules compiled for this one."""
    code = "import sys; print(sys.implementation.cache_tag)"
    try:
        done = subprocess.run([python, "-c", code], capture_output=True, text=True, check=False)
    except OSError:
        return False
    return done.stdout.strip() == sys.implementation.cache_tag


def python_times(folder: Path, ours: bool) -> list[float]:
    """us for an item's get and set, and a pin's; on the same interpreter where Debian's can load our modules."""
    path = folder / "bench.py"
    path.write_text(PYTHON)
    if ours:
        python = PEER_PYTHON if _loads_ours(PEER_PYTHON) else sys.executable
        places = os.pathsep.join((str(CHECKOUT), sysconfig.get_path("purelib")))
        command, environment = [python, str(path)], {**os.environ, "PYTHONPATH": places}
    else:
        command = [*_shield(), f"{PEER_PYTHON} {path}"]
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(folder)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=True)
    return [float(line) for line in done.stdout.split()]


def row(name: str, ours: float, theirs: float | None) -> None:
    other = "" if theirs is None else f"{theirs:10.3f}{ours / theirs:8.2f}"
    print(f"{name:34}{ours:10.3f}{other}", flush=True)


def _burn(_: int) -> None:
    while True:
        sum(range(10000))


def errors_of_periods(folder: Path, seconds: float, ours: bool, **variables: str) -> list[int]:
    """How far each period of a 1 kHz thread was from 1 ms, in ns, sorted."""
    text = (
        "loadrt threads name1=t period1=1000000\nloadrt timedelta\nloadrt sampler cfg=s depth=4000\n"
        "net late timedelta.0.current-error sampler.0.pin.0\naddf timedelta.0 t\naddf sampler.0 t\nstart\n"
        f"loadusr -w halsampler -n {int(seconds * 1000)}\n"
    )
    lines = run(folder, text, ours, **variables).split()
    return sorted([int(line) for line in lines if line.lstrip("-").isdigit()][5:])


def periods(folder: Path, seconds: float, busy: bool, histograms: bool) -> None:
    """A row for each kind of 1 kHz thread."""
    burners = [multiprocessing.Process(target=_burn, args=(n,), daemon=True) for n in range(os.cpu_count() or 1)]
    for burner in burners if busy else []:
        burner.start()
    print(f"\n{'1 kHz, ' + ('every processor busy' if busy else 'idle') + ', % within us':34}", end="")
    print("".join(f"{limit // 1000:8}" for limit in WITHIN) + f"{'99.9 %':>10}{'worst us':>10}")
    kinds: list[tuple[str, bool, dict[str, str]]] = [
        ("ours", True, {}), ("ours, no realtime priority", True, {REALTIME_VARIABLE: "0"}),
        ("LinuxCNC, no realtime priority", False, {}),
    ]  # fmt: skip
    for name, ours, variables in kinds:
        if not (ours or LINUXCNC):
            continue
        errors = errors_of_periods(folder, seconds, ours, **variables)
        sizes = sorted(abs(error) for error in errors)
        shares = [100.0 * sum(size <= limit for size in sizes) / len(sizes) for limit in WITHIN]
        high, worst = sizes[int(len(sizes) * 0.999)] / 1000, sizes[-1] / 1000
        print(f"{name:34}" + "".join(f"{share:8.2f}" for share in shares) + f"{high:10.0f}{worst:10.0f}", flush=True)
        if histograms:
            print("\n".join(histogram_text(errors, 20_000)))
    for burner in burners if busy else []:
        burner.kill()


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seconds", type=float, default=5.0, help="of each 1 kHz thread")
    parser.add_argument("--histograms", action="store_true", help="of the 1 kHz threads")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o777)
        print(f"{'us':34}{'ours':>10}{'LinuxCNC':>10}{'ratio':>8}")
        for case, body in CASES.items():
            row(case, thread_time(folder, body, True), thread_time(folder, body, False) if LINUXCNC else None)
        theirs = python_times(folder, False) if LINUXCNC else [None] * 4
        names = ("c['in']", "c['in'] = 1.0", "pin.get()", "pin.set(1.0)")
        for case, mine, other in zip(names, python_times(folder, True), theirs, strict=True):
            row(case, mine, other)
        for busy in (False, True):
            periods(folder, options.seconds, busy, options.histograms)


if __name__ == "__main__":
    main()
