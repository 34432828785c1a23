"""``halreport``: what is connected to what, as text or as a graph in Graphviz's language.

    halreport             signals with writer and readers, unconnected inputs, threads
    halreport --dot       the net list as a graph:  halreport --dot | dot -Tsvg > net.svg
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

from hal._records import Item, Signal
from hal._shm import IN, OUT, PIN
from hal.core import Hal
from hal.values import TYPE_NAMES, show_value
from nml.errors import PyemcError


def report(hal: Hal) -> Iterator[str]:
    """The session as text."""
    yield "SIGNALS"
    for signal in hal.segment.signals():
        yield f"  {signal.name} ({TYPE_NAMES[signal.type]}) = {show_value(signal.type, signal.get())}"
        for pin in sorted(signal.pins(), key=lambda pin: pin.dir == IN):
            yield f"      {'to  ' if pin.dir == IN else 'from' if pin.dir == OUT else 'both'} {pin.shown}"
        if not any(pin.dir != IN for pin in signal.pins()):
            yield "      (nothing drives it)"
    yield "INPUTS THAT ARE NOT CONNECTED"
    for pin in hal.segment.items(PIN):
        if pin.dir == IN and pin.signal is None:
            yield f"  {pin.shown} = {show_value(pin.type, pin.get())}"
    yield "THREADS"
    for thread in hal.segment.threads():
        yield f"  {thread.name}, {thread.period_ns} ns: {' '.join(funct.name for funct in thread.functs())}"


def owner_of(pin: Item) -> str:
    """The instance that a pin belongs to: its name without the last part."""
    return pin.name.rpartition(".")[0] or pin.name


def edges(signal: Signal) -> Iterator[tuple[str, str]]:
    """(from, to) instances of a signal; from the signal itself where nothing drives it."""
    pins = signal.pins()
    sources = [owner_of(pin) for pin in pins if pin.dir != IN] or [f"signal {signal.name}"]
    for source in sources:
        for pin in pins:
            if pin.dir != OUT and owner_of(pin) != source:
                yield source, owner_of(pin)


def dot(hal: Hal) -> Iterator[str]:
    """Instances as boxes, signals as arrows."""
    yield "digraph hal {"
    yield "  rankdir=LR; node [shape=box, fontsize=10]; edge [fontsize=8];"
    for signal in hal.segment.signals():
        for source, target in edges(signal):
            yield f'  "{source}" -> "{target}" [label="{signal.name}"];'
    yield "}"


def main(argv: list[str] | None = None) -> int:
    """halreport [--dot] [FILE]"""
    parser = argparse.ArgumentParser(prog="halreport", description="Report what is connected to what.")
    parser.add_argument("--dot", action="store_true", help="as a graph for Graphviz")
    parser.add_argument("file", nargs="?", type=Path)
    options = parser.parse_args(argv)
    try:
        hal = Hal()
        text = "\n".join((dot if options.dot else report)(hal)) + "\n"
        hal.close()
        if options.file:
            options.file.write_text(text, encoding="utf-8")
        else:
            sys.stdout.write(text)
    except (PyemcError, OSError) as error:
        print(f"halreport: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
