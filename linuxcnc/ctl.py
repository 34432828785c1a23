"""``linuxcnc-ctl``: one order or question to a running machine from a terminal or a script.

Exit codes: 0, done; 1, refused or failed, said in one line on stderr; 2, the command line is wrong; 3, there is no
machine. Lengths are in machine units, jog speeds in machine units per minute, as on a machine's screen.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import linuxcnc
from linuxcnc.completion import SHELLS
from linuxcnc.program import AXES, Operator, ProgramError, run_loaded
from nml import clock, namespace

LOOK = 0.2  # host seconds between looks with --watch and --follow
PATIENCE = 600.0  # host seconds that an order may take
REFUSED, NO_MACHINE = 1, 3
STATES = {1: "estop", 2: "estop-reset", 3: "off", 4: "on"}
MODES = {1: "manual", 2: "auto", 3: "mdi"}
INTERPRETER = {1: "idle", 2: "running", 3: "paused", 4: "waiting"}
KINDS = {1: "error", 2: "text", 3: "display", 11: "error", 12: "text", 13: "display"}


class Refused(Exception):
    """The machine did not do it; the text is its reason."""


class Console:
    """A connection to the machine, and the waiting that every order needs."""

    def __init__(self) -> None:
        self.status = linuxcnc.stat()
        self.command = linuxcnc.command()
        self.errors = linuxcnc.error_channel()
        if self.status.ini_filename == "":
            raise linuxcnc.error(f"no machine runs in namespace {namespace.namespace()!r}")

    def done(self, what: str) -> None:
        """Wait for the end of the last order; Refused with its own messages when it was not done."""
        result = self.command.result(PATIENCE)
        if result is None:
            raise Refused(f"{what}: not over after {PATIENCE:g} s")
        if not result:
            raise Refused("; ".join(result.messages) or f"{what} was {result.outcome.value}")
        self.status.poll()

    def rest(self) -> None:
        """Wait until the machine stands."""
        deadline = clock.host_now() + PATIENCE
        while not self.status.inpos and clock.host_now() < deadline:
            self.status.wait(LOOK)
            self.status.poll()

    def mode(self, mode: int) -> None:
        if self.status.task_mode != mode:
            self.command.mode(mode)
            self.done("the mode")

    def axes(self) -> str:
        """Letters of the machine's axes."""
        return "".join(axis for bit, axis in enumerate(AXES) if self.status.axis_mask >> bit & 1)


def summary(console: Console) -> dict[str, Any]:
    """What `status` tells."""
    status, letters = console.status, console.axes()
    position = {axis: round(status.actual_position[AXES.index(axis)], 6) for axis in letters}
    return {
        "state": STATES.get(status.task_state, "unknown"),
        "mode": MODES.get(status.task_mode, "unknown"),
        "program": INTERPRETER.get(status.interp_state, "unknown"),
        "file": status.file,
        "line": status.motion_line,
        "homed": [bool(homed) for homed in status.homed[: status.joints]],
        "position": position,
        "velocity": round(status.current_vel, 6),
        "feed_override": round(status.feedrate * 100.0, 3),
        "rapid_override": round(status.rapidrate * 100.0, 3),
        "spindle": [one["speed"] * one["override"] for one in status.spindle[: status.spindles]],
        "tool": status.tool_in_spindle,
        "ini": status.ini_filename,
    }


def _show_status(console: Console, options: argparse.Namespace) -> None:
    while True:
        console.status.poll()
        values = summary(console)
        if options.json:
            print(json.dumps(values), flush=True)
        else:
            print("\n".join(f"{name + ':':<16}{_word(value)}" for name, value in values.items()), flush=True)
        if not options.watch:
            return
        clock.host_sleep(LOOK)


def _word(value: Any) -> str:
    if isinstance(value, dict):
        return " ".join(f"{key}{number:.3f}" for key, number in value.items())
    if isinstance(value, list):
        return " ".join("yes" if v is True else "no" if v is False else f"{v:g}" for v in value)
    return str(value)


def _on(console: Console, options: argparse.Namespace) -> None:
    console.command.state(linuxcnc.STATE_ESTOP_RESET)
    console.done("E-stop reset")
    console.command.state(linuxcnc.STATE_ON)
    console.done("machine on")


def _state(state: int, what: str) -> Callable[[Console, argparse.Namespace], None]:
    def give(console: Console, options: argparse.Namespace) -> None:
        console.command.state(state)
        console.done(what)

    return give


def _home(console: Console, options: argparse.Namespace) -> None:
    if not options.all and not options.joints:
        raise Refused("home: name joints, or --all")
    console.mode(linuxcnc.MODE_MANUAL)
    console.command.teleop_enable(0)
    console.done("joint mode")
    for joint in [-1] if options.all else options.joints:
        console.command.home(joint)
        console.done("homing")


def _mdi(console: Console, options: argparse.Namespace) -> None:
    console.mode(linuxcnc.MODE_MDI)
    console.command.mdi(" ".join(options.block))
    console.done("the block")


def _run(console: Console, options: argparse.Namespace) -> None:
    from linuxcnc.progress import make_display

    with make_display(options.file.name) as display:
        operator = Operator(lambda: None, display)
        operator.open(options.file.resolve())
        try:
            result = run_loaded(operator, options.file)
        except KeyboardInterrupt:
            console.command.abort()
            raise Refused("aborted") from None
    print(result)


def _auto(action: int) -> Callable[[Console, argparse.Namespace], None]:
    def give(console: Console, options: argparse.Namespace) -> None:
        console.command.auto(action)
        console.done("it")

    return give


def _abort(console: Console, options: argparse.Namespace) -> None:
    console.command.abort()
    console.done("abort")


