"""``haltcl`` and Tcl HAL files: Python's own Tcl, with every HAL command as a Tcl command.

A command returns what it would print: ``set x [getp and2.0.out]``. INI values are in arrays by section, each a list of
that key's values: ``$::EMCMOT(SERVO_PERIOD)``. Where a name is Tcl's own (``list``), ``hal list`` is the HAL's.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hal import basic_sim, commands
from nml.errors import HalError, Place, PyemcError

if TYPE_CHECKING:
    from hal.session import Session

HALLIB = Path(__file__).resolve().parent / "hallib"


def _interpreter(session: Session, arguments: list[str]) -> Any:
    """A Tcl interpreter that speaks HAL; HalError where this Python has no Tcl."""
    try:
        import tkinter
    except ImportError:
        raise HalError("Tcl HAL files need Python's Tcl; on Debian and Ubuntu: sudo apt install python3-tk") from None
    tcl = tkinter.Tcl()

    def split(word: str) -> list[str]:
        """A value of several words, such as ``$::KINS(KINEMATICS)``, is a list with one element: its words."""
        return " ".join(tcl.splitlist(word)).split() if word.startswith("{") else [word]

    def call(*words: str) -> tuple[str, str]:
        """(Tcl's return code, output or reason): a Python exception would reach Tcl without its text."""
        out = io.StringIO()
        try:
            with contextlib.redirect_stdout(out):
                session.execute([part for word in words for part in split(str(word))])
        except PyemcError as error:
            return "error", str(error)
        return "ok", out.getvalue().rstrip("\n")

    tcl.createcommand("::hal_call", call)
    tcl.eval("proc hal args { lassign [::hal_call {*}$args] code text; return -code $code $text }")
    tcl.createcommand("basic_sim", lambda *words: basic_sim.run(session, list(words)))
    tcl.createcommand("::tp::passnumber", lambda: session.pass_number)
    for package in ("Hal", "Linuxcnc"):  # what scripts require is here already
        tcl.eval(f"package provide {package} 2.10")
    for name in commands.TABLE:
        if not tcl.splitlist(tcl.eval(f"info commands {name}")):
            tcl.eval(f"proc {name} args {{ uplevel 1 [linsert $args 0 hal {name}] }}")
    if session.ini is not None:
        for section in session.ini.sections():
            for key in session.ini.keys(section):
                for value in session.ini.findall(section, key):
                    tcl.call("lappend", f"::{section}({key})", value)
    tcl.call("set", "::argv", tuple(arguments))
    tcl.call("set", "::argc", len(arguments))
    return tcl


def run_tcl(session: Session, path: Path, arguments: list[str]) -> None:
    """Run a Tcl HAL file; HalError with Tcl's reason, the session's place with the line."""
    if path.resolve() == HALLIB / "basic_sim.tcl":
        basic_sim.run(session, arguments)
        return
    os.environ["HALLIB_DIR"] = str(path.resolve().parent if (path.parent / "sim_lib.tcl").is_file() else HALLIB)
    sys.stdout.flush()
    tcl = _interpreter(session, arguments)
    from tkinter import TclError

    outer = session.place
    session.place = Place(str(path))
    try:
        tcl.eval(f"source {{{path}}}")
    except TclError as error:
        line = re.search(r'\(file "[^"]*" line (\d+)\)', tcl.eval("set ::errorInfo"))
        session.place = Place(str(path), int(line[1]) if line else 0)
        raise HalError(str(error).strip() or "the script ended with an error") from None
    session.place = outer


def run_file(session: Session, path: str, arguments: list[str]) -> int:
    """As a program: the exit code, with the reason on standard error."""
    try:
        run_tcl(session, Path(path), arguments)
    except PyemcError as error:
        session.report(error)
        return 1
    return 0


def run_shell(session: Session) -> int:
    """Tcl commands from standard input until its end or ``exit``."""
    tcl = _interpreter(session, [])
    from tkinter import TclError

    tcl.createcommand("exit", _leave)
    held = ""
    while True:
        try:
            held += input("% " if sys.stdin.isatty() and not held else "") + "\n"
        except EOFError:
            return 0
        if not tcl.getboolean(tcl.call("info", "complete", held)):
            continue
        try:
            result = str(tcl.eval(held))
            if result:
                print(result)
        except TclError as error:
            print(error, file=sys.stderr)
        except SystemExit:
            return 0
        held = ""


def _leave(code: str = "0") -> None:
    raise SystemExit(int(code))


def main(argv: list[str] | None = None) -> int:
    """haltcl [-i INI] [FILE [ARGUMENT ...]]"""
    from hal.session import Session
    from nml.inifile import IniFile

    arguments = sys.argv[1:] if argv is None else argv
    ini = None
    try:
        if arguments[:1] == ["-i"] and len(arguments) > 1:
            ini, arguments = IniFile(arguments[1]), arguments[2:]
        with Session(ini) as session:
            if arguments:
                return run_file(session, arguments[0], arguments[1:])
            return run_shell(session)
    except PyemcError as error:
        print(f"haltcl: {error}", file=sys.stderr)
        return 1
