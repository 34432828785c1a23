"""``latency-test`` and ``latency-histogram``: how punctual realtime threads are on this machine.

Both run a session of their own with a servo and, if asked for, a base thread; the numbers come from ``timedelta``.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import re
import sys
from collections.abc import Callable
from pathlib import Path

from hal.capture import Capture
from hal.scope import new_figure
from hal.session import Session
from nml import clock
from nml.errors import HalError, PyemcError

UNITS = {"ns": 1, "us": 1000, "µs": 1000, "ms": 1_000_000, "s": 1_000_000_000}
BAR = 60


def period(text: str) -> int:
    """``25us``, ``1ms`` or plain ns as ns; 0 or ``-`` is no thread."""
    match = re.fullmatch(r"([0-9.]+)\s*([a-zµ]*)", text)
    if text == "-":
        return 0
    if match is None or match[2] not in ("", *UNITS):
        raise argparse.ArgumentTypeError(f"'{text}': a period such as 25us or 1ms would be right")
    return int(float(match[1]) * UNITS.get(match[2], 1))


def begin(session: Session, base_ns: int, servo_ns: int) -> list[str]:
    """Load and start the threads; their names, the slowest first."""
    threads = [(name, ns) for name, ns in (("base", base_ns), ("servo", servo_ns)) if ns > 0]
    words = [f"name{n}={name} period{n}={ns}" for n, (name, ns) in enumerate(threads, 1)]
    session.host.loadrt("threads", " ".join(words).split())
    names = [name for name, _ in threads]
    session.host.loadrt("timedelta", [f"names={','.join('latency-' + name for name in names)}"])
    for name in names:
        session.host.addf(f"latency-{name}", name)
    session.hal.start_threads()
    return names[::-1]


def show(session: Session, names: list[str]) -> str:
    """A line for each thread."""
    lines = [f"{'thread':8}{'period':>12}{'shortest':>12}{'longest':>12}{'max jitter':>12}{'overruns':>10}   (ns)"]
    for name in names:
        thread = session.hal.segment.find_thread(name)
        assert thread is not None
        low, high, jitter = (session.hal.value(f"latency-{name}.{pin}") for pin in ("min", "max", "jitter"))
        lines.append(f"{name:8}{thread.period_ns:12}{low:12}{high:12}{jitter:12}{thread.overruns:10}")
    return "\n".join(lines)


def main(argv: list[str] | None = None) -> int:
    """latency-test [BASE-PERIOD [SERVO-PERIOD]]"""
    parser = argparse.ArgumentParser(prog="latency-test", description="Show how punctual realtime threads are.")
    parser.add_argument("base", nargs="?", type=period, default=0, help="25us, or - for none")
    parser.add_argument("servo", nargs="?", type=period, default=1_000_000, help="1ms by default")
    parser.add_argument("--seconds", type=float, help="end after so long; else Ctrl-C")
    options = parser.parse_args(argv)
    return _session(lambda session: _watch(session, options), "latency-test")


def _watch(session: Session, options: argparse.Namespace) -> None:
    names = begin(session, options.base, options.servo)
    end = clock.host_now() + options.seconds if options.seconds else None
    live = sys.stdout.isatty()
    while end is None or clock.host_now() < end:
        clock.host_sleep(min(1.0, max(end - clock.host_now(), 0.0)) if end else 1.0)
        text = show(session, names)
        if live:
            print(f"\033[H\033[2J{text}", flush=True)
        elif end is None or clock.host_now() >= end:
            print(text, flush=True)


def histogram_text(errors: list[int], bin_ns: int) -> list[str]:
    """Counts by how late a period began, one line for each bin that has any."""
    counts: dict[int, int] = {}
    for error in errors:
        counts[error // bin_ns] = counts.get(error // bin_ns, 0) + 1
    most = max(counts.values())
    return [
        f"{number * bin_ns / 1000:10.1f} us {count:9}  {'#' * max(1, count * BAR // most)}"
        for number, count in sorted(counts.items())
    ]


def histogram_main(argv: list[str] | None = None) -> int:
    """latency-histogram [--seconds S] [--png FILE]"""
    parser = argparse.ArgumentParser(prog="latency-histogram", description="Distribution of a thread's period.")
    parser.add_argument("--period", type=period, default=1_000_000, help="of the thread; 1ms by default")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--bin", type=period, default=5_000, help="width of a bin; 5us by default")
    parser.add_argument("--png", type=Path, metavar="FILE")
    options = parser.parse_args(argv)
    return _session(lambda session: _histogram(session, options), "latency-histogram")


def _histogram(session: Session, options: argparse.Namespace) -> None:
    begin(session, 0, options.period)
    with Capture(session, ["latency-servo.current-error"], "servo") as capture:
        rows = capture.read(max(2, int(options.seconds * 1e9 / options.period)))
    errors = sorted(int(row[0]) for row in rows[1:])
    print("\n".join(histogram_text(errors, options.bin)))
    middle, high = errors[len(errors) // 2], errors[int(len(errors) * 0.999)]
    print(f"{len(errors)} periods: median {middle} ns, 99.9 % below {high} ns, from {errors[0]} to {errors[-1]} ns")
    if options.png:
        figure = new_figure(8, 5)
        axis = figure.subplots()
        axis.hist([error / 1000 for error in errors], bins=100, log=True)
        axis.set_xlabel("lateness in us")
        axis.set_ylabel("periods")
        figure.savefig(options.png)


def _session(work: Callable[[Session], None], program: str) -> int:
    """Run something in a session of its own, which is always taken down; nobody else's is touched."""
    os.environ.setdefault("PYEMC_NAMESPACE", f"latency{os.getpid()}")
    try:
        with Session() as session:
            if session.hal.host_state()[1]:
                raise HalError("a realtime session is running; end it first (halrun -U)")
            try:
                with contextlib.suppress(KeyboardInterrupt):
                    work(session)
            finally:
                session.teardown()
    except PyemcError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