def _jog(console: Console, options: argparse.Namespace) -> None:
    axis = options.axis.upper()
    if axis not in console.axes():
        raise Refused(f"jog {options.axis}: the machine has {' '.join(console.axes())}")
    console.mode(linuxcnc.MODE_MANUAL)
    homed = all(console.status.homed[: console.status.joints])
    console.command.teleop_enable(homed)
    console.done("jog mode")
    index = AXES.index(axis) if homed else console.axes().index(axis)
    console.command.jog(linuxcnc.JOG_INCREMENT, not homed, index, options.speed / 60.0, options.distance)
    console.done("jog")
    console.rest()


def _override(console: Console, options: argparse.Namespace) -> None:
    scale = options.percent / 100.0
    if options.rapid:
        console.command.rapidrate(scale)
    elif options.spindle is not None:
        console.command.spindleoverride(scale, options.spindle)
    else:
        console.command.feedrate(scale)
    console.done("the override")


def _tools(console: Console, options: argparse.Namespace) -> None:
    loaded = console.status.tool_in_spindle
    for tool in console.status.tool_table[1:]:
        if tool.id > 0:
            mark = "*" if tool.id == loaded else " "
            print(f"{mark}T{tool.id:<5} Z{tool.zoffset:<12.4f} X{tool.xoffset:<12.4f} D{tool.diameter:.4f}")


def _errors(console: Console, options: argparse.Namespace) -> None:
    for kind, text in _messages(console, options.follow):
        print(f"{kind}: {text}", flush=True)


def _watch(console: Console, options: argparse.Namespace) -> None:
    """What the clients order and what the machine tells, each with the number of the command."""
    notes = linuxcnc.order_channel()
    while True:
        while (order := notes.poll()) is not None:
            at = time.strftime("%H:%M:%S", time.localtime(order.time))
            print(f"{at} {order.serial:>6} {order.origin}: {order.text}", flush=True)
        while (message := console.errors.poll()) is not None:
            at = time.strftime("%H:%M:%S")
            print(f"{at} {'':>6} {KINDS.get(message[0], 'text')}: {message[1]}", flush=True)
        notes.wait(LOOK)


def _messages(console: Console, follow: bool) -> Iterator[tuple[str, str]]:
    while True:
        while (message := console.errors.poll()) is not None:
            yield KINDS.get(message[0], "text"), message[1]
        if not follow:
            return
        console.errors.wait(LOOK)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="linuxcnc-ctl", description="Give one order to a running CNC machine.")
    parser.add_argument("--namespace", metavar="NAME", help="the machine, where several run on this host")
    orders = parser.add_subparsers(dest="order", required=True, metavar="ORDER")

    def order(name: str, action: Callable[[Console, argparse.Namespace], None], text: str) -> argparse.ArgumentParser:
        one = orders.add_parser(name, help=text, description=text)
        one.set_defaults(action=action)
        return one

    status = order("status", _show_status, "what the machine does")
    status.add_argument("--json", action="store_true", help="as one JSON object a line")
    status.add_argument("--watch", action="store_true", help="again and again")
    order("on", _on, "reset E-stop and switch on")
    order("off", _state(linuxcnc.STATE_OFF, "machine off"), "switch off")
    order("estop", _state(linuxcnc.STATE_ESTOP, "E-stop"), "E-stop")
    home = order("home", _home, "home joints")
    home.add_argument("joints", type=int, nargs="*", metavar="JOINT")
    home.add_argument("--all", action="store_true", help="all joints in their sequence")
    order("mdi", _mdi, "execute a block of G-code").add_argument("block", nargs="+", metavar="BLOCK")
    order("run", _run, "run a program, with a progress bar").add_argument("file", type=Path, metavar="FILE")
    order("pause", _auto(linuxcnc.AUTO_PAUSE), "pause the program")
    order("resume", _auto(linuxcnc.AUTO_RESUME), "go on")
    order("step", _auto(linuxcnc.AUTO_STEP), "execute one line")
    order("abort", _abort, "stop motion and program")
    jog = order("jog", _jog, "jog an axis by a distance, e.g. jog x +1 --speed 600")
    jog.add_argument("axis", metavar="AXIS")
    jog.add_argument("distance", type=float, metavar="DISTANCE")
    jog.add_argument("--speed", type=float, default=600.0, metavar="UNITS/MIN")
    override = order("override", _override, "set the feed override")
    override.add_argument("percent", type=float, metavar="PERCENT")
    override.add_argument("--rapid", action="store_true", help="the rapid override instead")
    override.add_argument("--spindle", type=int, metavar="N", help="the override of a spindle instead")
    order("tools", _tools, "the tool table")
    errors = order("errors", _errors, "operator messages that come in")
    errors.add_argument("--follow", action="store_true", help="wait for more")
    order("watch", _watch, "what all clients order, with who does, and the operator messages")
    text = "completion for a shell: source <(linuxcnc-ctl completion zsh), linuxcnc-ctl completion fish | source"
    completion = orders.add_parser("completion", help=text, description=text)
    completion.add_argument(
        "shell", choices=SHELLS, nargs="?", default="bash", metavar="SHELL", help="bash, zsh or fish"
    )
    return parser


def main(arguments: list[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.order == "completion":
        print(SHELLS[options.shell](parser))
        return 0
    if options.namespace is not None:
        os.environ[namespace.VARIABLE] = options.namespace
    try:
        options.action(Console(), options)
    except (Refused, ProgramError) as reason:
        print(f"linuxcnc-ctl: {reason}", file=sys.stderr)
        return REFUSED
    except linuxcnc.error as reason:
        print(f"linuxcnc-ctl: {reason}", file=sys.stderr)
        return NO_MACHINE
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # whoever read has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return 0


if __name__ == "__main__":
    sys.exit(main())
