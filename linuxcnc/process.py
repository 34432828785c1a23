"""The processes of a machine: ours are forked, for everything that they share is read by then; others are executed.

A forked process is one as any other: a session, a name and an end of its own, and nothing open that the launcher has
open. Its output goes into a file, whose lines the launcher passes on.
"""

from __future__ import annotations

import atexit
import ctypes
import os
import runpy
import signal
import subprocess
import sys
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn, Protocol

from linuxcnc.programs import Command
from nml import clock, signals

LAST_WORDS = 1.0  # host seconds before its end in which a process tells why it ends
FIRST_OWN_FD = 3
ARGUMENTS = (45, 46)  # where the command line begins and ends: fields of /proc/PID/stat after the name


class Process(Protocol):
    """What the launcher needs of a process that it started; subprocess.Popen has it."""

    pid: int

    @property
    def returncode(self) -> int | None: ...
    def poll(self) -> int | None: ...
    def wait(self) -> int: ...


class Forked:
    """A fork of the launcher that runs a module of ours as ``python -m`` would."""

    def __init__(self, command: Command, folder: Path, output: int | None) -> None:
        self._code: int | None = None
        sys.stdout.flush()
        sys.stderr.flush()
        with signals.held():
            self.pid = os.fork()
            if self.pid == 0:
                _become(command, folder, output)

    @property
    def returncode(self) -> int | None:
        """Exit code; minus the number of the signal that killed it; None while nobody has seen its end."""
        return self._code

    def poll(self) -> int | None:
        """Look whether it has ended."""
        return self._look(os.WNOHANG)

    def wait(self) -> int:
        """Wait for its end."""
        code = self._look(0)
        assert code is not None
        return code

    def _look(self, options: int) -> int | None:
        if self._code is None:
            pid, status = os.waitpid(self.pid, options)
            if pid:
                self._code = os.waitstatus_to_exitcode(status)
        return self._code


def _become(command: Command, folder: Path, output: int | None) -> NoReturn:
    """In the fork: be that program and nothing of the launcher's."""
    code = 1
    try:
        atexit._clear()
        signals.forget()
        if output is not None:
            os.setsid()
            os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
            os.dup2(output, 1)
            os.dup2(output, 2)
        else:
            signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C comes to the launcher too, which ends its display
        os.closerange(FIRST_OWN_FD, os.sysconf("SC_OPEN_MAX"))
        os.chdir(folder)
        show_as(command.words)
        if not sys.flags.safe_path:
            del sys.path[0]  # the launcher's script
        assert command.module is not None
        sys.argv = [command.name, *command.arguments]
        runpy.run_module(command.module, run_name="__main__", alter_sys=True)
        code = 0
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except KeyboardInterrupt:
        code = 128 + signal.SIGINT
    except BaseException:
        traceback.print_exc()
    finally:
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def show_as(words: list[str]) -> None:
    """Be listed by ``ps``, ``pgrep -f`` and ``killall`` as this command line, cut to the length of the launcher's."""
    fields = Path("/proc/self/stat").read_text().rpartition(")")[2].split()
    start, end = (int(fields[number]) for number in ARGUMENTS)
    text = "\0".join(words).encode()[: end - start - 1]
    ctypes.memmove(start, text.ljust(end - start, b"\0"), end - start)
    Path("/proc/self/comm").write_text(Path(words[0]).name)


@dataclass(slots=True)
class Log:
    """A file that another process writes, passed on line by line."""

    path: Path
    shown: int = 0  # bytes that were passed on

    def new_lines(self, *, rest: bool = False) -> list[str]:
        """Whole lines written since the last call; with ``rest`` also an unfinished last one."""
        with self.path.open("rb") as file:
            file.seek(self.shown)
            data = file.read()
        end = len(data) if rest else data.rfind(b"\n") + 1
        self.shown += end
        return [line for line in data[:end].decode(errors="replace").splitlines() if line.strip()]


@dataclass(slots=True)
class Child:
    """A started process and the file that takes its output."""

    name: str
    process: Process
    log: Log
    said: float = float("-inf")  # host time of the last line that was passed on

    def new_output(self) -> list[str]:
        """Whole lines written since the last call; at its end all of them."""
        lines = self.log.new_lines(rest=self.process.poll() is not None)
        if lines:
            self.said = clock.host_now()
        return lines

    def farewell(self) -> str:
        """What is left to say about its end; nothing where it has just said why itself."""
        code = self.process.returncode or 0
        if code > 0 and clock.host_now() - self.said < LAST_WORDS:
            return ""
        return f"{self.name} {_how_it_ended(code)}"


def start(name: str, command: Command, folder: Path, logs: Path, *, foreground: bool = False) -> Child:
    """Start a process in ``folder``; in the background in a session of its own, where Ctrl-C does not reach it."""
    log = logs / f"{name}.log"
    with log.open("wb") as file:
        output = None if foreground else file
        if command.module is not None:
            return Child(name, Forked(command, folder, None if foreground else file.fileno()), Log(log))
        stdin = None if foreground else subprocess.DEVNULL
        process = subprocess.Popen(
            command.words, cwd=folder, stdin=stdin, stdout=output, stderr=output, start_new_session=not foreground
        )
        return Child(name, process, Log(log))


def _how_it_ended(code: int) -> str:
    if code < 0:
        return f"was killed by signal {-code}"
    return f"ended with exit code {code}"
