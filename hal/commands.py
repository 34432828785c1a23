"""The commands of ``halcmd``: one table with name, number of arguments, what it does and its help."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from hal import loadusr
from hal._shm import PARAM, PIN, USER
from hal.core import EPERM, LOCK_ALL, LOCK_NONE, LOCK_TUNE, suggest
from hal.halfile import without_arrows
from hal.show import Save, Show, list_names, lock_status, memory_status
from hal.values import TYPE_NAMES, plain_value, type_number
from nml.errors import HalError

if TYPE_CHECKING:
    from hal.session import Session

Run = Callable[["Session", list[str]], None]


@dataclass(frozen=True)
class Command:
    """``most`` None: any number of arguments."""

    run: Run
    least: int
    most: int | None
    usage: str
    help: str
    arrows: bool = False

    def check(self, name: str, args: list[str]) -> None:
        """Drop arrows where they may stand; HalError for a wrong number of arguments."""
        if self.arrows:
            args[:] = without_arrows(args)
        given = len(args)
        if self.least == self.most and given != self.least:
            raise HalError(f"{name} requires {self.least} arguments, {given} given")
        if given < self.least:
            raise HalError(f"{name} requires at least {self.least} arguments, {given} given")
        if self.most is not None and given > self.most:
            raise HalError(f"{name} requires at most {self.most} arguments, {given} given")


TABLE: dict[str, Command] = {}


def command(
    *names: str, least: int = 0, most: int | None = -1, usage: str = "", arrows: bool = False
) -> Callable[[Run], Run]:
    """Put a function into the table; without ``most`` it takes exactly ``least`` arguments."""

    def register(run: Run) -> Run:
        help_text = (run.__doc__ or "").strip()
        for name in names:
            TABLE[name] = Command(run, least, least if most == -1 else most, usage, help_text, arrows)
        return run

    return register


# ---- loading ----


@command("loadrt", least=1, most=None, usage="loadrt MODULE [NAME=VALUE ...]")
def loadrt(session: Session, args: list[str]) -> None:
    """Load a realtime module; the realtime host is started with the first one."""
    session.host.loadrt(args[0], args[1:])


@command("loadusr", most=None, usage="loadusr [-W] [-Wn NAME] [-w] [-i] PROGRAM [ARGUMENT ...]")
def run_loadusr(session: Session, args: list[str]) -> None:
    """Start a program. -W waits for its component (-n names it), -w for its end; -i ignores its exit status."""
    _refuse_locked(session)
    session.hal.segment.skip_ids(2)
    pid = loadusr.load(session.hal, args)
    if pid:
        session.programs.append(pid)


def _refuse_locked(session: Session) -> None:
    if session.hal.segment.locks & LOCK_TUNE:
        raise HalError("HAL is locked, loading of programs is not permitted", EPERM)


@command("waitusr", least=1, usage="waitusr NAME")
def waitusr(session: Session, args: list[str]) -> None:
    """Wait until a user component has left."""
    loadusr.wait_gone(session.hal, args[0])


@command("unloadusr", least=1, usage="unloadusr NAME|all")
def unloadusr(session: Session, args: list[str]) -> None:
    """End a user component, or all of them, with SIGTERM."""
    loadusr.unload(session.hal, args[0])


@command("unloadrt", least=1, usage="unloadrt NAME|all")
def unloadrt(session: Session, args: list[str]) -> None:
    """Unload a realtime module; `all` ends the realtime host too."""
    session.host.unloadrt(args[0])


@command("unload", least=1, usage="unload NAME|all")
def unload(session: Session, args: list[str]) -> None:
    """Unload a realtime module or end a user component; `all` for everything."""
    if args[0] == "all":
        unload_all(session)
    elif session.hal.component(args[0]).kind == USER:
        loadusr.unload(session.hal, args[0])
    else:
        session.host.unloadrt(args[0])


def unload_all(session: Session) -> None:
    """User components first, so that they can still leave in order."""
    loadusr.unload(session.hal, "all")
    session.host.unloadrt("all")


# ---- signals and links ----


@command("newsig", least=2, usage="newsig SIGNAL TYPE")
def newsig(session: Session, args: list[str]) -> None:
    """Make a signal of a type: bit, float, s32, u32, s64, u64 or port. `net` does it by itself."""
    session.hal.new_signal(args[0], type_number(args[1]))


@command("delsig", least=1, usage="delsig SIGNAL|all")
def delsig(session: Session, args: list[str]) -> None:
    """Delete a signal, or all; its pins are unlinked."""
    names = [signal.name for signal in session.hal.segment.signals()] if args[0] == "all" else args
    if not names:
        raise HalError("no signals found to be deleted")
    for name in names:
        session.hal.delete_signal(name)


@command("net", least=1, most=None, usage="net SIGNAL [ARROW] PIN [[ARROW] PIN ...]", arrows=True)
def net(session: Session, args: list[str]) -> None:
    """Link pins to a signal, making it where it does not exist. Arrows (=> <= <=>) may stand between for the reader."""
    session.hal.net(args[0], args[1:])


@command("linkps", least=2, usage="linkps PIN [ARROW] SIGNAL", arrows=True)
def linkps(session: Session, args: list[str]) -> None:
    """Link a pin to a signal that exists."""
    session.hal.link(args[0], args[1])


@command("linksp", least=2, usage="linksp SIGNAL [ARROW] PIN", arrows=True)
def linksp(session: Session, args: list[str]) -> None:
    """Link a signal that exists to a pin."""
    session.hal.link(args[1], args[0])


@command("linkpp", least=2, usage="linkpp PIN [ARROW] PIN", arrows=True)
def linkpp(session: Session, args: list[str]) -> None:
    """Link two pins through a signal named like the first."""
    print(f"{session.place}: Warning: linkpp command is deprecated, use 'net'", file=sys.stderr)
    first, second = (session.hal.pin(name) for name in args)
    if first.type != second.type:
        raise HalError(
            f"pin '{args[0]}' of type '{TYPE_NAMES[first.type]}' cannot be linked to pin '{args[1]}' "
            f"of type '{TYPE_NAMES[second.type]}'"
        )
    session.hal.check_writers(second, args[0], [first])
    session.hal.new_signal(args[0], first.type)
    for name in args:
        session.hal.link(name, args[0])


@command("unlinkp", least=1, usage="unlinkp PIN")
def unlinkp(session: Session, args: list[str]) -> None:
    """Cut a pin off its signal; it keeps the last value."""
    session.hal.unlink(args[0])


# ---- values ----


@command("setp", least=2, usage="setp NAME VALUE")
def setp(session: Session, args: list[str]) -> None:
    """Set a writable parameter, or a pin that is no output and not linked. `NAME = VALUE` does the same in a file."""
    session.hal.set_item(args[0], args[1])


@command("sets", least=2, usage="sets SIGNAL VALUE")
def sets(session: Session, args: list[str]) -> None:
    """Set a signal that no pin drives."""
    session.hal.set_signal(args[0], args[1])


@command("getp", least=1, usage="getp NAME")
def getp(session: Session, args: list[str]) -> None:
    """Print the value of a parameter or pin."""
    item = session.hal.item(args[0])[1]
    print(plain_value(item.type, item.get()))


@command("gets", least=1, usage="gets SIGNAL")
def gets(session: Session, args: list[str]) -> None:
    """Print the value of a signal."""
    signal = session.hal.signal(args[0])
    print(plain_value(signal.type, signal.get()))


@command("ptype", least=1, usage="ptype NAME")
def ptype(session: Session, args: list[str]) -> None:
    """Print the type of a parameter or pin."""
    print(TYPE_NAMES[session.hal.item(args[0])[1].type])


@command("stype", least=1, usage="stype SIGNAL")
def stype(session: Session, args: list[str]) -> None:
    """Print the type of a signal."""
    print(TYPE_NAMES[session.hal.signal(args[0]).type])


# ---- names ----


def _item_kind(word: str) -> int:
    kinds = {"pin": PIN, "param": PARAM, "parameter": PARAM}
    if word not in kinds:
        raise HalError(f"'{word}' is neither pin nor param")
    return kinds[word]


@command("alias", least=3, usage="alias pin|param NAME ALIAS")
def alias(session: Session, args: list[str]) -> None:
    """Give a pin or parameter a second name."""
    session.hal.alias(_item_kind(args[0]), args[1], args[2])


@command("unalias", least=2, usage="unalias pin|param NAME")
def unalias(session: Session, args: list[str]) -> None:
    """Remove the second name of a pin or parameter."""
    session.hal.unalias(_item_kind(args[0]), args[1])


# ---- threads ----


@command("addf", least=2, most=3, usage="addf FUNCTION THREAD [POSITION]")
def addf(session: Session, args: list[str]) -> None:
    """Call a function in a thread: at its end, or at a position; 1 is the first, -1 the last."""
    try:
        position = int(args[2]) if len(args) > 2 else -1
    except ValueError:
        raise HalError(f"addf: position '{args[2]}' is no whole number") from None
    session.host.addf(args[0], args[1], position)


@command("delf", least=2, usage="delf FUNCTION THREAD")
def delf(session: Session, args: list[str]) -> None:
    """Call a function no more in a thread."""
    session.host.delf(args[0], args[1])


@command("start", usage="start")
def start(session: Session, args: list[str]) -> None:
    """Let the threads call their functions."""
    session.hal.start_threads()


@command("stop", usage="stop")
def stop(session: Session, args: list[str]) -> None:
    """Stop the threads; when it returns no function runs any more."""
    session.hal.stop_threads()


# ---- looking ----


@command("show", most=None, usage="show [comp|pin|sig|param|funct|thread|alias|all [PATTERN ...]]")
def show(session: Session, args: list[str]) -> None:
    """Print items as tables; all of them without arguments. A pattern is the beginning of a name or a shell glob."""
    tables = Show(session.hal, session.script)
    what = args[0] if args else "all"
    if what != "all" and what not in tables.tables:
        raise HalError(f"Unknown 'show' type '{what}'{suggest(what, [*tables.tables, 'all'])}")
    _print(tables.all(args[1:]) if what == "all" else tables.tables[what](args[1:]))


@command("list", least=1, most=None, usage="list comp|pin|sig|param|funct|thread [-tTYPE] [PATTERN ...]")
def list_(session: Session, args: list[str]) -> None:
    """Print names in one line."""
    names = list_names(session.hal, args[0], args[1:])
    if names is None:
        raise HalError(f"Unknown 'list' type '{args[0]}'")
    print("".join(name + " " for name in names))


@command("save", most=2, usage="save [TYPE [FILE]]")
def save(session: Session, args: list[str]) -> None:
    """Print the session as HAL commands: comp alias sig sigu link linka net neta netl netla param thread all allu
    unconnectedinpins."""
    tables = Save(session.hal).tables
    what = args[0] if args else "all"
    if what not in tables:
        raise HalError(f"Unknown 'save' type '{what}'")
    if len(args) < 2:
        _print(tables[what]())
        return
    text = "".join(line + "\n" for line in tables[what]())
    try:
        Path(args[1]).write_text(text, encoding="utf-8")
    except OSError as error:
        raise HalError(f"cannot write '{args[1]}': {error.strerror}") from None


@command("status", most=1, usage="status [lock|mem|all]")
def status(session: Session, args: list[str]) -> None:
    """Print what is locked, and how full the segment is."""
    what = args[0] if args else "all"
    if what not in ("lock", "mem", "all"):
        raise HalError(f"Unknown 'status' type '{what}'")
    if what != "mem":
        _print(lock_status(session.hal))
    if what != "lock":
        _print(memory_status(session.hal))


def _print(lines: Iterable[str]) -> None:
    sys.stdout.write("".join(line + "\n" for line in lines))


# ---- the shell itself ----


@command("lock", most=1, usage="lock [all|tune|none]")
def lock(session: Session, args: list[str]) -> None:
    """Lock the HAL: `tune` still allows setting parameters, `all` (or nothing) allows no change."""
    session.hal.segment.locks = _lock_level(args, {"none": LOCK_NONE, "tune": LOCK_TUNE, "all": LOCK_ALL})


@command("unlock", most=1, usage="unlock [all|tune]")
def unlock(session: Session, args: list[str]) -> None:
    """Unlock the HAL: `all` (or nothing) wholly, `tune` what `lock tune` locks."""
    session.hal.segment.locks &= ~_lock_level(args, {"all": LOCK_ALL, "tune": LOCK_TUNE})


def _lock_level(args: list[str], levels: dict[str, int]) -> int:
    what = args[0] if args else "all"
    if what not in levels:
        raise HalError(f"'{what}' is no kind of lock; {', '.join(levels)} are known")
    return levels[what]


@command("source", least=1, usage="source FILE")
def source(session: Session, args: list[str]) -> None:
    """Execute the commands of a file."""
    session.source(args[0])


@command("echo", usage="echo")
def echo(session: Session, args: list[str]) -> None:
    """Show each command before it is executed."""
    session.echo = True
    print("Echo on")


@command("unecho", usage="unecho")
def unecho(session: Session, args: list[str]) -> None:
    """End `echo`."""
    session.echo = False
    print("Echo off")


@command("print", most=1, usage="print [MESSAGE]")
def print_(session: Session, args: list[str]) -> None:
    """Print file name, line and a message on standard error."""
    print(f"{session.place}: HALCMD MSG: {args[0] if args else '(null)'}", file=sys.stderr)


@command("debug", least=1, usage="debug LEVEL")
def debug(session: Session, args: list[str]) -> None:
    """Set how much is said: 0 nothing, 1 errors, 2 or more results too."""
    try:
        session.verbosity = int(args[0])
    except ValueError:
        raise HalError(f"debug: '{args[0]}' is no level; a number from 0 to 5 would be right") from None


@command("setexact_for_test_suite_only", usage="setexact_for_test_suite_only")
def setexact(session: Session, args: list[str]) -> None:
    """Make thread periods exact, before there are threads. They always are here."""
    if session.hal.segment.threads():
        raise HalError("setexact: a thread exists already; this command belongs before 'loadrt threads'")


@command("quit", "exit", usage="quit")
def quit_(session: Session, args: list[str]) -> None:
    """Leave."""
    from hal.session import Quit

    raise Quit


@command("help", most=1, usage="help [COMMAND]")
def help_(session: Session, args: list[str]) -> None:
    """Explain a command, or list them all."""
    if args and args[0] not in TABLE:
        print(f"No help for unknown command '{args[0]}'")
        return
    for name, entry in sorted(TABLE.items()) if not args else [(args[0], TABLE[args[0]])]:
        print(f"{entry.usage}\n  {entry.help}" if args else f"  {name:<12} {entry.help.splitlines()[0]}")
