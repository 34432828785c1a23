"""``linuxcnc-top``: a running machine on one terminal screen, renewed as it changes; it looks and orders nothing.

``--once`` prints one frame and ends. Exit codes: 0, looked; 3, no machine. Lengths in machine units, angles in degrees.
"""

from __future__ import annotations

import argparse
import cmath
import math
import os
import sys
from collections import deque
from collections.abc import Iterable

from rich.console import Console as Terminal
from rich.console import Group
from rich.live import Live
from rich.table import Table
from rich.text import Text

import linuxcnc
from linuxcnc.ctl import INTERPRETER, KINDS, MODES, NO_MACHINE, STATES, Console
from linuxcnc.program import AXES
from nml import namespace

RENEWALS = 10  # frames per host second
KEPT_MESSAGES = 5
KEPT_ORDERS = 5
COLOURS = {"on": "green", "off": "yellow", "estop-reset": "yellow", "estop": "red"}


def main(arguments: list[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="linuxcnc-top", description="Watch a running machine.")
    parser.add_argument("--once", action="store_true", help="print one frame and end")
    parser.add_argument("--namespace", metavar="NAME", help="which machine, where several run")
    options = parser.parse_args(arguments)
    if options.namespace:
        os.environ[namespace.VARIABLE] = options.namespace
    try:
        _watch(Console(), options.once)
    except (linuxcnc.error, ValueError) as reason:
        print(f"linuxcnc-top: {reason}", file=sys.stderr)
        return NO_MACHINE
    except KeyboardInterrupt:
        return 0
    return 0


def _watch(console: Console, once: bool) -> None:
    messages: deque[tuple[int, str]] = deque(maxlen=KEPT_MESSAGES)
    orders: deque[linuxcnc.order] = deque(maxlen=KEPT_ORDERS)
    notes = linuxcnc.order_channel()
    console.status.poll()
    if once:
        Terminal().print(frame(console, messages, orders))
        return
    with Live(frame(console, messages, orders), screen=True, refresh_per_second=RENEWALS) as live:
        while True:
            console.status.wait(1.0 / RENEWALS)
            console.status.poll()
            while (message := console.errors.poll()) is not None:
                messages.append(message)
            while (order := notes.poll()) is not None:
                orders.append(order)
            live.update(frame(console, messages, orders))


def frame(console: Console, messages: Iterable[tuple[int, str]], orders: Iterable[linuxcnc.order]) -> Group:
    """One screen."""
    parts = (_state(console.status), _axes(console), _process(console.status))
    return Group(*parts, *(Text(f"{order.origin}: {order.text}", "dim") for order in orders), *_messages(messages))


def _state(status: linuxcnc.stat) -> Text:
    state = STATES.get(status.task_state, "unknown")
    mode, program = MODES.get(status.task_mode, "unknown"), INTERPRETER.get(status.interp_state, "unknown")
    line = Text.assemble((f" {state} ", f"reverse {COLOURS.get(state, '')}"), f"  {mode}, {program}")
    if status.paused:
        line.append("  paused", "yellow")
    where = f", line {status.motion_line}" if status.motion_line else ""
    return line.append(f"  {status.file or 'no program'}{where}")


def _axes(console: Console) -> Table:
    """The axes: in the coordinate system in force, in the machine, and what is left of the move."""
    status = console.status
    machine, work, left = status.actual_position, _work_position(status), status.dtg
    table = Table("axis", "work", "machine", "to go", box=None)
    for letter in console.axes():
        at = AXES.index(letter)
        table.add_row(letter, *(f"{place[at]:12.4f}" for place in (work, machine, left)))
    return table


def _work_position(status: linuxcnc.stat) -> list[float]:
    """The tool's place in the coordinate system in force, as the program has it."""
    offsets = zip(status.actual_position, status.g5x_offset, status.tool_offset, strict=True)
    place = [at - system - tool for at, system, tool in offsets]
    turned = complex(place[0], place[1]) * cmath.rect(1.0, -math.radians(status.rotation_xy))
    place[:2] = turned.real, turned.imag
    return [at - shift for at, shift in zip(place, status.g92_offset, strict=True)]


def _process(status: linuxcnc.stat) -> Table:
    """Speeds, overrides, spindles, tool and coolant."""
    table = Table(show_header=False, box=None)
    homed = sum(1 for one in status.homed[: status.joints] if one)
    table.add_row("homed", f"{homed} of {status.joints} joints")
    table.add_row("speed", f"{status.current_vel * 60.0:.1f} /min")
    table.add_row("overrides", f"feed {status.feedrate:.0%}, rapids {status.rapidrate:.0%}")
    for number, spindle in enumerate(status.spindle[: status.spindles]):
        table.add_row(f"spindle {number}", f"{spindle['speed']:.0f} rpm at {spindle['override']:.0%}")
    table.add_row("tool", f"T{status.tool_in_spindle}" if status.tool_in_spindle > 0 else "none")
    coolant = [name for name, on in (("mist", status.mist), ("flood", status.flood)) if on]
    table.add_row("coolant", ", ".join(coolant) or "off")
    return table


def _messages(messages: Iterable[tuple[int, str]]) -> list[Text]:
    kinds = [(KINDS.get(kind, "error"), text) for kind, text in messages]
    return [Text(f"{kind}: {text}", "red" if kind == "error" else "") for kind, text in kinds]


if __name__ == "__main__":
    sys.exit(main())
