"""``rs274``: the stand-alone interpreter. ``rs274 -g FILE`` prints the canonical calls of a program."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from typing import Any

from nml.errors import ConfigError, InterpError
from rs274ngc import tooltable
from rs274ngc.canon import Tool
from rs274ngc.interp import Interpreter
from rs274ngc.printer import PrintCanon

CONTINUE, MDI, STOP = 0, 1, 2
PROMPT = "READ => "
STDOUT = 1
LONG_BYTES = 2_000_000
"""Programs of this size get a progress bar."""


def parser() -> argparse.ArgumentParser:
    """The options of LinuxCNC's rs274."""
    options = argparse.ArgumentParser(prog="rs274", description="Interpret RS274/NGC programs without a machine.")
    add = options.add_argument
    add("-p", dest="interpreter", metavar="INTERP", help="pluggable interpreter; only the built-in one is there")
    add("-t", dest="tools", metavar="TOOL.TBL", help="tool table file")
    add("-v", dest="parameters", metavar="FILE.VAR", help="parameter file")
    add("-i", dest="ini", metavar="FILE.INI", help="INI file")
    after_error = "after an error: 0 continue, 1 enter MDI, 2 stop"
    add("-n", dest="next", type=int, choices=(CONTINUE, MDI, STOP), default=STOP, help=after_error)
    add("-b", dest="block_delete", action="store_true", help="skip lines that begin with a slash")
    add("-s", dest="stack", action="store_true", help="print where an error was found")
    add("-g", dest="go", action="store_true", help="go on without asking (batch mode)")
    add("-T", dest="task_init", action="store_true", help="call task_init()")
    add("-l", dest="log_level", type=int, default=-1, metavar="LEVEL", help="log level")
    add("--stats", action="store_true", help="print extents, distances, tools and time instead of canonical calls")
    add("--json", action="store_true", help="the same as JSON")
    add("--plot", metavar="OUT", help="draw the tool path: OUT.png, or OUT.html to turn and zoom in a browser")
    add("input", nargs="?", help="program; without it, lines are read from the terminal")
    add("output", nargs="?", help="where to write (default: standard output)")
    return options


def read_ini(path: str) -> Any:
    """The INI file of ``-i``."""
    from nml.inifile import IniFile

    return IniFile(path)


def tools_of(options: argparse.Namespace) -> Sequence[Tool]:
    """The tools of ``-t``, else the usual ones; none where the table cannot be read, which LinuxCNC does not say."""
    if not options.tools:
        return tooltable.DEFAULT
    try:
        return tooltable.load(options.tools)
    except ConfigError as error:
        print(f"{error}; there are no tools", file=sys.stderr)
        return ()


def report(error: InterpError, stack: bool) -> None:
    """An error on the standard error output: message and block in LinuxCNC's form, the place first for people."""
    if error.place is not None and (stack or sys.stderr.isatty()):
        print(f"{error.place}:", file=sys.stderr)
    print(error.message, file=sys.stderr)
    if error.block:
        print(error.block, file=sys.stderr)


def show_figures(options: argparse.Namespace) -> int:
    """``--stats``, ``--json`` and ``--plot``."""
    from rs274ngc import plot, preview, stats

    machine: dict[str, Any] = {"tools": tools_of(options)} if options.tools else {}
    with progress_bar(options.input) as progress:
        ini = read_ini(options.ini) if options.ini else None
        result = preview.load(options.input, ini, progress=progress, parameter_file=options.parameters, **machine)
    if result.error is not None:
        raise result.error
    if options.plot:
        plot.save(result, options.plot, os.path.basename(options.input))
    if options.stats or options.json or not options.plot:
        values = stats.figures(result)
        print(json.dumps(values) if options.json else stats.text(values))
    return 0


@contextmanager
def progress_bar(path: str) -> Iterator[Callable[[float], None] | None]:
    """A bar on the terminal while a long program is read; nothing where nobody looks, or for a short one."""
    if not sys.stderr.isatty() or os.path.getsize(path) < LONG_BYTES:
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(os.path.basename(path), total=1.0)
        yield lambda share: bar.update(task, completed=share)


def type_in(interp: Interpreter, canon: PrintCanon, stack: bool) -> None:
    """Execute lines from the terminal until its end or ``quit``."""
    while True:
        canon.flush()
        try:
            line = input(PROMPT if sys.stdin.isatty() else "")
        except EOFError:
            return
        if line.strip() == "quit":
            return
        try:
            interp.execute_mdi(line)
            while interp.call_level:
                interp.read()
                interp.execute()
        except InterpError as error:
            canon.flush()
            report(error, stack)


def main(arguments: list[str] | None = None) -> int:
    """Run the command; 0: the program was right."""
    options = parser().parse_args(arguments)
    errors: list[InterpError] = []
    output = STDOUT
    try:
        if options.input and (options.stats or options.json or options.plot):
            return show_figures(options)
        if options.output:
            output = os.open(options.output, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
        canon = PrintCanon(output, tools=tools_of(options))
        canon.block_delete = options.block_delete
        interp = Interpreter(canon, read_ini(options.ini) if options.ini else None)
        canon.state = interp.state
        interp.parameter_file = options.parameters
        interp.init()

        def on_error(error: InterpError) -> None:
            errors.append(error)
            canon.flush()
            report(error, options.stack)

        if options.input:
            print("executing", file=sys.stderr)
            interp.open(options.input)
            with progress_bar(options.input) if options.output else nullcontext() as progress:
                interp.run_file(options.next == STOP, on_error, progress)
            if errors and options.next == MDI:
                type_in(interp, canon, options.stack)
            interp.close()
            if not options.ini:
                interp.reset()
        else:
            type_in(interp, canon, options.stack)
        interp.exit()
        canon.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), STDOUT)
        return 1
    except (ConfigError, InterpError) as error:
        print(error, file=sys.stderr)
        return 1
    except OSError as error:
        print(f"could not open output file {options.output}: {error.strerror}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        canon.flush()
        return 130
    finally:
        if output != STDOUT:
            os.close(output)
    return 1 if errors and options.next != CONTINUE else 0


if __name__ == "__main__":
    sys.exit(main())
