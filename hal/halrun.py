"""``halrun``: a HAL session from beginning to end. A HAL file or an interactive shell, then all is taken down."""

from __future__ import annotations

import contextlib
import getopt
import os
import signal
import sys
from typing import NoReturn

from hal import halcmd
from hal.session import Session
from nml.errors import PyemcError
from nml.inifile import IniFile
from nml.namespace import shm_name

USAGE = """\
usage: halrun [-I] [halcmd options] [file.hal|file.tcl]
       halrun -T [halcmd options] [file.hal|file.tcl]
       halrun -U

  -I   interactive halcmd after the file
  -T   interactive haltcl after the file
  -U   end the session of this namespace, whatever state it is in
  -h   this help
"""


def _interrupted(number: int, frame: object) -> NoReturn:
    raise KeyboardInterrupt


def unload_everything() -> int:
    """``halrun -U``: end all components and the host, and remove the segment even where a process still holds it."""
    with Session() as session:
        session.teardown()
        session.hal.segment.detach()
    with contextlib.suppress(FileNotFoundError):
        os.unlink("/dev/shm" + shm_name("hal"))
    return 0


@halcmd.output("halrun")
def main(argv: list[str] | None = None) -> int:
    """The command; its exit code is that of the file's commands."""
    arguments = sys.argv[1:] if argv is None else argv
    interactive = ""
    if arguments[:1] == ["-h"]:
        print(USAGE)
        return 0
    if arguments == ["-U"]:
        return unload_everything()
    if arguments and arguments[0] in ("-I", "-T"):
        interactive, arguments = arguments[0], arguments[1:]
    try:
        options = halcmd.parse_options(arguments)
    except getopt.GetoptError as error:
        print(f"halrun: {error}", file=sys.stderr)
        return halcmd.BAD_USAGE
    signal.signal(signal.SIGTERM, _interrupted)
    try:
        ini = IniFile(options.ini) if options.ini else None
        with Session(ini, options.keep_going, options.script) as session:
            return _session(session, options, interactive)
    except PyemcError as error:
        print(f"halrun: {error}", file=sys.stderr)
        return halcmd.FAILED


def _session(session: Session, options: halcmd.Options, interactive: str) -> int:
    pid, alive = session.hal.host_state()
    if alive:
        print(f"halrun: Realtime already running (process {pid}).  'halrun -U' ends that session.", file=sys.stderr)
        return halcmd.FAILED
    code = 0
    try:
        if options.rest:
            options.from_file = True
            code = _run_file(session, options)
        if interactive or not options.rest:
            code = _run_interactive(session, options, interactive)
    except KeyboardInterrupt:
        code = 128 + signal.SIGINT
    finally:
        try:
            sys.stdout.flush()
        finally:
            session.teardown()
    return code


def _run_file(session: Session, options: halcmd.Options) -> int:
    if options.rest[0].endswith(".tcl"):
        return 0 if session.run_file(options.rest[0], options.rest[1:]) else halcmd.FAILED
    return halcmd.run(options, session)


def _run_interactive(session: Session, options: halcmd.Options, interactive: str) -> int:
    if interactive == "-T":
        from hal.haltcl import run_shell

        return run_shell(session)
    options.rest, options.from_file = [], True
    session.keep_going = True
    return halcmd.run(options, session)


if __name__ == "__main__":
    sys.exit(main())
