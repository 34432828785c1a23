"""``halcmd``: the HAL's shell. Options and sources of commands are here, the commands in ``hal.commands``."""

from __future__ import annotations

import contextlib
import getopt
import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TextIO

from hal.session import Quit, Session
from nml.errors import ConfigError, PyemcError
from nml.inifile import IniFile

USAGE = """\
usage: halcmd [options] [command [argument ...]]
       halcmd [options] -f [file]

  -e          show each command before it is executed
  -f [file]   take commands from a file, or from standard input where none is named
  -i file     INI file for [SECTION]KEY substitution
  -k          keep going after a command that failed
  -q  -Q      errors only (the default); nothing at all
  -v  -V      say what was done; more of it
  -R          release the HAL mutex after a crash; it recovers by itself, so this only checks
  -s          for scripts: no titles, one line for each item
  -h          this help; -h command explains one

`halcmd help` lists the commands.
"""
FAILED, BAD_USAGE, INTERRUPTED = 1, 255, 130


@dataclass
class Options:
    """The command line of halcmd."""

    ini: str = ""
    keep_going: bool = False
    script: bool = False
    echo: bool = False
    verbosity: int = 1
    from_file: bool = False
    help: bool = False
    rest: list[str] = field(default_factory=list)


def parse_options(argv: list[str]) -> Options:
    """getopt.GetoptError for an unknown option."""
    options = Options()
    pairs, options.rest = getopt.getopt(argv, "ef" "i:" "kqQsvVRh")
    for letter, value in pairs:
        if letter == "-i":
            options.ini = value
        options.keep_going |= letter == "-k"
        options.script |= letter == "-s"
        options.echo |= letter == "-e"
        options.from_file |= letter == "-f"
        options.help |= letter == "-h"
        options.verbosity = {"-q": 1, "-Q": 0, "-v": 2, "-V": 3}.get(letter, options.verbosity)
    return options


def run(options: Options, session: Session) -> int:
    """Execute what the options ask for; the exit code."""
    session.echo = options.echo
    session.verbosity = options.verbosity
    try:
        if options.help:
            session.run_words(["help", *options.rest])
        elif options.from_file and options.rest:
            return 0 if _run_file(session, options.rest[0]) else FAILED
        elif options.from_file:
            return 0 if _run_input(session, sys.stdin) else FAILED
        else:
            return 0 if session.run_words(options.rest) else FAILED
    except Quit:
        return FAILED if session.errors else 0
    return 0


def _run_file(session: Session, path: str) -> bool:
    try:
        return session.run_file(path)
    except ConfigError as error:
        print(f"halcmd: {error}", file=sys.stderr)
        raise SystemExit(BAD_USAGE) from None


def _run_input(session: Session, stream: TextIO) -> bool:
    if stream.isatty():
        from hal.interactive import run as run_interactive

        return run_interactive(session)
    return session.run_lines(stream, "<stdin>")


@contextlib.contextmanager
def output(program: str) -> Iterator[None]:
    """Standard output for a program: it may be closed, a pipe that nobody reads any more, or a full disk."""
    if sys.stdout is None:
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115
    try:
        yield
        sys.stdout.flush()
    except OSError as error:
        if error.filename is not None:
            raise
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what is left in the buffer has nowhere to go
        if not isinstance(error, BrokenPipeError):
            print(f"{program}: cannot write: {error.strerror}", file=sys.stderr)
        raise SystemExit(FAILED) from None


@output("halcmd")
def main(argv: list[str] | None = None) -> int:
    """The command; exit code 1 where a command failed, 255 for a wrong command line or file."""
    arguments = sys.argv[1:] if argv is None else argv
    try:
        options = parse_options(arguments)
    except getopt.GetoptError as error:
        print(f"halcmd: {error}", file=sys.stderr)
        return BAD_USAGE
    if not options.from_file and not options.rest:
        print(USAGE)
        return 0
    try:
        ini = IniFile(options.ini) if options.ini else None
        with Session(ini, options.keep_going, options.script) as session:
            code = run(options, session)
    except PyemcError as error:
        print(f"halcmd: {error}", file=sys.stderr)
        return BAD_USAGE
    except KeyboardInterrupt:
        print("halcmd: interrupted", file=sys.stderr)
        return INTERRUPTED
    return code


if __name__ == "__main__":
    sys.exit(main())
