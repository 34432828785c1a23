"""``halscope --capture``: pins recorded at thread rate, with a trigger, to CSV and PNG.

    halscope --capture joint.0.vel-cmd joint.0.f-error --thread servo-thread --trigger 'joint.0.vel-cmd>0' --png out.png
"""

from __future__ import annotations

import argparse
import csv
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

from hal.capture import Capture, Row, Trigger
from hal.session import Session
from nml.errors import HalError, PyemcError


def write_csv(path: Path | None, names: list[str], period_s: float, rows: list[Row], zero: int) -> None:
    """A column of time in s, 0 at the trigger, then one for each pin; standard output where there is no path."""
    file = open(path, "w", newline="", encoding="utf-8") if path else sys.stdout  # noqa: SIM115
    try:
        writer = csv.writer(file)
        writer.writerow(["time", *names])
        for n, row in enumerate(rows):
            writer.writerow([f"{(n - zero) * period_s:.9g}", *(f"{float(value):.9g}" for value in row)])
    finally:
        if path:
            file.close()


def new_figure(width: float, height: float) -> Any:
    """An empty matplotlib figure, in inches; HalError where there is no matplotlib."""
    try:
        figure = import_module("matplotlib.figure")
    except ImportError:
        raise HalError("a PNG needs matplotlib: pip install 'pyemc[plot]'") from None
    return figure.Figure(figsize=(width, height), layout="constrained")


def write_png(path: Path, names: list[str], period_s: float, rows: list[Row], zero: int) -> None:
    """One axis for each pin, one above the other."""
    times = [(n - zero) * period_s for n in range(len(rows))]
    figure = new_figure(10, 1.5 + 1.6 * len(names))
    axes = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    for column, (name, axis) in enumerate(zip(names, axes, strict=True)):
        axis.step(times, [float(row[column]) for row in rows], where="post", linewidth=1)
        axis.set_title(name, fontsize=9, loc="left")
        axis.grid(alpha=0.3)
    axes[-1].set_xlabel("time in s")
    figure.savefig(path)


def _arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="halscope", description="Record pins at thread rate.")
    parser.add_argument("--capture", nargs="+", metavar="PIN", required=True, help="pins or parameters to record")
    parser.add_argument("--thread", default="servo-thread", help="thread whose periods are recorded")
    parser.add_argument("--samples", type=int, default=1000, metavar="N", help="periods to record")
    parser.add_argument("--trigger", metavar="PIN>LEVEL", help="wait until the pin passes a level")
    parser.add_argument("--before", type=int, metavar="N", help="periods before the trigger; a tenth of all by default")
    parser.add_argument("--csv", type=Path, metavar="FILE", help="standard output by default")
    parser.add_argument("--png", type=Path, metavar="FILE")
    return parser


def main(argv: list[str] | None = None) -> int:
    """The command."""
    options = _arguments().parse_args(argv)
    names = list(options.capture)
    zero = 0
    try:
        for path in filter(None, (options.csv, options.png)):
            if not path.parent.is_dir():
                raise HalError(f"there is no folder {path.parent} for {path.name}")
        trigger = Trigger.parse(options.trigger) if options.trigger else None
        with Session() as session:
            thread = session.hal.segment.find_thread(options.thread)
            if thread is None:
                threads = ", ".join(record.name for record in session.hal.segment.threads())
                raise HalError(f"thread '{options.thread}' not found; there is {threads or 'none'}")
            period_s = thread.period_ns * 1e-9
            if trigger and trigger.pin not in names:
                names.append(trigger.pin)
            if not session.hal.segment.threads_running:
                print("halscope: waiting, for the threads are stopped; 'halcmd start' lets them run", file=sys.stderr)
            with Capture(session, names, options.thread) as capture:
                if trigger:
                    zero = options.samples // 10 if options.before is None else options.before
                    rows = capture.read_triggered(options.samples, trigger, zero)
                else:
                    rows = capture.read(options.samples)
        if options.csv or not options.png:
            write_csv(options.csv, names, period_s, rows, zero)
        if options.png:
            write_png(options.png, names, period_s, rows, zero)
    except (PyemcError, OSError) as error:
        print(f"halscope: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
