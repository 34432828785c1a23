"""``loadusr``, ``waitusr`` and ``unloadusr``: programs that are (or are not) HAL components, started and waited for."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from dataclasses import dataclass
from pathlib import Path

from hal._shm import USER
from hal.core import Hal
from hal.finder import program
from hal.process import alive
from nml import clock
from nml.errors import HalError

POLL_SECONDS = 0.002
TERM_SECONDS = 3.0  # how long a component may take to leave after SIGTERM


@dataclass
class Request:
    """``loadusr`` flags and command line."""

    command: list[str]
    wait_exit: bool = False
    wait_ready: bool = False
    ignore_status: bool = False
    name: str = ""


def parse(words: list[str]) -> Request:
    """Flags ``-w -W -i -Wn NAME`` (also run together), then the command."""
    request = Request([])
    rest = list(words)
    while rest and rest[0].startswith("-"):
        for letter in rest.pop(0)[1:]:
            if letter == "w":
                request.wait_exit = True
            elif letter == "W":
                request.wait_ready = True
            elif letter == "i":
                request.ignore_status = True
            elif letter == "n" and rest:
                request.name = rest.pop(0)
            else:
                raise HalError(f"loadusr: option -{letter} is unknown or lacks its value; -W -w -i -n NAME are known")
    if not rest:
        raise HalError("loadusr requires a program to run")
    request.command = rest
    request.name = request.name or Path(rest[0]).stem
    return request


def load(hal: Hal, words: list[str]) -> int:
    """Start a program, and wait as the flags say; its process number, 0 when it has ended. HalError where it fails."""
    request = parse(words)
    sys.stdout.flush()
    command = program(request.command[0]) + request.command[1:]
    pid = os.posix_spawn(command[0], command, os.environ)
    if request.wait_ready:
        _wait_ready(hal, request, pid)
    if request.wait_exit:
        status = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
        if status != 0 and not request.ignore_status:
            raise HalError(f"program '{request.command[0]}' failed, returned {status}")
        return 0
    return pid


def _wait_ready(hal: Hal, request: Request, pid: int) -> None:
    while True:
        comp = hal.segment.find_comp(request.name)
        if comp is not None and comp.ready:
            return
        done, status = os.waitpid(pid, os.WNOHANG)
        if done:
            code = os.waitstatus_to_exitcode(status)
            raise HalError(f"{request.name} exited without becoming ready (status {code} of '{request.command[0]}')")
        clock.host_sleep(POLL_SECONDS)


def wait_gone(hal: Hal, name: str) -> None:
    """``waitusr``: until the component has left the HAL."""
    while True:
        comp = hal.segment.find_comp(name)
        if comp is None or not alive(comp.pid, comp.start):
            return
        clock.host_sleep(POLL_SECONDS)


def unload(hal: Hal, name: str) -> None:
    """``unloadusr``: SIGTERM to the component's process (``all``: to each but this one), then SIGKILL.

    One that has left already is no error: programs end by themselves.
    """
    if name == "all":
        comps = [c for c in hal.segment.comps() if c.kind == USER and c.pid != os.getpid()]
    else:
        comps = [c for c in [hal.segment.find_comp(name)] if c]
        if comps and comps[0].kind != USER:
            raise HalError(f"component '{name}' is a realtime one; 'unloadrt {name}' would be right")
    for signal_number in (signal.SIGTERM, signal.SIGKILL):
        living = [c for c in comps if c.exists and alive(c.pid, c.start)]
        for comp in living:
            os.kill(comp.pid, signal_number)
        patience = clock.host_now() + TERM_SECONDS
        while any(alive(c.pid, c.start) for c in living) and clock.host_now() < patience:
            _reap_children()
            clock.host_sleep(POLL_SECONDS)
    hal.reap()


def end_programs(pids: list[int]) -> None:
    """SIGTERM to programs of this session that are no components, such as screens."""
    for pid in pids:
        with contextlib.suppress(ChildProcessError):  # it ended, and its number may be another's by now
            if os.waitpid(pid, os.WNOHANG) == (0, 0):
                os.kill(pid, signal.SIGTERM)


def _reap_children() -> None:
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        return
