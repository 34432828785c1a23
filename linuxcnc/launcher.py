"""The command ``linuxcnc``: start a machine from an INI file, with its display or to run one program.

Exit codes: 0, a proper end; 1, something was wrong, said in one line on stderr; 2, a wrong command line; 130 and 143,
stopped by Ctrl-C and by SIGTERM. Whatever happens, the machine comes to rest under its limits and nothing of it
stays behind.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linuxcnc.options import overrides, parse
from nml import clock, namespace, signals

if TYPE_CHECKING:
    from linuxcnc.machine import Machine

WIZARD = "gui.web"  # its page offers configurations and starts one
POLL = 0.05  # host seconds between looks at the processes


def main(arguments: list[str] | None = None) -> int:
    """Start what the command line asks for; returns the exit code, or raises Stopped."""
    options = parse(arguments)
    try:
        if options.namespace is not None:
            os.environ[namespace.VARIABLE] = options.namespace
            namespace.namespace()
        if options.speed is not None:
            clock.set_speed(options.speed)
    except ValueError as reason:
        print(f"linuxcnc: {reason}", file=sys.stderr)
        return 1
    if options.ini is None and not options.last and _only_a_desktop():
        return subprocess.call([sys.executable, "-P", "-m", WIZARD, "--wizard"])
    return _launch(options)


def _only_a_desktop() -> bool:
    """Was it started by an icon, so that a configuration is best chosen in a browser?"""
    from linuxcnc import picker

    return not picker.has_terminal() and picker.has_desktop()


def _launch(options: argparse.Namespace) -> int:
    """Run the machine to its end; problems of the user's making become one line."""
    from linuxcnc import lastused
    from linuxcnc._connection import error
    from linuxcnc.configuration import Configuration
    from linuxcnc.filters import filtered
    from linuxcnc.machine import Machine, to_stderr
    from linuxcnc.program import ProgramError, run_program
    from nml.errors import PyemcError

    signals.check()
    held: list[str] = []
    said: list[str] = []
    ini: Path | None = None
    started = False

    def report(line: str) -> None:
        """Pass a line on; what task logs while we play the operator waits, for it may be the reason of the end."""
        said.append(line)
        (held.append if options.run is not None and line.startswith("task: ") else to_stderr)(line)

    try:
        ini = _ini_file(options)
        if options.check:
            return _check(ini)
        configuration = Configuration(ini, overrides(options))
        if options.run is not None:
            _readable(options.run)
        else:
            configuration.display()
            lastused.remember(ini)
        signals.check()
        with Machine(configuration, report, options.talk) as machine:
            machine.start()
            started = True
            _warn(ini)
            if options.run is not None:
                part = filtered(configuration.ini, options.run.resolve(), say=to_stderr)
                print(run_program(machine.check, part), flush=True)
                return 0
            return _follow_display(machine)
    except (PyemcError, ProgramError, error) as reason:
        held[:] = [line for line in held if line != f"task: {reason}"]
        if str(reason):
            held.append(str(reason))
        if ini is not None and not started:
            held += _other_findings(ini, [*said, *held])
        return 1
    except OSError as reason:
        held.append(f"{reason.filename or namespace.runtime_dir()}: {reason.strerror}; the machine needs this place")
        return 1
    finally:
        for line in held:
            to_stderr(line)


def _ini_file(options: argparse.Namespace) -> Path:
    """The INI file that was named, started last, or is chosen now."""
    from linuxcnc import lastused, picker

    signals.check()
    if options.ini is not None:
        return options.ini
    return lastused.recall_or_refuse() if options.last else picker.pick()


def _check(ini: Path) -> int:
    """Print what is wrong with a configuration."""
    from linuxcnc.check import findings

    found = findings(ini)
    for finding in found:
        print(finding)
    return 1 if found else 0


def _warn(ini: Path) -> None:
    """Say what did not keep the machine from starting, but is not what its user meant."""
    from linuxcnc.check import WARNINGS, findings
    from linuxcnc.machine import to_stderr

    for finding in findings(ini, WARNINGS):
        to_stderr(finding)


def _other_findings(ini: Path, said: list[str]) -> list[str]:
    """What a check finds in a configuration that did not start, but for the files that were named already."""
    from linuxcnc.check import findings

    named = {line.partition(":")[0] for line in said}
    return [finding for finding in findings(ini.absolute()) if finding.partition(":")[0] not in named]


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
    while (code := display.process.poll()) is None:
        machine.check()
        clock.host_sleep(POLL)
    if code < 0:
        raise MachineError(display.farewell())
    return code
