"""The command ``linuxcnc``: start a machine from an INI file, with its display or to run one program.

Exit codes: 0, a proper end; 1, something was wrong, said in one line on stderr; 130 and 143, stopped by Ctrl-C and by
SIGTERM. Whatever happens, the machine comes to rest under its limits and nothing of it stays behind.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

from nml import clock, namespace

if TYPE_CHECKING:
    from linuxcnc.machine import Machine

COMPATIBLE = {"r": "do not redirect output", "v": "be verbose", "d": "print debug messages", "k": "continue on errors"}
POLL = 0.05  # host seconds between looks at the processes


class Stopped(Exception):
    """A signal asked the launcher to end."""

    def __init__(self, number: int) -> None:
        self.number = number
        super().__init__(f"stopped by {signal.Signals(number).name}")


def main(arguments: list[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    options = _parser().parse_args(arguments)
    try:
        if options.namespace is not None:
            os.environ[namespace.VARIABLE] = options.namespace
            namespace.namespace()
        if options.speed is not None:
            clock.set_speed(options.speed)
    except ValueError as reason:
        print(f"linuxcnc: {reason}", file=sys.stderr)
        return 1
    try:
        return _launch(options)
    except Stopped as stopped:
        print(f"linuxcnc: {stopped}", file=sys.stderr)
        return 128 + stopped.number
    except KeyboardInterrupt:
        return 128 + signal.SIGINT


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="linuxcnc", description="Start a CNC machine from an INI file.")
    parser.add_argument("ini", type=Path, metavar="INI", help="INI file of the machine")
    parser.add_argument("--run", type=Path, metavar="FILE", help="switch on, home, run this program and end")
    parser.add_argument("--speed", type=float, metavar="N", help="simulate N times faster than real time")
    for letter, meaning in COMPATIBLE.items():
        parser.add_argument(f"-{letter}", action="store_true", help=f"{meaning}; accepted for LinuxCNC's sake")
    parser.add_argument("--namespace", metavar="NAME", help="name of this machine where several run on one host")
    return parser


def _launch(options: argparse.Namespace) -> int:
    """Run the machine to its end; problems of the user's making become one line."""
    from linuxcnc._connection import error
    from linuxcnc.configuration import Configuration
    from linuxcnc.machine import END_SIGNALS, Machine, to_stderr
    from linuxcnc.program import ProgramError, run_program
    from nml.errors import PyemcError

    try:
        configuration = Configuration(options.ini)
        if options.run is not None:
            _readable(options.run)
        else:
            configuration.display()
        for number in END_SIGNALS:
            signal.signal(number, _stop)
        with Machine(configuration, to_stderr) as machine:
            machine.start()
            if options.run is not None:
                print(run_program(machine.check, options.run.resolve()), flush=True)
                return 0
            return _follow_display(machine)
    except (PyemcError, ProgramError, error) as reason:
        if str(reason):
            print(reason, file=sys.stderr)
        return 1


def _readable(path: Path) -> None:
    from nml.errors import ConfigError, Place

    try:
        path.open("rb").close()
    except OSError as reason:
        raise ConfigError(f"the program cannot be read: {reason.strerror}", Place(str(path))) from reason


def _follow_display(machine: Machine) -> int:
    """Stay up as long as the display and all other processes live; the display's exit code."""
    from linuxcnc.machine import MachineError

    display = machine.start_display()
    while display.process.poll() is None:
        machine.check()
        clock.host_sleep(POLL)
    if display.process.returncode < 0:
        raise MachineError(display.farewell())
    return display.process.returncode


def _stop(number: int, frame: FrameType | None) -> None:
    """Ends the main loop."""
    raise Stopped(number)


if __name__ == "__main__":
    sys.exit(main())
